// A light of which one part is that of another: what a table that was not made anew, or an angle that was converted
// twice, comes to.
#pragma once

#include "forwarding_light.h"
#include "suite/checks.h"

namespace lampyr::test {

enum class Part {
  Draws,        // where GenerateSamples looks; what it says of that is right
  PhotonDraws,  // where GenerateEmission looks
  PhotonColor,  // what photons carry
  DirectPdf,    // pdfDirect, everywhere
  PhotonPdf,    // pdfEmitDirection, everywhere
  Samples,      // all of GenerateSamples
  Evaluations,  // all of EvaluateSamples
  Photons,      // all of GenerateEmission
  Power,
  Bounds,
  Estimate,
  Segment,
  Camera,
  Settings,
  Surface,
  Everything,
};

class MixedLight final : public ForwardingLight {
 public:
  MixedLight(std::shared_ptr<const Light> light, std::shared_ptr<const Light> other, Part part)
      : ForwardingLight(std::move(light)), other_(std::move(other)), part_(part) {}

  const LightSettings& Settings() const override { return Of(Part::Settings).Settings(); }
  const IntersectableLight* Surface() const override { return Of(Part::Surface).Surface(); }
  float GetIncidentRadianceEstimate(const LightContext& context, const Point3& P) const override {
    return Of(Part::Estimate).GetIncidentRadianceEstimate(context, P);
  }
  std::optional<SegmentEstimate> GetIncidentRadianceEstimate(const LightContext& context, const Point3& origin,
                                                             const Vector3& direction, float length) const override {
    return Of(Part::Segment).GetIncidentRadianceEstimate(context, origin, direction, length);
  }
  Color GetPowerEstimate(const LightContext& context) const override {
    return Of(Part::Power).GetPowerEstimate(context);
  }
  std::optional<EmissionBounds> GetEmissionBounds(const LightContext& context) const override {
    return Of(Part::Bounds).GetEmissionBounds(context);
  }
  std::optional<LightSample> GenerateSamples(const LightContext& context, const Point3& P) const override;
  std::optional<LightEvaluation> EvaluateSamples(const LightContext& context, const LightHit& hit,
                                                 const Point3& P) const override;
  std::optional<EmissionSample> GenerateEmission(const LightContext& context) const override;
  Color EvaluateEmissionForCamera(const LightContext& context, const LightHit& hit) const override {
    return Of(Part::Camera).EvaluateEmissionForCamera(context, hit);
  }

 private:
  bool Is(Part part) const { return part_ == part; }
  const Light& Of(Part part) const { return Is(part) || Is(Part::Everything) ? *other_ : Sound(); }

  // Result of `light` for the direction of emission: from the intensity of points, from hits of other lights.
  template <class Result>
  static bool Ask(const Light& light, const LightContext& context, const LightHit& hit, const Point3& P,
                  Result& result);

  std::shared_ptr<const Light> other_;
  Part part_;
};

template <class Result>
bool MixedLight::Ask(const Light& light, const LightContext& context, const LightHit& hit, const Point3& P,
                     Result& result) {
  if (light.Kind() == LightKind::DeltaPosition) {
    const auto seen = light.GenerateSamples(context, hit.position - hit.direction);
    if (!seen) return false;
    result.diffuse = seen->diffuse;
    result.specular = seen->specular;
    result.pdfEmitDirection = seen->pdfEmitDirection;
    return true;
  }
  const auto seen = light.EvaluateSamples(context, hit, P);
  if (!seen) return false;
  result.diffuse = seen->diffuse;
  result.specular = seen->specular;
  result.pdfEmit = seen->pdfEmit;
  result.pdfEmitDirection = seen->pdfEmitDirection;
  if constexpr (requires { result.pdfDirect; }) result.pdfDirect = seen->pdfDirect;
  return !suite::IsBlack(*seen);
}

inline std::optional<LightSample> MixedLight::GenerateSamples(const LightContext& context, const Point3& P) const {
  auto sample = (Is(Part::Draws) ? *other_ : Of(Part::Samples)).GenerateSamples(context, P);
  if (!sample) return sample;
  const LightHit hit = suite::HitOf(*sample, P);
  if (Is(Part::Draws) && !Ask(Sound(), context, hit, P, *sample)) return std::nullopt;
  LightSample other = *sample;
  if (Is(Part::DirectPdf))
    sample->pdfDirect = Ask(*other_, context, hit, P, other) ? other.pdfDirect : PdfSolidAngle(0);
  if (Is(Part::PhotonPdf))
    sample->pdfEmitDirection = Ask(*other_, context, hit, P, other) ? other.pdfEmitDirection : PdfSolidAngle(0);
  return sample;
}

inline std::optional<LightEvaluation> MixedLight::EvaluateSamples(const LightContext& context, const LightHit& hit,
                                                                  const Point3& P) const {
  auto evaluation = Of(Part::Evaluations).EvaluateSamples(context, hit, P);
  if (!evaluation || !(Is(Part::DirectPdf) || Is(Part::PhotonPdf))) return evaluation;
  const auto other = other_->EvaluateSamples(context, hit, P);
  if (Is(Part::DirectPdf)) evaluation->pdfDirect = other ? other->pdfDirect : PdfSolidAngle(0);
  if (Is(Part::PhotonPdf)) evaluation->pdfEmitDirection = other ? other->pdfEmitDirection : PdfSolidAngle(0);
  return evaluation;
}

inline std::optional<EmissionSample> MixedLight::GenerateEmission(const LightContext& context) const {
  auto photon = (Is(Part::PhotonDraws) ? *other_ : Of(Part::Photons)).GenerateEmission(context);
  if (!photon) return photon;
  // Where it may land, and what is found from there.
  const bool isInfinite = Kind() == LightKind::Infinite;
  const float reach = (isInfinite ? 2.0f : 1.0f) * context.scene.radius;
  const Point3 P = photon->position + reach * photon->direction;
  LightHit hit = suite::HitOf(*photon, isInfinite ? kInfinity : reach);
  if (isInfinite) hit.position = P;
  if (Is(Part::PhotonDraws) && !Ask(Sound(), context, hit, P, *photon)) return std::nullopt;
  EmissionSample other = *photon;
  if (Is(Part::PhotonColor) || Is(Part::PhotonPdf)) {
    const bool emits = Ask(*other_, context, hit, P, other);
    if (Is(Part::PhotonPdf)) photon->pdfEmitDirection = emits ? other.pdfEmitDirection : PdfSolidAngle(0);
    if (Is(Part::PhotonColor)) {
      photon->diffuse = emits ? other.diffuse : Color(0.0f);
      photon->specular = emits ? other.specular : Color(0.0f);
    }
  }
  return photon;
}

}  // namespace lampyr::test
