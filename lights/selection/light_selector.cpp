// Selection independent of the receiver: uniform and by power.
#include "lights/selection/light_selector.h"

#include <array>
#include <limits>
#include <vector>

#include "base/parallel.h"
#include "lights/selection/fixed_counts.h"
#include "lights/selection/tree_selector.h"
#include "sampling/tables.h"

namespace lampyr {

namespace {

class TableSelector final : public LightSelector {
 public:
  explicit TableSelector(std::span<const float> weights) : table_(weights) {}

  void Select(const Receiver&, const SelectionSettings& settings, double u, LightChoices& choices) const override {
    choices.count = table_.IsZero() ? 0 : settings.mostSamples;
    for (int k = 0; k < choices.count; ++k) {
      choices.of[k] = SelectOne((u + k) / choices.count);
      choices.of[k].probability = Expected(choices.of[k].probability, settings.mostSamples);
    }
  }

  PdfDiscrete Probability(const Receiver&, const SelectionSettings& settings, uint32_t light, int) const override {
    return Expected(ProbabilityOf(light), settings.mostSamples);
  }

  std::optional<SelectedLight> SelectForSegment(const RaySegment&, const SegmentLights&, double u) const override {
    if (table_.IsZero()) return std::nullopt;
    return SelectOne(u);
  }
  PdfDiscrete SegmentProbability(const RaySegment&, const SegmentLights&, uint32_t light, int) const override {
    return ProbabilityOf(light);
  }

 private:
  SelectedLight SelectOne(double u) const {
    if (table_.Size() == 1) return {0, kAnyPatch, PdfDiscrete(1), static_cast<float>(u)};
    const AliasTable::Result choice = table_.Sample(u);
    return {choice.index, kAnyPatch, choice.probability, choice.u};
  }
  PdfDiscrete ProbabilityOf(uint32_t light) const {
    if (table_.IsZero()) return PdfDiscrete(0);
    return table_.Size() == 1 ? PdfDiscrete(1) : table_.Probability(light);
  }
  static PdfDiscrete Expected(PdfDiscrete probability, int count) {
    return PdfDiscrete(static_cast<float>(count) * probability.value);
  }

  AliasTable table_;
};

// Mean over the shutter if the light moves.
float MeanPower(const PlacedLight& placed, const BoundingSphere& scene) {
  LightContext context;
  context.transform = &placed.transform;
  context.scene = scene;
  if (!placed.motion) return placed.light->GetPowerEstimate(context).Average();
  constexpr int times = 5;
  float sum = 0;
  for (int i = 0; i < times; ++i) {
    context.time = static_cast<float>(i) / (times - 1);
    const LightTransform transform = placed.At(context.time);
    context.transform = &transform;
    sum += placed.light->GetPowerEstimate(context).Average() / times;
  }
  return sum;
}

std::vector<float> PowerWeights(std::span<const PlacedLight> lights, const BoundingSphere& scene) {
  std::vector<float> weights;
  for (const PlacedLight& placed : lights) {
    const float power =
        MeanPower(placed, scene) * placed.light->Settings().importanceMultiplier * placed.radianceModifier;
    // Power is clamped to the range of float; NaN compares false.
    weights.push_back(power > 0 ? std::min(power, std::numeric_limits<float>::max()) : 0.0f);
  }
  return weights;
}

// Power is an estimate and may be far too low. Every light has at least this fraction of the uniform probability;
// lights that emit nothing cost little by it.
constexpr float kFloorOfEqualShare = 1e-3f;

// Raises the weights of the lights for which isChosen(index) to the floor. Those of the others become 0.
template <class IsChosen>
void RaiseToFloor(std::vector<float>& weights, const IsChosen& isChosen) {
  double total = 0;
  size_t count = 0;
  for (size_t i = 0; i < weights.size(); ++i) {
    if (!isChosen(i)) continue;
    total += static_cast<double>(weights[i]);
    ++count;
  }
  const float mean = count == 0 ? 0.0f : static_cast<float>(total / static_cast<double>(count));
  for (size_t i = 0; i < weights.size(); ++i)
    weights[i] = !isChosen(i) ? 0.0f : mean > 0 ? std::max(weights[i], kFloorOfEqualShare * mean) : 1.0f;
}

}  // namespace

namespace {

constexpr std::array<const char*, 4> kSelectionNames = {"uniform", "power", "tree", "exhaustive"};

}  // namespace

std::optional<LightSelection> ParseLightSelection(const std::string& name) {
  if (name == "bvh") return LightSelection::Tree;
  const auto at = std::find(kSelectionNames.begin(), kSelectionNames.end(), name);
  if (at == kSelectionNames.end()) return std::nullopt;
  return static_cast<LightSelection>(at - kSelectionNames.begin());
}

std::string NameOf(LightSelection selection) {
  return kSelectionNames.at(static_cast<size_t>(selection));
}

std::unique_ptr<LightSelector> MakeTableSelector(std::span<const float> weights) {
  return std::make_unique<TableSelector>(weights);
}

namespace {

// A selector that ignores sample counts of lights. `byImportance`: Tree and Exhaustive select by importance, otherwise
// uniformly.
std::unique_ptr<LightSelector> MakeSelector(LightSelection selection, std::span<const PlacedLight> lights,
                                            const BoundingSphere& scene, bool byImportance) {
  if (byImportance && selection == LightSelection::Tree)
    return MakeTreeSelector(EmitterSearch::Tree, lights, scene, HardwareThreads());
  if (byImportance && selection == LightSelection::Exhaustive)
    return MakeTreeSelector(EmitterSearch::Exhaustive, lights, scene, HardwareThreads());
  std::vector<float> weights(lights.size(), 1.0f);
  if (selection == LightSelection::Power) {
    weights = PowerWeights(lights, scene);
    RaiseToFloor(weights, [](size_t) { return true; });
  }
  return MakeTableSelector(weights);
}

}  // namespace

std::unique_ptr<LightSelector> MakeLightSelector(LightSelection selection, std::span<const PlacedLight> lights,
                                                 const BoundingSphere& scene) {
  // For one light, or the two halves of one rectangle, importance does not repay its cost.
  const bool hasChoice = lights.size() > 1 || (lights.size() == 1 && lights[0].light->PatchCount() > 2);
  std::unique_ptr<LightSelector> whole = MakeSelector(selection, lights, scene, hasChoice);
  const std::vector<int> counts = FixedCounts(lights);
  std::vector<PlacedLight> others;
  for (size_t i = 0; i < lights.size(); ++i) {
    if (counts[i] == 0) others.push_back(lights[i]);
  }
  if (others.size() == lights.size()) return whole;
  // `whole` and the selector of the others both select patches, or neither does.
  return MakeFixedCountSelector(lights, counts, scene, std::move(whole),
                                others.empty() ? nullptr : MakeSelector(selection, others, scene, hasChoice));
}

std::unique_ptr<LightSelector> MakeEmissionSelector(std::span<const PlacedLight> lights, const BoundingSphere& scene) {
  std::vector<float> weights = PowerWeights(lights, scene);
  RaiseToFloor(weights, [&](size_t i) { return lights[i].light->Settings().traceLightPaths; });
  return MakeTableSelector(weights);
}

}  // namespace lampyr
