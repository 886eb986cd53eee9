// A sound light with one fault.
#pragma once

#include "forwarding_light.h"
#include "suite/checks.h"

namespace lampyr::test {

enum class Fault {
  None,
  PdfOffByOnePercent,     // pdfDirect, everywhere
  CosineForgotten,        // in pdfDirect from a density per area, everywhere
  SolidAngleToAreaWrong,  // lacks the light's cosine; where it is 1 anyway, it is 2
  LeaksBehind,            // EvaluateSamples does not look at the side, of a portal neither
  ZeroWhereItEmits,       // one half is never sampled, and says so
  OtherRadiance,          // EvaluateSamples' differs by a hundredth
  SpecularForgotten,      // everywhere: that multiplier is taken for the diffuse one
  SpecularForgottenInPhotons,
  CameraSeesMore,           // than receivers; of a delta, anything
  PdfOfTheOrigin,           // pdfDirect is that of another receiver, at the light's own origin
  SeenFromTheOrigin,        // so is all that samples and evaluations report
  FrameNotTurned,           // samples lie where they would if the light's transform did not turn it
  PhotonFrameNotTurned,     // so do photons
  DiskNotRotated,           // photons from infinity start on a disk that does not face their direction
  EmissionNotCosine,        // pdfEmitDirection is uniform over the hemisphere
  EmitDensityOff,           // pdfEmit, everywhere
  DirectionDensityOff,      // pdfEmitDirection, everywhere
  PhotonsNotWhereTheyEmit,  // one half sends no photons, and says so
  DarkPhotonsAreNone,
  PlaceDependsOnDirection,
  PatchChoiceForgotten,  // of several patches each is said to be chosen always
  PowerOffByTwo,         // GetPowerEstimate
  BoxTooSmall,           // of the emission bounds
  ConeTooNarrow,         // of the emission bounds
  EstimateIsZero,
  SegmentIsMissed,
  SegmentEndsEarly,
  SegmentCutTooShort,         // by three hundredths, where the light does not reach all of it
  SegmentWithoutEndIsMissed,  // an infinite length is taken for none
  NegativeInPlaces,           // radiance, from one direction in a hundred
  NoNumberInPlaces,           // pdfDirect, from as many
};

class WrongLight final : public ForwardingLight {
 public:
  WrongLight(std::shared_ptr<const Light> light, Fault fault) : ForwardingLight(std::move(light)), fault_(fault) {}

  float GetIncidentRadianceEstimate(const LightContext& context, const Point3& P) const override {
    return Is(Fault::EstimateIsZero) ? 0.0f : Sound().GetIncidentRadianceEstimate(context, P);
  }
  std::optional<SegmentEstimate> GetIncidentRadianceEstimate(const LightContext& context, const Point3& origin,
                                                             const Vector3& direction, float length) const override {
    auto segment = Sound().GetIncidentRadianceEstimate(context, origin, direction, length);
    if (Is(Fault::SegmentIsMissed)) return std::nullopt;
    if (segment && Is(Fault::SegmentEndsEarly)) segment->maxT = glm::mix(segment->minT, segment->maxT, 0.3f);
    if (segment && Is(Fault::SegmentCutTooShort)) {
      segment->minT *= 1.03f;
      if (segment->maxT < length) segment->maxT *= 0.97f;
    }
    if (Is(Fault::SegmentWithoutEndIsMissed) && std::isinf(length)) return std::nullopt;
    return segment;
  }
  PdfDiscrete PatchProbability(int patch) const override {
    return Is(Fault::PatchChoiceForgotten) ? PdfDiscrete(1) : Sound().PatchProbability(patch);
  }
  Color GetPowerEstimate(const LightContext& context) const override {
    return Sound().GetPowerEstimate(context) * (Is(Fault::PowerOffByTwo) ? 2.0f : 1.0f);
  }
  std::optional<EmissionBounds> GetEmissionBounds(const LightContext& context) const override;
  std::optional<LightSample> GenerateSamples(const LightContext& context, const Point3& P) const override;
  std::optional<LightEvaluation> EvaluateSamples(const LightContext& context, const LightHit& given,
                                                 const Point3& P) const override;
  std::optional<EmissionSample> GenerateEmission(const LightContext& context) const override;
  Color EvaluateEmissionForCamera(const LightContext& context, const LightHit& hit) const override {
    const Color seen = Sound().EvaluateEmissionForCamera(context, hit);
    if (!Is(Fault::CameraSeesMore)) return seen;
    return IsDelta() ? Color(1.0f) : seen * 1.01f;
  }

 private:
  bool Is(Fault fault) const { return fault_ == fault; }
  bool IsDelta() const { return Kind() == LightKind::DeltaPosition || Kind() == LightKind::DeltaDirection; }

  // A half of the surface, or of the directions of a light without one.
  bool IsNeglected(const LightContext& context, const Point3& position, const Vector3& toLight) const {
    const bool hasSurface = Kind() == LightKind::Area;
    return (hasSurface ? position.x - context.transform->toRender.translation.x : toLight.x) < 0;
  }
  Point3 Receiver(const LightContext& context, const Point3& P) const {
    return Is(Fault::SeenFromTheOrigin) ? Origin(context) : P;
  }
  // Before a portal, which shines along -z.
  static Point3 Origin(const LightContext& context) { return context.transform->toRender.Point({0, 0, -1}); }
  static LightTransform NotTurned(const LightContext& context) {
    Affine toRender, toLocal;
    toRender.translation = context.transform->toRender.translation;
    toLocal.translation = -toRender.translation;
    return {toRender, toLocal};
  }

  // The values that samples and evaluations have in common.
  template <class Result>
  void Spoil(const LightContext& context, float cosine, const Vector3& toLight, Result& result) const;
  template <class Result>
  void SpoilEmission(const LightContext& context, const Point3& position, const Vector3& toLight, Result& result) const;

  Fault fault_;
};

template <class Result>
void WrongLight::Spoil(const LightContext& context, float cosine, const Vector3& toLight, Result& result) const {
  if (Is(Fault::PdfOffByOnePercent)) result.pdfDirect = result.pdfDirect * 1.01f;
  if (Is(Fault::CosineForgotten)) result.pdfDirect = result.pdfDirect * std::abs(cosine);
  if (Is(Fault::SolidAngleToAreaWrong)) {
    if (Kind() == LightKind::Area) {
      result.solidAngleToArea /= std::abs(cosine);
    } else {
      result.solidAngleToArea = 2;
    }
  }
  if (Is(Fault::PdfOfTheOrigin)) {
    LightHit hit;
    hit.direction = toLight;
    hit.position = Origin(context);
    const auto e = Sound().EvaluateSamples(context, hit, hit.position);
    result.pdfDirect = e ? e->pdfDirect : PdfSolidAngle(0);
  }
  if (Is(Fault::SpecularForgotten)) result.specular = result.diffuse;
  const bool isOneOfHundred = std::fmod(std::abs(toLight.x) * 64, 1.0f) < 0.01f;
  if (Is(Fault::NegativeInPlaces) && isOneOfHundred) result.diffuse *= -1.0f;
  if (Is(Fault::NoNumberInPlaces) && isOneOfHundred) result.pdfDirect = PdfSolidAngle(std::nanf(""));
}

template <class Result>
void WrongLight::SpoilEmission(const LightContext& context, const Point3& position, const Vector3& toLight,
                               Result& result) const {
  if (Is(Fault::EmitDensityOff)) result.pdfEmit = result.pdfEmit * 1.05f;
  if (Is(Fault::DirectionDensityOff)) result.pdfEmitDirection = result.pdfEmitDirection * 1.01f;
  if (Is(Fault::EmissionNotCosine)) result.pdfEmitDirection = PdfSolidAngle(0.5f * kInvPi);
  if (Is(Fault::PhotonsNotWhereTheyEmit) && IsNeglected(context, position, toLight)) {
    if (!IsDelta()) result.pdfEmit = PdfArea(0);
    result.pdfEmitDirection = PdfSolidAngle(0);
  }
}

inline std::optional<EmissionBounds> WrongLight::GetEmissionBounds(const LightContext& context) const {
  auto bounds = Sound().GetEmissionBounds(context);
  if (!bounds) return bounds;
  if (Is(Fault::BoxTooSmall)) {
    // A point has no box that could be too small, but one in the wrong place.
    const bool isPoint = bounds->box.min == bounds->box.max;
    bounds->box.max = isPoint ? bounds->box.max + Vector3(1.0f) : bounds->box.Center();
  }
  if (Is(Fault::ConeTooNarrow)) bounds->cosThetaE = 0.5f + 0.5f * bounds->cosThetaE;
  return bounds;
}

inline std::optional<LightSample> WrongLight::GenerateSamples(const LightContext& context, const Point3& P) const {
  const LightTransform notTurned = NotTurned(context);
  LightContext used = context;
  if (Is(Fault::FrameNotTurned)) used.transform = &notTurned;
  auto sample = Sound().GenerateSamples(used, Receiver(context, P));
  if (!sample) return sample;
  if (Is(Fault::ZeroWhereItEmits) && IsNeglected(context, sample->position, sample->direction)) return std::nullopt;
  Spoil(context, glm::dot(sample->normal, sample->direction), sample->direction, *sample);
  SpoilEmission(context, sample->position, sample->direction, *sample);
  return sample;
}

inline std::optional<LightEvaluation> WrongLight::EvaluateSamples(const LightContext& context, const LightHit& given,
                                                                  const Point3& P) const {
  LightHit hit = given;
  if (Is(Fault::LeaksBehind) && glm::dot(hit.normal, hit.direction) > 0) hit.normal = -hit.normal;
  auto evaluation = Sound().EvaluateSamples(context, hit, Receiver(context, P));
  if (Is(Fault::LeaksBehind) && Kind() == LightKind::Infinite && suite::IsBlack(*evaluation)) {
    // The same edge from the other side, beyond the portal.
    hit.position += 2 * context.scene.radius * hit.direction;
    hit.direction = -hit.direction;
    evaluation = Sound().EvaluateSamples(context, hit, hit.position);
  }
  if (!evaluation) return evaluation;
  Spoil(context, glm::dot(hit.normal, hit.direction), hit.direction, *evaluation);
  SpoilEmission(context, hit.position, hit.direction, *evaluation);
  if (Is(Fault::ZeroWhereItEmits) && IsNeglected(context, hit.position, hit.direction)) {
    evaluation->pdfDirect = PdfSolidAngle(0);
  }
  if (Is(Fault::OtherRadiance)) evaluation->diffuse *= 1.01f;
  return evaluation;
}

inline std::optional<EmissionSample> WrongLight::GenerateEmission(const LightContext& context) const {
  const LightTransform notTurned = NotTurned(context);
  LightContext used = context;
  if (Is(Fault::PhotonFrameNotTurned)) used.transform = &notTurned;
  // Any pair is as likely as before.
  if (Is(Fault::PlaceDependsOnDirection)) used.u.x = std::fmod(context.u.x + context.uDirection.x, 1.0f);
  auto photon = Sound().GenerateEmission(used);
  if (!photon) return photon;
  if (Is(Fault::DarkPhotonsAreNone) && photon->emissionCosine < 0.3f) return std::nullopt;
  if (Is(Fault::PhotonsNotWhereTheyEmit) && IsNeglected(context, photon->position, -photon->direction)) {
    return std::nullopt;
  }
  SpoilEmission(context, photon->position, -photon->direction, *photon);
  if (Is(Fault::SpecularForgotten) || Is(Fault::SpecularForgottenInPhotons)) photon->specular = photon->diffuse;
  if (Is(Fault::DiskNotRotated)) {
    const float angle = 2 * kPi * context.uDirection.x, r = std::sqrt(context.uDirection.y) * context.scene.radius;
    photon->position = context.scene.center + Vector3(r * std::cos(angle), r * std::sin(angle), 0) -
                       context.scene.radius * photon->direction;
  }
  return photon;
}

}  // namespace lampyr::test
