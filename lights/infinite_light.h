// Base of infinite lights: radiance over directions, the same for every receiver. Photons, estimates and transforms are
// common; the sky differs by type. A template, so that the sky is inlined.
//
// A Sky has (directions are unit, in the light's local space, towards the light):
//   Color Radiance(local)
//   SkySample Sample(u)             a direction, with the result of Look if `isInside`
//   SkyPoint Look(local)            radiance and density; the density is positive wherever the radiance is
//   Color Mean()                    of the radiance over the sphere
//   float FacingIrradiance()        estimate for a surface that faces the light, mean of the channels
#pragma once

#include "lights/direction_map.h"
#include "lights/infinite_frame.h"
#include "lights/light_base.h"

namespace lampyr {

template <class Sky>
class InfiniteLightWith final : public LightBase {
 public:
  InfiniteLightWith(LightTypeFunction type, const ParameterList& parameters, Sky sky)
      : LightBase(type, parameters),
        sky_(std::move(sky)),
        tint_(ReadLightTint(parameters)),
        isBlack_(sky_.Mean().IsBlack()) {}

  LightKind Kind() const override { return LightKind::Infinite; }

  float GetIncidentRadianceEstimate(const LightContext&, const Point3&) const override {
    return sky_.FacingIrradiance();
  }
  std::optional<SegmentEstimate> GetIncidentRadianceEstimate(const LightContext& context, const Point3& origin,
                                                             const Vector3&, float length) const override {
    if (isBlack_) return std::nullopt;
    return SegmentEstimate{GetIncidentRadianceEstimate(context, origin), 0, length};
  }
  // Power through the scene's bounding sphere. The mean is over local directions: exact under rotations and uniform
  // scales.
  Color GetPowerEstimate(const LightContext& context) const override {
    return sky_.Mean() * (4 * kPi * EmissionDiskArea(context.scene));
  }
  std::optional<EmissionBounds> GetEmissionBounds(const LightContext&) const override { return std::nullopt; }

  // A single return variable, so that it is constructed in the caller's storage (NRVO).
  std::optional<LightSample> GenerateSamples(const LightContext& context, const Point3&) const override {
    std::optional<LightSample> sample;
    if (isBlack_) return sample;
    sample.emplace();
    const SkyPoint seen = Sample(context, sample->direction);
    sample->pdfDirect = seen.density;
    sample->normal = -sample->direction;
    if (context.bidirectional) {
      sample->pdfEmit = EmissionDiskDensity(context.scene);
      sample->pdfEmitDirection = sample->pdfDirect;
      sample->solidAngleToArea = 1;
    }
    if (sample->pdfDirect.IsZero() || !tint_.Split(seen.radiance, *sample)) sample.reset();
    return sample;
  }

  std::optional<LightEvaluation> EvaluateSamples(const LightContext& context, const LightHit& hit,
                                                 const Point3&) const override {
    const SkyPoint seen = Look(context, hit.direction);
    std::optional<LightEvaluation> evaluation(std::in_place);
    evaluation->normal = -hit.direction;
    tint_.Split(seen.radiance, *evaluation);
    evaluation->pdfDirect = seen.density;
    if (context.bidirectional) {
      evaluation->pdfEmit = EmissionDiskDensity(context.scene);
      evaluation->pdfEmitDirection = evaluation->pdfDirect;
      evaluation->solidAngleToArea = 1;
    }
    return evaluation;
  }

  std::optional<EmissionSample> GenerateEmission(const LightContext& context) const override {
    if (isBlack_) return std::nullopt;
    Vector3 toLight;
    const SkyPoint seen = Sample(context, toLight);
    EmissionSample sample = EmitFromInfinity(context.scene, toLight, context.uDirection);
    sample.pdfEmitDirection = seen.density;
    if (sample.pdfEmitDirection.IsZero() || !tint_.Split(seen.radiance, sample)) return std::nullopt;
    return sample;
  }

  Color EvaluateEmissionForCamera(const LightContext& context, const LightHit& hit) const override {
    return Settings().cameraVisible ? sky_.Radiance(ToLocalDirection(*context.transform, hit.direction)) : Color(0.0f);
  }

 private:
  // Evaluated for the render-space direction as rounded to float, so that every technique evaluates the same values.
  SkyPoint Sample(const LightContext& context, Vector3& direction) const {
    const SkySample sample = sky_.Sample(context.u);
    direction = ToRenderDirection(*context.transform, sample.local);
    const bool isSame = sample.isInside && IsSimilarity(context.transform->toRender.linear);
    return isSame && sample.seen.density.value < kInfinity ? sample.seen : Look(context, direction);
  }

  // Radiance, and the density in 1/sr of render space.
  SkyPoint Look(const LightContext& context, const Vector3& direction) const {
    if (isBlack_) return {Color(0.0f), PdfSolidAngle(0)};
    SkyPoint seen = sky_.Look(ToLocalDirection(*context.transform, direction));
    seen.density = seen.density * LocalSolidAngleFactor(*context.transform, direction);
    if (!(seen.density.value < kInfinity)) seen.density = PdfSolidAngle(0);
    return seen;
  }

  Sky sky_;  // its radiance is that seen by the camera: with the colour of the tint, without its multipliers
  LightTint tint_;
  bool isBlack_;
};

}  // namespace lampyr
