// Lights that are a point with an intensity over directions: position, falloff with distance and the discrete densities
// are here, once; what differs is the profile, the relative intensity over directions and the sampling of it. A
// template, so that the profile is inlined.
//
// A Profile has (directions are unit and in render space, `transform` is the light's placement):
//   float or Color Shape(transform, direction)  factor of the intensity
//   float Largest()                             no channel's mean over directions can exceed it: a bound of Shape
//   Vector3 Sample(transform, u)                a direction of emission
//   PdfSolidAngle Density(transform, direction) its density: never 0 where Shape is not
//   double or Color SolidAngle(transform)       ∫ Shape dω, to float precision where the transform keeps angles;
//                                               an error of it elsewhere is one of `power`
//   void SetCones(transform, bounds)            axis and angles of the emission bounds
//   bool Clip(transform, from, origin, direction, minT, maxT)
//                                               cuts a ray's [minT, maxT] to what is reached; false when that is
//                                               nothing
#pragma once

#include <algorithm>
#include <cmath>

#include "lights/estimates.h"
#include "lights/light_base.h"

namespace lampyr {

// Intensity and position of a point light, without its profile.
struct PointSource {
  Color intensity{1.0f};  // W/sr where the profile is 1
  Point3 from{0.0f};      // local space

  // Reads I and from.
  static PointSource Read(const ParameterList& parameters) {
    constexpr double farthest = 1e18;
    const Point3d from = parameters.GetPoint3("from", Point3d(0.0));
    if (!(std::max({std::abs(from.x), std::abs(from.y), std::abs(from.z)}) <= farthest))
      throw Error(parameters.WhereOf("from"), parameters.Owner() + ": \"from\" is farther out than 1e18");
    return {ReadEmissionColor(parameters, "I"), Point3(from)};
  }
};

template <class Profile>
class PointLightWith final : public LightBase {
 public:
  // Reads scale and power. `power` compensates for the magnitude of the profile as it is placed by `build`; that of the
  // colour is kept.
  PointLightWith(LightTypeFunction type, const ParameterList& parameters, const LightBuildContext& build,
                 Profile profile, const PointSource& source)
      : LightBase(type, parameters),
        profile_(std::move(profile)),
        from_(source.from),
        tint_(ReadLightTint(parameters)) {
    double scale = parameters.GetFloat("scale", 1);
    const double power = parameters.GetFloat("power", -1);
    if (power > 0) {
      const double solidAngle = Luminance(profile_.SolidAngle(build.transform));
      scale = solidAngle > 0 ? scale * power / solidAngle : 0.0;
    }
    intensity_ = source.intensity * static_cast<float>(scale) * tint_.color;
    if (!intensity_.IsValid()) throw Error(parameters.Where(), parameters.Owner() + ": the intensity is not finite");
  }
  // Reads I and from as well.
  PointLightWith(LightTypeFunction type, const ParameterList& parameters, const LightBuildContext& build,
                 Profile profile)
      : PointLightWith(type, parameters, build, std::move(profile), PointSource::Read(parameters)) {}

  LightKind Kind() const override { return LightKind::DeltaPosition; }

  float GetIncidentRadianceEstimate(const LightContext& context, const Point3& P) const override {
    const Vector3 way = P - Position(context);
    const float squared = std::max(LengthSquared(way), kSmallest);
    const Color intensity = intensity_ * profile_.Shape(*context.transform, way / std::sqrt(squared));
    if (intensity.IsBlack()) return 0;
    return std::clamp(intensity.Average() / squared, kSmallest, kLargest);
  }

  std::optional<SegmentEstimate> GetIncidentRadianceEstimate(const LightContext& context, const Point3& origin,
                                                             const Vector3& direction, float length) const override {
    SegmentEstimate estimate{0, 0, length};
    if (intensity_.IsBlack() ||
        !profile_.Clip(*context.transform, from_, origin, direction, estimate.minT, estimate.maxT)) {
      return std::nullopt;
    }
    // The intensity towards the nearest point of the segment may be 0 although it is positive elsewhere, so the largest
    // intensity is used.
    const Point3 position = Position(context);
    const float t = NearestOnSegment(origin, direction, estimate.minT, estimate.maxT, position);
    const float squared = std::max(LengthSquared(origin + t * direction - position), kSmallest);
    estimate.radiance = std::clamp(intensity_.Average() * profile_.Largest() / squared, kSmallest, kLargest);
    return estimate;
  }

  Color GetPowerEstimate(const LightContext& context) const override {
    return intensity_ * ToFactor(profile_.SolidAngle(*context.transform));
  }

  std::optional<EmissionBounds> GetEmissionBounds(const LightContext& context) const override {
    EmissionBounds bounds;
    bounds.box.Add(Position(context));
    bounds.energy = GetPowerEstimate(context).Average() * Settings().importanceMultiplier;
    profile_.SetCones(*context.transform, bounds);
    return bounds;
  }

  std::optional<LightSample> GenerateSamples(const LightContext& context, const Point3& P) const override {
    const Point3 position = Position(context);
    const Vector3 toLight = position - P;
    const float squared = LengthSquared(toLight);
    if (!(squared > 0)) return std::nullopt;
    std::optional<LightSample> sample(std::in_place);
    sample->distance = std::sqrt(squared);
    sample->direction = toLight / sample->distance;
    const Color radiance = intensity_ * (profile_.Shape(*context.transform, -sample->direction) / squared);
    // An infinite sample is returned, so that it is dropped and counted: its contribution is not 0.
    if (!tint_.Split(radiance, *sample)) return std::nullopt;
    sample->position = position;
    sample->positionError = PositionError(context);
    sample->pdfDirect = PdfSolidAngle(1);
    if (context.bidirectional) {
      sample->pdfEmit = PdfArea(1);
      sample->pdfEmitDirection = profile_.Density(*context.transform, -sample->direction);
      sample->solidAngleToArea = 1;
    }
    return sample;
  }

  std::optional<LightEvaluation> EvaluateSamples(const LightContext&, const LightHit&, const Point3&) const override {
    return std::nullopt;
  }

  std::optional<EmissionSample> GenerateEmission(const LightContext& context) const override {
    EmissionSample sample;
    sample.direction = profile_.Sample(*context.transform, context.u);
    sample.pdfEmitDirection = profile_.Density(*context.transform, sample.direction);
    const Color intensity = intensity_ * profile_.Shape(*context.transform, sample.direction);
    if (sample.pdfEmitDirection.IsZero() || !tint_.Split(intensity, sample)) return std::nullopt;
    sample.position = Position(context);
    sample.positionError = PositionError(context);
    sample.normal = sample.direction;
    sample.pdfEmit = PdfArea(1);
    return sample;
  }

  Color EvaluateEmissionForCamera(const LightContext&, const LightHit&) const override { return Color(0.0f); }

 private:
  static constexpr float kSmallest = std::numeric_limits<float>::min();
  static constexpr float kLargest = std::numeric_limits<float>::max();

  Point3 Position(const LightContext& context) const { return context.transform->toRender.Point(from_); }
  Vector3 PositionError(const LightContext& context) const {
    return context.transform->toRender.PointError(from_, Vector3(0.0f));
  }

  static double Luminance(double value) { return value; }
  static double Luminance(const Color& value) { return static_cast<double>(value.Luminance()); }
  static float ToFactor(double value) { return static_cast<float>(value); }
  static const Color& ToFactor(const Color& value) { return value; }

  [[no_unique_address]] Profile profile_;  // an empty profile takes no space
  Color intensity_;                        // W/sr where the profile's shape is 1, with the tint's colour
  Point3 from_;                            // local space
  LightTint tint_;
};

}  // namespace lampyr
