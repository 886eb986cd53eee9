#include "lights/selection/tree_selector.h"

#include <algorithm>
#include <cmath>

#include "lights/selection/emitter_list.h"
#include "lights/selection/emitters.h"
#include "lights/selection/light_learning.h"
#include "lights/selection/light_tree.h"
#include "sampling/tables.h"

namespace lampyr {

namespace {

// Chosen without a look at the receiver ([Hesterberg95] calls it defensive): what the estimate overlooks, or takes for
// much less than it is, is chosen at least this part as often as by intensity.
constexpr double kBlind = 0.05;
// Of the lights at infinity, and of those with a place, where there are both.
constexpr double kSmallestGroup = 0.05;
constexpr float kLargest = 1e30f;

template <class Search>
class TreeSelector final : public LightSelector {
 public:
  TreeSelector(std::span<const PlacedLight> lights, const BoundingSphere& scene, int threads)
      : emitters_(CollectEmitters(lights, scene, threads)), search_(emitters_.bounds, threads) {
    emitters_.bounds = {};
    std::vector<float> weights;
    for (const uint32_t light : emitters_.far) weights.push_back(FarIrradiance(lights[light], scene));
    for (const float weight : weights) farIrradiance_ += static_cast<double>(weight);
    // One whose estimate at the scene's middle is nothing may shine elsewhere, as through a window.
    constexpr double floor = 1e-3;
    const double mean = weights.empty() ? 0 : farIrradiance_ / static_cast<double>(weights.size());
    for (float& weight : weights) weight = mean > 0 ? std::max(weight, static_cast<float>(floor * mean)) : 1.0f;
    farTable_ = AliasTable(weights);
  }

  bool SelectsPatches() const override { return emitters_.hasPatches; }

  std::optional<SelectedLight> Select(const Receiver& receiver, double u) const override {
    const TreeReceiver place = Place(receiver);
    typename Search::Cut cut;
    search_.Look(place, cut);
    const double far = FarShare(place, cut.irradiance);
    if (u < far) {
      const AliasTable::Result choice = farTable_.Sample(u / far);
      return SelectedLight{emitters_.far[choice.index], kAnyPatch,
                           PdfDiscrete(static_cast<float>(far * static_cast<double>(choice.probability.value))),
                           choice.u};
    }
    if (search_.IsEmpty()) return std::nullopt;
    double x = (u - far) / (1 - far);
    const bool blindly = x < kBlind;
    x = blindly ? x / kBlind : (x - kBlind) / (1 - kBlind);
    const EmitterChoice choice = search_.Select(place, cut, std::min(x, 0x1.fffffffffffffp-1), blindly);
    const uint32_t light = emitters_.lightOf[choice.emitter];
    return SelectedLight{light, PatchOf(light, choice.emitter), Mix(choice.probability, far),
                         static_cast<float>(std::min(choice.u, 0x1.fffffep-1))};
  }

  PdfDiscrete Probability(const Receiver& receiver, uint32_t light, int patch) const override {
    const TreeReceiver place = Place(receiver);
    typename Search::Cut cut;
    search_.Look(place, cut);
    const double far = FarShare(place, cut.irradiance);
    const auto at = std::find(emitters_.far.begin(), emitters_.far.end(), light);
    if (at != emitters_.far.end()) {
      if (farTable_.IsZero()) return PdfDiscrete(0);
      const float within = farTable_.Probability(static_cast<uint32_t>(at - emitters_.far.begin())).value;
      return PdfDiscrete(static_cast<float>(far * static_cast<double>(within)));
    }
    if (search_.IsEmpty()) return PdfDiscrete(0);
    const std::optional<uint32_t> emitter = EmitterOf(light, patch);
    if (!emitter) return PdfDiscrete(0);
    return Mix(search_.ProbabilityOf(place, cut, *emitter), far);
  }

  void Use(LightLearning* learning) override { learning_ = learning; }

  void Record(const Receiver& receiver, uint32_t light, int patch, double irradiance) const override {
    if (!learning_) return;
    const TreeReceiver place = Place(receiver);
    const auto at = std::find(emitters_.far.begin(), emitters_.far.end(), light);
    if (at != emitters_.far.end()) {
      const float within = farTable_.Probability(static_cast<uint32_t>(at - emitters_.far.begin())).value;
      if (farIrradiance_ > 0)
        learning_->Record(place.region, LightTree::kNone, 0, irradiance / static_cast<double>(within) / farIrradiance_);
      return;
    }
    if constexpr (std::is_same_v<Search, LightTree>) {
      const std::optional<uint32_t> emitter = EmitterOf(light, patch);
      if (!emitter) return;
      LightTree::Cut cut;
      search_.Look(place, cut);
      search_.Record(*learning_, place, cut, *emitter, kBlind, emitters_.ImportanceOf(irradiance));
    }
  }

 private:
  int PatchOf(uint32_t light, uint32_t emitter) const {
    const uint32_t first = emitters_.first[light];
    return emitters_.first[light + 1] - first > 1 ? static_cast<int>(emitter - first) : kAnyPatch;
  }

  std::optional<uint32_t> EmitterOf(uint32_t light, int patch) const {
    const uint32_t first = emitters_.first[light], count = emitters_.first[light + 1] - first;
    const uint32_t emitter = first + (count > 1 ? static_cast<uint32_t>(patch) : 0u);
    return emitter < first + count ? std::optional(emitter) : std::nullopt;
  }

  TreeReceiver Place(const Receiver& receiver) const {
    TreeReceiver place = emitters_.Place(receiver);
    if (learning_) {
      place.learning = learning_;
      place.region = learning_->RegionOf(receiver);
    }
    return place;
  }

  static PdfDiscrete Mix(const EmitterProbability& probability, double far) {
    return PdfDiscrete(static_cast<float>((1 - far) * (kBlind * probability.blind + (1 - kBlind) * probability.seen)));
  }

  static float FarIrradiance(const PlacedLight& placed, const BoundingSphere& scene) {
    LightContext context;
    context.transform = &placed.transform;
    context.scene = scene;
    const float irradiance = placed.light->GetIncidentRadianceEstimate(context, scene.center);
    return irradiance > 0 ? std::min(irradiance, kLargest) * placed.light->Settings().importanceMultiplier : 0.0f;
  }

  // How often the lights at infinity are chosen: by their irradiance against what the others are estimated to send
  // here.
  double FarShare(const TreeReceiver& place, double importance) const {
    if (farTable_.IsZero()) return 0;
    if (search_.IsEmpty()) return 1;
    const double near = emitters_.Irradiance(importance);
    double far = farIrradiance_;
    if (place.learning) {
      const LightLearning::Row& row = place.learning->RowOf(place.region, LightTree::kNone);
      far *= std::sqrt(static_cast<double>(row.known[0] + row.unknown[0]));
    }
    const double share = far / (far + near);
    return std::clamp(share, kSmallestGroup, 1 - kSmallestGroup);
  }

  Emitters emitters_;
  Search search_;
  AliasTable farTable_;
  double farIrradiance_ = 0;
  LightLearning* learning_ = nullptr;
};

}  // namespace

std::unique_ptr<LightSelector> MakeTreeSelector(EmitterSearch search, std::span<const PlacedLight> lights,
                                                const BoundingSphere& scene, int threads) {
  if (search == EmitterSearch::Exhaustive) return std::make_unique<TreeSelector<EmitterList>>(lights, scene, threads);
  return std::make_unique<TreeSelector<LightTree>>(lights, scene, threads);
}

}  // namespace lampyr
