#include "lights/selection/tree_selector.h"

#include <algorithm>
#include <cmath>

#include "lights/selection/emitter_list.h"
#include "lights/selection/emitters.h"
#include "lights/selection/far_lights.h"
#include "lights/selection/light_learning.h"
#include "lights/selection/light_tree.h"

namespace lampyr {

namespace {

// Fraction of choices by intensity alone (defensive sampling, [Hesterberg95]): bounds the weight of emitters whose
// importance is estimated too low.
constexpr double kDefensiveShare = 0.05;
// Lower bound of the fractions of lights at infinity and of lights with a position, if there are both.
constexpr double kSmallestGroup = 0.05;

template <class Search>
class TreeSelector final : public LightSelector {
 public:
  TreeSelector(std::span<const PlacedLight> lights, const BoundingSphere& scene, int threads)
      : emitters_(CollectEmitters(lights, scene, threads)),
        search_(emitters_.bounds, threads),
        diameter_(2 * static_cast<double>(scene.radius)),
        farLights_(lights, emitters_.far, scene) {
    emitters_.bounds = {};
  }

  bool SelectsPatches(const Receiver&) const override { return emitters_.hasPatches; }

  void Select(const Receiver& receiver, const SelectionSettings& settings, double u,
              LightChoices& choices) const override {
    const TreeReceiver place = Place(receiver, settings.learned);
    typename Search::Cut cut;
    search_.Look(place, cut);
    const Far far = FarAt(place, cut.irradiance);
    choices.count = search_.IsEmpty() && farLights_.IsEmpty() ? 0 : CountFor(cut, far.share, settings.mostSamples);
    const auto select = [&](double x, bool defensive) { return search_.Select(place, cut, x, defensive); };
    for (int k = 0; k < choices.count; ++k)
      choices.of[k] = SelectOne(far, (u + k) / choices.count, choices.count, select);
  }

  PdfDiscrete Probability(const Receiver& receiver, const SelectionSettings& settings, uint32_t light,
                          int patch) const override {
    const TreeReceiver place = Place(receiver, settings.learned);
    typename Search::Cut cut;
    search_.Look(place, cut);
    const Far far = FarAt(place, cut.irradiance);
    const int count = CountFor(cut, far.share, settings.mostSamples);
    const std::optional<uint32_t> at = farLights_.IndexOf(light);
    if (at) return FarExpected(farLights_.Probability(far.place, *at), far.share, count);
    if (search_.IsEmpty()) return PdfDiscrete(0);
    return SumOver(light, patch, [&](uint32_t emitter) {
      return Expected(search_.ProbabilityOf(place, cut, emitter), far.share, count);
    });
  }

  std::optional<SelectedLight> SelectForSegment(const RaySegment& segment, const SegmentLights& lights,
                                                double u) const override {
    if (search_.IsEmpty() && farLights_.IsEmpty()) return std::nullopt;
    const TreeSegment place = Place(segment);
    const EmittersOfLights emitters(emitters_, lights, place);
    typename Search::SegmentCut cut;
    search_.LookAlong(place, emitters, cut);
    return SelectOne({{}, FarShareAlong(segment, cut.fluence)}, u, 1,
                     [&](double x, bool defensive) { return search_.SelectAlong(place, emitters, cut, x, defensive); });
  }

  PdfDiscrete SegmentProbability(const RaySegment& segment, const SegmentLights& lights, uint32_t light,
                                 int patch) const override {
    const TreeSegment place = Place(segment);
    const EmittersOfLights emitters(emitters_, lights, place);
    typename Search::SegmentCut cut;
    search_.LookAlong(place, emitters, cut);
    const double far = FarShareAlong(segment, cut.fluence);
    const std::optional<uint32_t> at = farLights_.IndexOf(light);
    if (at) return FarExpected(farLights_.Probability({}, *at), far, 1);
    if (search_.IsEmpty()) return PdfDiscrete(0);
    return SumOver(light, patch, [&](uint32_t emitter) {
      return Expected(search_.ProbabilityAlong(place, emitters, cut, emitter), far, 1);
    });
  }

  // Learning does not distinguish lights at infinity.
  bool Learns() const override {
    const bool hasChoice = emitters_.first.back() - emitters_.far.size() > 1 || !farLights_.IsEmpty();
    return std::is_same_v<Search, LightTree> && !search_.IsEmpty() && hasChoice;
  }
  void Record(LightLearning& learning, const Receiver& receiver, const SelectionSettings& settings, uint32_t light,
              int patch, double irradiance) const override {
    TreeReceiver place = Place(receiver, settings.learned);
    place.region = learning.RegionOf(receiver);
    const std::optional<uint32_t> at = farLights_.IndexOf(light);
    if (at) {
      const FarLights::Place normal = farLights_.PlaceOf(place.normal, place.isTransmissive);
      const double expected =
          farLights_.Irradiance(normal) * static_cast<double>(farLights_.Probability(normal, *at).value);
      if (expected > 0) {
        const double whole = farLights_.Whole(normal, *at);
        learning.Record(place.region, LightTree::kNone, 0, irradiance / (expected * whole));
      }
      return;
    }
    if constexpr (std::is_same_v<Search, LightTree>) {
      const std::optional<uint32_t> emitter = EmitterOf(light, patch);
      if (!emitter) return;
      LightTree::Cut cut;
      search_.Look(place, cut);
      search_.Record(learning, place, cut, *emitter, kDefensiveShare, emitters_.ImportanceOf(irradiance));
    }
  }

 private:
  // The lights at infinity as seen from a receiver or a segment.
  struct Far {
    FarLights::Place place;
    double share;  // probability of selecting one of them
  };

  // Null: the light has no such patch, or has several and `patch` is kAnyPatch.
  std::optional<uint32_t> EmitterOf(uint32_t light, int patch) const {
    const uint32_t first = emitters_.first[light], count = emitters_.first[light + 1] - first;
    const uint32_t index = count > 1 ? static_cast<uint32_t>(patch) : 0u;
    return index < count ? std::optional(first + index) : std::nullopt;
  }
  // The sum of `probabilityOf` over the emitters of a light that `patch` selects: with kAnyPatch, all of its patches.
  template <class Function>
  PdfDiscrete SumOver(uint32_t light, int patch, const Function& probabilityOf) const {
    if (patch == kAnyPatch) {
      PdfDiscrete sum(0);
      for (uint32_t i = emitters_.first[light]; i < emitters_.first[light + 1]; ++i) sum = sum + probabilityOf(i);
      return sum;
    }
    const std::optional<uint32_t> emitter = EmitterOf(light, patch);
    return emitter ? probabilityOf(*emitter) : PdfDiscrete(0);
  }

  TreeReceiver Place(const Receiver& receiver, const LightLearning* learned) const {
    TreeReceiver place = emitters_.Place(receiver);
    if (learned) {
      place.learning = learned;
      place.region = learned->RegionOf(receiver);
    }
    return place;
  }

  TreeSegment Place(const RaySegment& segment) const {
    const double scale = 1 / static_cast<double>(emitters_.size);
    return {(Point3d(segment.origin) - Point3d(emitters_.center)) * scale, segment.direction,
            static_cast<double>(segment.length) * scale};
  }

  // The emitters of the search for one segment, by the estimates of their lights.
  struct EmittersOfLights final : SegmentEmitters {
    const Emitters& emitters;
    const SegmentLights& lights;
    const TreeSegment& segment;

    EmittersOfLights(const Emitters& all, const SegmentLights& seen, const TreeSegment& place)
        : emitters(all), lights(seen), segment(place) {}
    double ImportanceOf(uint32_t emitter, const ClusterLobe& lobe) const override {
      const Emitters::Patch own = emitters.PatchOf(emitter);
      const std::optional<SegmentEstimate> estimate = lights.EstimateOf(own.light, own.patch);
      if (!estimate) return 0;
      const double scale = 1 / static_cast<double>(emitters.size);
      return OwnImportanceAlong(lobe, segment, emitters.ImportanceOf(static_cast<double>(estimate->radiance)),
                                static_cast<double>(estimate->minT) * scale,
                                static_cast<double>(estimate->maxT) * scale);
    }
  };

  // `select(x, defensive)`: the emitter that the search selects by x.
  template <class Select>
  SelectedLight SelectOne(const Far& far, double u, int count, const Select& select) const {
    if (u < far.share || search_.IsEmpty()) {
      const FarLights::Choice choice = farLights_.Select(far.place, u / far.share);
      return {farLights_.LightAt(choice.index), kAnyPatch, FarExpected(choice.probability, far.share, count), choice.u};
    }
    double x = (u - far.share) / (1 - far.share);
    const bool defensive = x < kDefensiveShare;
    x = defensive ? x / kDefensiveShare : (x - kDefensiveShare) / (1 - kDefensiveShare);
    const EmitterChoice choice = select(std::min(x, 0x1.fffffffffffffp-1), defensive);
    const Emitters::Patch own = emitters_.PatchOf(choice.emitter);
    return {own.light, own.patch, Expected(choice.probability, far.share, count),
            static_cast<float>(std::min(choice.u, 0x1.fffffep-1))};
  }

  static PdfDiscrete Expected(const EmitterProbability& probability, double far, int count) {
    return PdfDiscrete(static_cast<float>(count * ((1 - far) * (kDefensiveShare * probability.defensive +
                                                                (1 - kDefensiveShare) * probability.byImportance))));
  }
  static PdfDiscrete FarExpected(PdfDiscrete within, double far, int count) {
    return PdfDiscrete(static_cast<float>(count * (far * static_cast<double>(within.value))));
  }

  // As many samples as the effective number of clusters and lights at infinity at this receiver: if one of them causes
  // nearly all of the irradiance, a second sample reduces little variance.
  [[gnu::noinline]] int CountFor(const typename Search::Cut& cut, double far, int most) const {
    if (most == 1) return 1;
    const double ofFar = farLights_.IsEmpty() ? 0 : far * far / static_cast<double>(farLights_.Count());
    const double squares = ofFar + (1 - far) * (1 - far) * cut.Concentration();
    return std::clamp(static_cast<int>(std::lround(1 / std::max(squares, 1e-3))), 1, most);
  }

  // Lights at infinity at a receiver, and the probability of selecting one of them: their share of the estimated
  // irradiance here.
  Far FarAt(const TreeReceiver& receiver, double importance) const {
    if (farLights_.IsEmpty()) return {{}, 0};
    const FarLights::Place place = farLights_.PlaceOf(receiver.normal, receiver.isTransmissive);
    return {place, search_.IsEmpty() ? 1 : FarShare(receiver, place, importance)};
  }

  // Not inlined, so that the same receiver always gives the same bits.
  [[gnu::noinline]] double FarShare(const TreeReceiver& place, const FarLights::Place& normal,
                                    double importance) const {
    const double near = emitters_.Irradiance(importance);
    double far = farLights_.Irradiance(normal);
    if (place.learning) {
      const LightLearning::Row& row = place.learning->RowOf(place.region, LightTree::kNone);
      far *= std::sqrt(static_cast<double>(row.known[0] + (1 - row.learned[0])));
    }
    return far > 0 ? std::clamp(far / (far + near), kSmallestGroup, 1 - kSmallestGroup) : kSmallestGroup;
  }

  // The same for a segment, along which irradiance from infinity is constant. `fluence`: by the emitters.
  [[gnu::noinline]] double FarShareAlong(const RaySegment& segment, double fluence) const {
    if (farLights_.IsEmpty()) return 0;
    if (search_.IsEmpty()) return 1;
    const double near = emitters_.Irradiance(fluence) * static_cast<double>(emitters_.size);
    const double far = farLights_.Irradiance() * std::min(static_cast<double>(segment.length), diameter_);
    return far > 0 ? std::clamp(far / (far + near), kSmallestGroup, 1 - kSmallestGroup) : kSmallestGroup;
  }

  Emitters emitters_;
  Search search_;
  double diameter_;  // of the scene
  FarLights farLights_;
};

}  // namespace

std::unique_ptr<LightSelector> MakeTreeSelector(EmitterSearch search, std::span<const PlacedLight> lights,
                                                const BoundingSphere& scene, int threads) {
  if (search == EmitterSearch::Exhaustive) return std::make_unique<TreeSelector<EmitterList>>(lights, scene, threads);
  return std::make_unique<TreeSelector<LightTree>>(lights, scene, threads);
}

}  // namespace lampyr
