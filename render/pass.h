// Shared by the passes of camera paths, of light paths and of both: their parameters, and adding a sample to the film.
#pragma once

#include <optional>
#include <vector>

#include "integrators/walk/pixel_ray.h"
#include "render/passes.h"
#include "sampling/rng.h"

namespace lampyr {

inline constexpr uint64_t kChunkPaths = 4096;  // light paths that one thread traces before their splats are added
inline constexpr uint64_t kOtherHalf = 0xa54ff53a5f1d36f1;  // changes the seed for every second sample of a pixel

// The lane that the paths of a sample follow first where light disperses. The samples of a pixel take turns.
inline int FirstLane(uint64_t seed, uint64_t place, uint64_t sample) {
  return static_cast<int>((MixBits(seed ^ MixBits(place)) + sample) % Wavelengths::kLanes);
}

// Radiance along the ray. If the ray is vignetted, only the light path of the sample is traced, if there is one.
inline Color Radiance(const Integrator& integrator, const PixelRay& ray, const SampleContext& context) {
  if (ray.camera.weight != 0) return SampleLanes(integrator, &ray.camera.ray, context);
  if (integrator.Paths() == TracedPaths::Both) SampleLanes(integrator, nullptr, context);
  return Color(0.0f);
}

// The same; the record of a tested sample receives the radiance, too.
inline Color TestedRadiance(const Integrator& integrator, const PixelRay& ray, const SampleContext& context) {
  const Color radiance = Radiance(integrator, ray, context);
  if (context.tested) [[unlikely]]
    context.tested->End(radiance.Average());
  return radiance;
}

// Adds the samples of one thread to the film.
struct SampleAdder {
  SampleAdder(const RenderSettings& settings, Film& aFilm, RenderCounts& someCounts)
      : sensor(settings.sensor), film(aFilm), counts(someCounts) {
    if (film.HasLayers()) layers.emplace(film.SplitLayers());
  }

  // The cleared layers for the next sample; null: the film has none.
  LayerSample* StartLayers() {
    if (!layers) return nullptr;
    layers->Clear();
    return &*layers;
  }
  // Adds a sample of a pixel to `sums` and to the pixel's layers. An invalid value (negative or not finite) is counted,
  // added to `sums` as black, and left out of the layers. `isInHalf`: it belongs to the layer of half of the samples.
  // `more`, `biasOfPass`: other sums that it is added to; may be null.
  void Add(int x, int y, bool isInHalf, const PixelRay& ray, const Color& radiance, PixelSums& sums,
           PixelSums* more = nullptr, PassBias* biasOfPass = nullptr) {
    const float scale = ray.camera.weight * sensor.Scale(radiance * ray.camera.weight);
    Color value = radiance * scale;
    const bool isValid = value.IsValid();
    if (!isValid) {
      ++counts.droppedSamples;
      value = Color(0.0f);
    }
    sums.Add(sensor.Balance(value), ray.filterWeight);
    if (more) more->Add(sensor.Balance(value), ray.filterWeight);
    if (layers && isValid) film.AddToLayers(x, y, *layers, scale, ray.filterWeight, sensor);
    if (film.HasBands()) film.AddToBands(x, y, value, ray.filterWeight);
    if (film.HasHalf() && isInHalf) film.AddToHalf(x, y, sensor.Balance(value), ray.filterWeight);
    if (film.KeepsBias()) AddBias(x, y, isValid ? scale : 0.0f, ray.filterWeight, biasOfPass);
  }

  // Receives the next sample's estimate of the bias of merging; null if the film keeps none.
  Color* StartBias() {
    mergeBias = Color(0.0f);
    return film.KeepsBias() ? &mergeBias : nullptr;
  }
  // Adds `mergeBias`, scaled as the sample is. Without `ofPass` the sample is all that the pass has in the pixel.
  void AddBias(int x, int y, float scale, float filterWeight, PassBias* ofPass) {
    PassBias own;
    const Color bias = sensor.Balance(mergeBias * scale);
    (ofPass ? *ofPass : own).Add(IsFinite(Vector3(bias.r, bias.g, bias.b)) ? bias : Color(0.0f), filterWeight);
    if (!ofPass) film.AddBias(x, y, own);
  }

  const SensorResponse& sensor;
  Film& film;
  RenderCounts& counts;
  std::optional<LayerSample> layers;
  Color mergeBias;
};

inline RenderCounts Total(const std::vector<RenderCounts>& parts) {
  RenderCounts total;
  for (const RenderCounts& part : parts) total += part;
  return total;
}

// Parameters of all kinds of pass.
struct Pass {
  const RenderScene& scene;
  const Integrator& integrator;
  const RenderSettings& settings;
  const PixelFilter& filter;
  uint32_t first, end;  // samples
  int threads;
  Film& film;
  const SampleAllocation* allocation;  // null: one sample for each pixel
  PathLearning* learning;              // null: camera paths are not recorded
  SelectionTest* selection;            // null: selection of lights learns nothing
  const LightEdges* edges;             // null: all samples have one camera ray

  // FirstLane of a sample of a pixel.
  int FirstLaneOf(int x, int y, uint64_t sample) const {
    return scene.isSpectral ? FirstLane(Seed(), static_cast<uint64_t>(y) << 32 | static_cast<uint64_t>(x), sample) : 0;
  }
  // Samplers count the samples of a stage.
  uint32_t Offset() const { return allocation ? allocation->Stage().first : 0; }
  uint64_t Seed() const { return allocation ? allocation->Stage().seed : settings.seed; }
  // The plan of the layers of the film that are those of expressions; null: it has none.
  const OutputPlan* Outputs() const { return film.HasLayers() && PlannedLayers() > 0 ? scene.outputs.get() : nullptr; }
  // Layers of the film beyond those of the plan are those of strategies.
  bool HasStrategies() const { return film.HasLayers() && film.SplitLayers() > PlannedLayers(); }
  size_t PlannedLayers() const { return scene.outputs->Layers().size(); }
  uint64_t Pixels() const { return static_cast<uint64_t>(settings.width) * static_cast<uint64_t>(settings.height); }
  // Records of `parts` parts of a pass, which begin without any.
  std::vector<PathRecords> MakeRecords(size_t parts) const {
    std::vector<PathRecords> records(learning ? parts : 0);
    for (PathRecords& part : records) part.SetFraction(learning->Fraction());
    return records;
  }
  // Tested samples of `parts` parts of a pass, which begin without any.
  std::vector<TestedSamples> MakeTested(size_t parts) const {
    std::vector<TestedSamples> tested(selection ? parts : 0);
    for (TestedSamples& part : tested) part.SetFraction(selection->Fraction(), selection->Tests());
    return tested;
  }
  // `context`: of the sample of index `sample` of a pixel; null `records`: not recorded; null `tested`: not tested.
  void Record(int x, int y, uint64_t sample, PathRecords* records, TestedSamples* tested,
              SampleContext& context) const {
    context.records = records;
    context.pixel = static_cast<uint32_t>(y) * static_cast<uint32_t>(settings.width) + static_cast<uint32_t>(x);
    context.sample = static_cast<uint32_t>(sample);
    if (!tested) return;
    constexpr uint64_t kOthersThanRecords = 0x6a09e667f3bcc908;
    if (!tested->Wants(MixBits((uint64_t{context.pixel} << 32 | context.sample) ^ kOthersThanRecords))) return;
    tested->Start(context.pixel, context.sample);
    context.tested = tested;
  }
};

// Starts the samples of pixels in an adaptive film, where the layer of half of the samples has every second one, and a
// sequence of its own.
class AdaptiveSampler {
 public:
  AdaptiveSampler(const Pass& pass)
      : halves_(pass.film.HasHalf()),
        first_(pass.settings.sampler, pass.Seed()),
        second_(pass.settings.sampler, MixBits(pass.Seed() + kOtherHalf)) {}

  // `number`: of the sample in the pixel and stage.
  Sampler& Start(int x, int y, uint64_t number) {
    Sampler& sampler = halves_ && !IsInHalf(number) ? second_ : first_;
    sampler.StartPixelSample(x, y, static_cast<uint32_t>(halves_ ? number / 2 : number));
    return sampler;
  }
  static bool IsInHalf(uint64_t number) { return number % 2 == 0; }

 private:
  bool halves_;
  Sampler first_, second_;
};

}  // namespace lampyr
