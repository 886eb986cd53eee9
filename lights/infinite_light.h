// Light from all around: radiance over directions, the same for every receiver. Photons, estimates and transforms are
// here, once; what differs is the sky. A template, so that the sky is inlined.
//
// A Sky has (directions are unit, in the light's local space, towards the light):
//   Color Radiance(local)
//   Vector3 Sample(u)               a direction
//   PdfSolidAngle Density(local)    its density: never 0 where Radiance is not
//   Color Mean()                    of the radiance over the sphere
#pragma once

#include "lights/direction_map.h"
#include "lights/infinite_frame.h"
#include "lights/light_base.h"

namespace lampyr {

template <class Sky>
class InfiniteLightWith final : public LightBase {
 public:
  InfiniteLightWith(LightTypeFunction type, const ParameterList& parameters, Sky sky)
      : LightBase(type, parameters), sky_(std::move(sky)), isBlack_(sky_.Mean().IsBlack()) {}

  LightKind Kind() const override { return LightKind::Infinite; }

  // A surface that faces a hemisphere of mean radiance.
  float GetIncidentRadianceEstimate(const LightContext&, const Point3&) const override {
    return sky_.Mean().Average() * kPi;
  }
  std::optional<SegmentEstimate> GetIncidentRadianceEstimate(const LightContext& context, const Point3& origin,
                                                             const Vector3&, float length) const override {
    if (isBlack_) return std::nullopt;
    return SegmentEstimate{GetIncidentRadianceEstimate(context, origin), 0, length};
  }
  // Through the scene's bounding sphere. The mean is over local directions: exact under rotations and uniform scales.
  Color GetPowerEstimate(const LightContext& context) const override {
    return sky_.Mean() * (4 * kPi * EmissionDiskArea(context.scene));
  }
  std::optional<EmissionBounds> GetEmissionBounds(const LightContext&) const override { return std::nullopt; }

  std::optional<LightSample> GenerateSamples(const LightContext& context, const Point3&) const override {
    if (isBlack_) return std::nullopt;
    std::optional<LightSample> sample(std::in_place);
    sample->direction = ToRenderDirection(*context.transform, sky_.Sample(context.u));
    // What is reported belongs to the direction as rounded: the same as when another technique finds it.
    const Vector3 local = ToLocalDirection(*context.transform, sample->direction);
    sample->pdfDirect = Density(context, sample->direction, local);
    sample->diffuse = sample->specular = sky_.Radiance(local);
    if (sample->pdfDirect.IsZero() || sample->diffuse.IsBlack()) return std::nullopt;
    sample->normal = -sample->direction;
    if (context.bidirectional) {
      sample->pdfEmit = EmissionDiskDensity(context.scene);
      sample->pdfEmitDirection = sample->pdfDirect;
      sample->solidAngleToArea = 1;
    }
    return sample;
  }

  std::optional<LightEvaluation> EvaluateSamples(const LightContext& context, const LightHit& hit,
                                                 const Point3&) const override {
    const Vector3 local = ToLocalDirection(*context.transform, hit.direction);
    std::optional<LightEvaluation> evaluation(std::in_place);
    evaluation->normal = -hit.direction;
    evaluation->diffuse = evaluation->specular = sky_.Radiance(local);
    evaluation->pdfDirect = Density(context, hit.direction, local);
    if (context.bidirectional) {
      evaluation->pdfEmit = EmissionDiskDensity(context.scene);
      evaluation->pdfEmitDirection = evaluation->pdfDirect;
      evaluation->solidAngleToArea = 1;
    }
    return evaluation;
  }

  std::optional<EmissionSample> GenerateEmission(const LightContext& context) const override {
    if (isBlack_) return std::nullopt;
    const Vector3 toLight = ToRenderDirection(*context.transform, sky_.Sample(context.u));
    const Vector3 local = ToLocalDirection(*context.transform, toLight);
    EmissionSample sample = EmitFromInfinity(context.scene, toLight, context.uDirection);
    sample.pdfEmitDirection = Density(context, toLight, local);
    sample.diffuse = sample.specular = sky_.Radiance(local);
    if (sample.pdfEmitDirection.IsZero() || sample.diffuse.IsBlack()) return std::nullopt;
    return sample;
  }

  Color EvaluateEmissionForCamera(const LightContext& context, const LightHit& hit) const override {
    return Settings().cameraVisible ? sky_.Radiance(ToLocalDirection(*context.transform, hit.direction)) : Color(0.0f);
  }

 private:
  // 1/sr in render space: the one place where it is written. `local` is the same direction in the light's space.
  PdfSolidAngle Density(const LightContext& context, const Vector3& direction, const Vector3& local) const {
    if (isBlack_) return PdfSolidAngle(0);
    const PdfSolidAngle density = sky_.Density(local) * LocalSolidAngleFactor(*context.transform, direction);
    return density.value < kInfinity ? density : PdfSolidAngle(0);
  }

  Sky sky_;
  bool isBlack_;
};

// The sky of an image file; `scale` multiplies it. Defined in dome_image.cpp.
std::unique_ptr<Light> MakeImageInfiniteLight(LightTypeFunction type, const ParameterList& parameters,
                                              const LightBuildContext& build);

}  // namespace lampyr
