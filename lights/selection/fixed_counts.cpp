#include "lights/selection/fixed_counts.h"

#include <algorithm>
#include <numeric>

#include "base/parallel.h"
#include "lights/selection/emitters.h"
#include "sampling/tables.h"

namespace lampyr {

namespace {

class FixedCountSelector final : public LightSelector {
 public:
  FixedCountSelector(std::span<const PlacedLight> lights, std::span<const int> counts, const BoundingSphere& scene,
                     std::unique_ptr<LightSelector> whole, std::unique_ptr<LightSelector> others)
      : counts_(counts.begin(), counts.end()),
        total_(std::accumulate(counts.begin(), counts.end(), 0)),
        whole_(std::move(whole)),
        others_(std::move(others)) {
    std::vector<PlacedLight> patched;
    for (uint32_t i = 0; i < counts.size(); ++i) {
      if (counts[i] == 0) {
        otherLights_.push_back(i);
        continue;
      }
      fixed_.push_back({i, kNoTable});
      if (lights[i].light->PatchCount() == 1 || !whole_->SelectsPatches({})) continue;
      fixed_.back().table = static_cast<uint32_t>(patched.size());
      patched.push_back(lights[i]);
    }
    const Emitters emitters = CollectEmitters(patched, scene, HardwareThreads());
    for (uint32_t i = 0; i < patched.size(); ++i) {
      std::vector<float> weights;
      for (uint32_t k = emitters.first[i]; k < emitters.first[i + 1]; ++k)
        weights.push_back(emitters.bounds[k].intensity);
      if (std::none_of(weights.begin(), weights.end(), [](float weight) { return weight > 0; }))
        std::fill(weights.begin(), weights.end(), 1.0f);
      patchTables_.emplace_back(weights);
    }
  }

  void Select(const Receiver& receiver, const SelectionSettings& settings, double u,
              LightChoices& choices) const override {
    choices.count = 0;
    if (others_) others_->Select(receiver, OfOthers(settings), u, choices);
    for (int i = 0; i < choices.count; ++i) choices.of[i].light = otherLights_[choices.of[i].light];
    for (const Fixed& fixed : fixed_) {
      const int count = counts_[fixed.light];
      for (int k = 0; k < count; ++k) choices.of[choices.count++] = SelectPatch(fixed, (u + k) / count, count);
    }
  }

  PdfDiscrete Probability(const Receiver& receiver, const SelectionSettings& settings, uint32_t light,
                          int patch) const override {
    if (counts_[light] == 0)
      return others_ ? others_->Probability(receiver, OfOthers(settings), OtherIndexOf(light), patch) : PdfDiscrete(0);
    const auto fixed = std::lower_bound(fixed_.begin(), fixed_.end(), light,
                                        [](const Fixed& one, uint32_t index) { return one.light < index; });
    if (fixed->table == kNoTable || patch == kAnyPatch) return PdfDiscrete(static_cast<float>(counts_[light]));
    return Expected(patchTables_[fixed->table].Probability(static_cast<uint32_t>(patch)), counts_[light]);
  }

  std::optional<SelectedLight> SelectForSegment(const RaySegment& segment, const SegmentLights& lights,
                                                double u) const override {
    return whole_->SelectForSegment(segment, lights, u);
  }
  PdfDiscrete SegmentProbability(const RaySegment& segment, const SegmentLights& lights, uint32_t light,
                                 int patch) const override {
    return whole_->SegmentProbability(segment, lights, light, patch);
  }

  bool Learns() const override { return others_ && others_->Learns(); }
  void Record(LightLearning& learning, const Receiver& receiver, const SelectionSettings& settings, uint32_t light,
              int patch, double irradiance) const override {
    if (others_ && counts_[light] == 0)
      others_->Record(learning, receiver, settings, OtherIndexOf(light), patch, irradiance);
  }

  bool SelectsPatches(const Receiver& receiver) const override { return whole_->SelectsPatches(receiver); }

 private:
  // Settings of `others_`: as many choices as the lights with counts leave.
  SelectionSettings OfOthers(const SelectionSettings& settings) const {
    return {settings.learned, std::clamp(LightChoices::kMost - total_, 1, settings.mostSamples)};
  }

  struct Fixed {
    uint32_t light, table;
  };
  static constexpr uint32_t kNoTable = 0xffffffffu;

  SelectedLight SelectPatch(const Fixed& fixed, double u, int count) const {
    if (fixed.table == kNoTable)
      return {fixed.light, kAnyPatch, PdfDiscrete(static_cast<float>(count)), static_cast<float>(u)};
    const AliasTable::Result choice = patchTables_[fixed.table].Sample(std::min(u, 0x1.fffffffffffffp-1));
    return {fixed.light, static_cast<int>(choice.index), Expected(choice.probability, count), choice.u};
  }
  static PdfDiscrete Expected(PdfDiscrete within, int count) {
    return PdfDiscrete(static_cast<float>(count) * within.value);
  }
  uint32_t OtherIndexOf(uint32_t light) const {
    return static_cast<uint32_t>(std::lower_bound(otherLights_.begin(), otherLights_.end(), light) -
                                 otherLights_.begin());
  }

  std::vector<int> counts_;  // by light
  int total_;
  std::unique_ptr<LightSelector> whole_, others_;
  std::vector<uint32_t> otherLights_;  // those of others_, ascending
  std::vector<Fixed> fixed_;           // ascending
  std::vector<AliasTable> patchTables_;
};

}  // namespace

std::vector<int> FixedCounts(std::span<const PlacedLight> lights) {
  std::vector<int> counts(lights.size());
  std::vector<uint32_t> fixed;
  for (uint32_t i = 0; i < lights.size(); ++i) {
    counts[i] = std::clamp(lights[i].light->Settings().fixedSampleCount, 0, LightChoices::kMost);
    if (counts[i] > 0) fixed.push_back(i);
  }
  // If more lights have counts than there are samples, the last of them are selected like those without a count.
  const bool hasOthers = fixed.size() < lights.size() || fixed.size() > LightChoices::kMost;
  const int room = LightChoices::kMost - (hasOthers ? 1 : 0);
  while (fixed.size() > static_cast<size_t>(room)) {
    counts[fixed.back()] = 0;
    fixed.pop_back();
  }
  // The largest become smaller first.
  const auto isLess = [&](uint32_t a, uint32_t b) { return counts[a] < counts[b]; };
  for (int total = std::accumulate(counts.begin(), counts.end(), 0); total > room; --total)
    --counts[*std::max_element(fixed.begin(), fixed.end(), isLess)];
  return counts;
}

std::unique_ptr<LightSelector> MakeFixedCountSelector(std::span<const PlacedLight> lights, std::span<const int> counts,
                                                      const BoundingSphere& scene, std::unique_ptr<LightSelector> whole,
                                                      std::unique_ptr<LightSelector> others) {
  return std::make_unique<FixedCountSelector>(lights, counts, scene, std::move(whole), std::move(others));
}

}  // namespace lampyr
