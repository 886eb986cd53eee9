// A sound light with a fault planted by functions: each is called with what the sound light answered, and changes it.
#pragma once

#include <atomic>
#include <functional>
#include <utility>

#include "lights/forwarding_light.h"
#include "scene/parameters.h"

namespace lampyr::test {

// One call of a light's method.
struct LightCall {
  const Light& sound;
  const LightContext& context;
  Point3 P{0.0f};  // the receiver, where there is one
};

// Empty functions leave the light as it is.
struct LightHooks {
  std::function<void(const LightCall&, std::optional<LightSample>&)> sample;
  std::function<void(const LightCall&, const LightHit&, std::optional<LightEvaluation>&)> evaluation;
  std::function<void(const LightCall&, std::optional<EmissionSample>&)> photon;
  std::function<void(const LightCall&, std::optional<EmissionBounds>&)> bounds;
  std::function<Color(const LightCall&, const LightHit&)> camera;
  std::function<Color(const LightCall&)> power;
  int patches = 0;  // that the light claims to have; 0: those of the sound one
};

class PlantedLight final : public ForwardingLight {
 public:
  PlantedLight(std::shared_ptr<const Light> light, LightHooks hooks)
      : ForwardingLight(std::move(light)), hooks_(std::move(hooks)) {}

  int PatchCount() const override { return hooks_.patches > 0 ? hooks_.patches : Sound().PatchCount(); }
  std::optional<LightSample> GenerateSamples(const LightContext& context, const Point3& P) const override {
    auto sample = Sound().GenerateSamples(context, P);
    if (hooks_.sample) hooks_.sample({Sound(), context, P}, sample);
    return sample;
  }
  std::optional<LightEvaluation> EvaluateSamples(const LightContext& context, const LightHit& hit,
                                                 const Point3& P) const override {
    auto evaluation = Sound().EvaluateSamples(context, hit, P);
    if (hooks_.evaluation) hooks_.evaluation({Sound(), context, P}, hit, evaluation);
    return evaluation;
  }
  std::optional<EmissionSample> GenerateEmission(const LightContext& context) const override {
    auto photon = Sound().GenerateEmission(context);
    if (hooks_.photon) hooks_.photon({Sound(), context}, photon);
    return photon;
  }
  std::optional<EmissionBounds> GetEmissionBounds(const LightContext& context) const override {
    auto bounds = Sound().GetEmissionBounds(context);
    if (hooks_.bounds) hooks_.bounds({Sound(), context}, bounds);
    return bounds;
  }
  Color EvaluateEmissionForCamera(const LightContext& context, const LightHit& hit) const override {
    if (hooks_.camera) return hooks_.camera({Sound(), context}, hit);
    return Sound().EvaluateEmissionForCamera(context, hit);
  }
  Color GetPowerEstimate(const LightContext& context) const override {
    return hooks_.power ? hooks_.power({Sound(), context}) : Sound().GetPowerEstimate(context);
  }

 private:
  LightHooks hooks_;
};

// Calls of a light that cost a random decision or answer one: what detection is counted in.
inline std::atomic<uint64_t>& LightQueries() {
  static std::atomic<uint64_t> queries{0};
  return queries;
}

// Makes a wrong light from a sound one.
using Planting = std::function<std::unique_ptr<Light>(std::shared_ptr<const Light>)>;

// The light that is tested: with its fault, before and after it is edited, and counted.
class CountedLight final : public ForwardingLight {
 public:
  // `planting` may be empty. `edited`, if there is one, makes the wrong light from the edited one and the one before.
  using EditedPlanting =
      std::function<std::unique_ptr<Light>(std::shared_ptr<const Light> edited, std::shared_ptr<const Light> before)>;
  // `reading`: what the light makes of changes before it heeds them; empty: nothing.
  using Reading = std::function<ParameterList(const ParameterList&)>;
  CountedLight(std::shared_ptr<const Light> sound, Planting planting, EditedPlanting edited, Reading reading)
      : ForwardingLight(planting ? std::shared_ptr<const Light>(planting(sound)) : sound),
        sound_(std::move(sound)),
        planting_(std::move(planting)),
        edited_(std::move(edited)),
        reading_(std::move(reading)) {}

  bool CanBeAimed() const override { return sound_->CanBeAimed(); }
  std::optional<LightSample> GenerateSamples(const LightContext& context, const Point3& P) const override {
    LightQueries().fetch_add(1, std::memory_order_relaxed);
    return Sound().GenerateSamples(context, P);
  }
  std::optional<LightEvaluation> EvaluateSamples(const LightContext& context, const LightHit& hit,
                                                 const Point3& P) const override {
    LightQueries().fetch_add(1, std::memory_order_relaxed);
    return Sound().EvaluateSamples(context, hit, P);
  }
  std::optional<EmissionSample> GenerateEmission(const LightContext& context) const override {
    LightQueries().fetch_add(1, std::memory_order_relaxed);
    return Sound().GenerateEmission(context);
  }
  std::unique_ptr<Light> Edit(const ParameterList& changes, const LightBuildContext& build) const override {
    std::shared_ptr<const Light> changed = sound_->Edit(reading_ ? reading_(changes) : changes, build);
    if (edited_) changed = edited_(changed, sound_);
    return std::make_unique<CountedLight>(std::move(changed), planting_, edited_, reading_);
  }

 private:
  std::shared_ptr<const Light> sound_;
  Planting planting_;
  EditedPlanting edited_;
  Reading reading_;
};

}  // namespace lampyr::test
