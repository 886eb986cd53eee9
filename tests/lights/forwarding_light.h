// A light that is another one in all respects, for tests to change one of them.
#pragma once

#include <memory>

#include "lights/light.h"

namespace lampyr::test {

class ForwardingLight : public Light {
 public:
  explicit ForwardingLight(std::shared_ptr<const Light> light) : light_(std::move(light)) {}

  LightKind Kind() const override { return light_->Kind(); }
  const LightSettings& Settings() const override { return light_->Settings(); }
  int PatchCount() const override { return light_->PatchCount(); }
  PdfDiscrete PatchProbability(int patch) const override { return light_->PatchProbability(patch); }
  const IntersectableLight* Surface() const override { return light_->Surface(); }
  float GetIncidentRadianceEstimate(const LightContext& context, const Point3& P) const override {
    return light_->GetIncidentRadianceEstimate(context, P);
  }
  std::optional<SegmentEstimate> GetIncidentRadianceEstimate(const LightContext& context, const Point3& origin,
                                                             const Vector3& direction, float length) const override {
    return light_->GetIncidentRadianceEstimate(context, origin, direction, length);
  }
  Color GetPowerEstimate(const LightContext& context) const override { return light_->GetPowerEstimate(context); }
  std::optional<EmissionBounds> GetEmissionBounds(const LightContext& context) const override {
    return light_->GetEmissionBounds(context);
  }
  std::optional<LightSample> GenerateSamples(const LightContext& context, const Point3& P) const override {
    return light_->GenerateSamples(context, P);
  }
  std::optional<LightEvaluation> EvaluateSamples(const LightContext& context, const LightHit& hit,
                                                 const Point3& P) const override {
    return light_->EvaluateSamples(context, hit, P);
  }
  bool CanBeAimed() const override { return light_->CanBeAimed(); }
  std::optional<EmissionSample> GenerateEmission(const LightContext& context) const override {
    return light_->GenerateEmission(context);
  }
  Color EvaluateEmissionForCamera(const LightContext& context, const LightHit& hit) const override {
    return light_->EvaluateEmissionForCamera(context, hit);
  }
  std::unique_ptr<Light> Edit(const ParameterList& changes, const LightBuildContext& build) const override {
    return light_->Edit(changes, build);
  }

 protected:
  const Light& Sound() const { return *light_; }

 private:
  std::shared_ptr<const Light> light_;
};

}  // namespace lampyr::test
