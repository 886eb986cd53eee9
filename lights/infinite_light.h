// Base of infinite lights: radiance over directions, the same for every receiver. Photons, estimates and transforms are
// common; the sky differs by type. A template, so that the sky is inlined.
//
// A Sky has (directions are unit, in the light's local space, towards the light):
//   Color Radiance(local)
//   SkySample Sample(receiver, u)     a direction, with the result of Look if `isInside`
//   SkyPoint Look(receiver, local)    radiance and densities, which are positive wherever the radiance is, that for the
//                                     receiver only in front of it
//   Color Mean()                      of the radiance over the sphere
//   float Irradiance(receiver)        estimate, mean of the channels; without a normal: of a surface that faces it
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

  float GetIncidentRadianceEstimate(const LightContext& context, const Point3&) const override {
    return sky_.Irradiance(ReceiverOf(context));
  }
  std::optional<SegmentEstimate> GetIncidentRadianceEstimate(const LightContext&, const Point3&, const Vector3&,
                                                             float length) const override {
    if (isBlack_) return std::nullopt;
    return SegmentEstimate{sky_.Irradiance({}), 0, length};
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
    const SkyPoint seen = Sample(context, ReceiverOf(context), sample->direction);
    sample->pdfDirect = seen.densityDirect;
    sample->normal = -sample->direction;
    if (context.bidirectional) {
      sample->pdfEmit = EmissionDiskDensity(context.scene);
      sample->pdfEmitDirection = seen.density;
      sample->solidAngleToArea = 1;
    }
    if (sample->pdfDirect.IsZero() || !tint_.Split(seen.radiance, *sample)) sample.reset();
    return sample;
  }

  std::optional<LightEvaluation> EvaluateSamples(const LightContext& context, const LightHit& hit,
                                                 const Point3&) const override {
    const SkyPoint seen = Look(context, ReceiverOf(context), hit.direction);
    std::optional<LightEvaluation> evaluation(std::in_place);
    evaluation->normal = -hit.direction;
    tint_.Split(seen.radiance, *evaluation);
    evaluation->pdfDirect = seen.densityDirect;
    if (context.bidirectional) {
      evaluation->pdfEmit = EmissionDiskDensity(context.scene);
      evaluation->pdfEmitDirection = seen.density;
      evaluation->solidAngleToArea = 1;
    }
    return evaluation;
  }

  std::optional<EmissionSample> GenerateEmission(const LightContext& context) const override {
    if (isBlack_) return std::nullopt;
    Vector3 toLight;
    const SkyPoint seen = Sample(context, {}, toLight);
    EmissionSample sample = EmitFromInfinity(context.scene, toLight, context.uDirection);
    sample.pdfEmitDirection = seen.density;
    if (sample.pdfEmitDirection.IsZero() || !tint_.Split(seen.radiance, sample)) return std::nullopt;
    return sample;
  }

  Color EvaluateEmissionForCamera(const LightContext& context, const LightHit& hit) const override {
    return Settings().cameraVisible ? sky_.Radiance(ToLocalDirection(*context.transform, hit.direction)) : Color(0.0f);
  }

 private:
  // The receiver in local space. Its normal is left out under a transform that does not keep angles: cosines in local
  // space would not be those of render space.
  static SkyReceiver ReceiverOf(const LightContext& context) {
    if (!(LengthSquared(context.receiverNormal) > 0) || !IsSimilarity(context.transform->toRender.linear)) return {};
    return {ToLocalDirection(*context.transform, context.receiverNormal), context.receiverIsTransmissive};
  }

  // Evaluated for the render-space direction as rounded to float, so that every technique evaluates the same values.
  SkyPoint Sample(const LightContext& context, const SkyReceiver& receiver, Vector3& direction) const {
    const SkySample sample = sky_.Sample(receiver, context.u);
    direction = ToRenderDirection(*context.transform, sample.local);
    const bool isSame = sample.isInside && IsSimilarity(context.transform->toRender.linear);
    const bool isFinite = sample.seen.density.value < kInfinity && sample.seen.densityDirect.value < kInfinity;
    return isSame && isFinite ? sample.seen : Look(context, receiver, direction);
  }

  // Radiance, and the densities in 1/sr of render space.
  SkyPoint Look(const LightContext& context, const SkyReceiver& receiver, const Vector3& direction) const {
    if (isBlack_) return {Color(0.0f), PdfSolidAngle(0), PdfSolidAngle(0)};
    SkyPoint seen = sky_.Look(receiver, ToLocalDirection(*context.transform, direction));
    const float factor = LocalSolidAngleFactor(*context.transform, direction);
    for (PdfSolidAngle* density : {&seen.density, &seen.densityDirect}) {
      *density = *density * factor;
      if (!(density->value < kInfinity)) *density = PdfSolidAngle(0);
    }
    return seen;
  }

  Sky sky_;  // its radiance is that seen by the camera: with the colour of the tint, without its multipliers
  LightTint tint_;
  bool isBlack_;
};

}  // namespace lampyr
