#include "lights/selection/linked_selector.h"

#include <algorithm>
#include <vector>

namespace lampyr {

namespace {

constexpr uint32_t kAllLights = 0xffffffffu;

// The lights of a set, by their indices in it.
class LightsOfSet final : public SegmentLights {
 public:
  LightsOfSet(const SegmentLights& all, std::span<const uint32_t> members) : all_(all), members_(members) {}
  std::optional<SegmentEstimate> EstimateOf(uint32_t light, int patch) const override {
    return all_.EstimateOf(members_[light], patch);
  }

 private:
  const SegmentLights& all_;
  std::span<const uint32_t> members_;
};

class LinkedSelector final : public LightSelector {
 public:
  LinkedSelector(LightSelection selection, std::span<const PlacedLight> lights, const BoundingSphere& scene,
                 const LightSets& sets)
      : setOfClass_(sets.ofClass), all_(MakeLightSelector(selection, lights, scene)) {
    size_t room = 1000000;
    for (const PlacedLight& placed : lights) room += 4 * static_cast<size_t>(placed.light->PatchCount());
    std::vector<uint32_t> place;  // for each set, its index among those with a selector
    for (const std::vector<uint32_t>& members : sets.lights) {
      size_t emitters = 0;
      for (const uint32_t light : members) emitters += static_cast<size_t>(lights[light].light->PatchCount());
      if (members.size() == lights.size() || emitters > room) {
        place.push_back(kAllLights);
        continue;
      }
      room -= emitters;
      place.push_back(static_cast<uint32_t>(parts_.size()));
      std::vector<PlacedLight> own;
      for (const uint32_t light : members) own.push_back(lights[light]);
      parts_.push_back({MakeLightSelector(selection, own, scene), members});
    }
    for (uint32_t& set : setOfClass_) set = place[set];
  }

  // Learned factors belong to one tree, that of all lights.
  void Select(const Receiver& receiver, const SelectionSettings& settings, double u,
              LightChoices& choices) const override {
    const Part* part = PartOf(receiver.link);
    if (!part) return all_->Select(receiver, settings, u, choices);
    part->selector->Select(receiver, {nullptr, settings.mostSamples}, u, choices);
    for (int i = 0; i < choices.count; ++i) choices.of[i].light = part->lights[choices.of[i].light];
  }

  PdfDiscrete Probability(const Receiver& receiver, const SelectionSettings& settings, uint32_t light,
                          int patch) const override {
    const Part* part = PartOf(receiver.link);
    if (!part) return all_->Probability(receiver, settings, light, patch);
    const std::optional<uint32_t> own = part->IndexOf(light);
    return own ? part->selector->Probability(receiver, {nullptr, settings.mostSamples}, *own, patch) : PdfDiscrete(0);
  }

  std::optional<SelectedLight> SelectForSegment(const RaySegment& segment, const SegmentLights& lights,
                                                double u) const override {
    const Part* part = PartOf(segment.link);
    if (!part) return all_->SelectForSegment(segment, lights, u);
    auto selected = part->selector->SelectForSegment(segment, LightsOfSet(lights, part->lights), u);
    if (selected) selected->light = part->lights[selected->light];
    return selected;
  }
  PdfDiscrete SegmentProbability(const RaySegment& segment, const SegmentLights& lights, uint32_t light,
                                 int patch) const override {
    const Part* part = PartOf(segment.link);
    if (!part) return all_->SegmentProbability(segment, lights, light, patch);
    const std::optional<uint32_t> own = part->IndexOf(light);
    if (!own) return PdfDiscrete(0);
    return part->selector->SegmentProbability(segment, LightsOfSet(lights, part->lights), *own, patch);
  }

  bool Learns() const override {
    return all_->Learns() && std::find(setOfClass_.begin(), setOfClass_.end(), kAllLights) != setOfClass_.end();
  }
  void Record(LightLearning& learning, const Receiver& receiver, const SelectionSettings& settings, uint32_t light,
              int patch, double irradiance) const override {
    if (!PartOf(receiver.link)) all_->Record(learning, receiver, settings, light, patch, irradiance);
  }

  bool SelectsPatches(const Receiver& receiver) const override {
    const Part* part = PartOf(receiver.link);
    return part ? part->selector->SelectsPatches(receiver) : all_->SelectsPatches(receiver);
  }

 private:
  struct Part {
    std::unique_ptr<LightSelector> selector;
    std::vector<uint32_t> lights;  // ascending

    std::optional<uint32_t> IndexOf(uint32_t light) const {
      const auto at = std::lower_bound(lights.begin(), lights.end(), light);
      if (at == lights.end() || *at != light) return std::nullopt;
      return static_cast<uint32_t>(at - lights.begin());
    }
  };

  const Part* PartOf(uint32_t link) const {
    if (link == Receiver::kCamera) return nullptr;
    const uint32_t set = setOfClass_[link];
    return set == kAllLights ? nullptr : &parts_[set];
  }

  std::vector<uint32_t> setOfClass_;
  std::unique_ptr<LightSelector> all_;
  std::vector<Part> parts_;
};

}  // namespace

std::unique_ptr<LightSelector> MakeLinkedSelector(LightSelection selection, std::span<const PlacedLight> lights,
                                                  const BoundingSphere& scene, const LightSets& sets) {
  return std::make_unique<LinkedSelector>(selection, lights, scene, sets);
}

}  // namespace lampyr
