// A sound light with one fault of the kind that hides: in what only some integrators ask for, where few samples go, or
// where all that is compared is wrong alike.
#pragma once

#include <atomic>
#include <chrono>
#include <cmath>
#include <numbers>
#include <thread>

#include "forwarding_light.h"
#include "suite/checks.h"

namespace lampyr::test {

enum class HiddenFault {
  None,
  // Where densities of emission are not wanted: half the radiance, a density that is a tenth too high.
  HalfWithoutBidirectional,
  PdfOffWithoutBidirectional,
  // A light that is its own surface claims two patches.
  TwoPatches,
  ShinesFromFarAway,
  NoPositionError,
  HugePositionError,
  NoEnergy,
  TinyEnergy,
  // The radiance depends on the time itself, with the same transform.
  RadianceOfTime,
  PdfOfTime,
  EmitPdfOfTime,
  PositionOfTime,
  CameraOfTime,
  EstimateOfTime,
  // pdfDirect, everywhere that it is reported.
  PdfOffAtGrazing,   // 3 % where the light's cosine is below 0.2
  PdfTwiceEdgeOn,    // where it is below 0.01
  PdfOffFarAway,     // 5 % beyond 150 sizes of the light
  PdfOffNear,        // 20 % within 0.05 sizes
  PdfOffOfDiscrete,  // of a delta, far away
  PdfWhereDark,      // 1 per sr where it is 0
  // pdfEmitDirection, everywhere that it is reported.
  FineRipple,  // 5 %, many waves
  Ripple,      // 5 %, few of them
  Tilt,        // 1 %
  UvwMirrored,
  UvwOfPhotonsConstant,
  // The second of two equal calls, and what it says after another call.
  SecondSampleDarker,
  EvaluationOfLastSample,
  PhotonsWearOut,    // after some hundred
  StateOfItsThread,  // right on the thread that asked first
  SharedNumbers,     // keeps the random numbers of a call in itself while it answers
  CosineOfPhotonsOne,
  RangeFromFarBefore,  // of a segment: from -∞ on
};

class HiddenFaultLight final : public ForwardingLight {
 public:
  // `middle` and `size` of what a receiver takes it for, render space.
  HiddenFaultLight(std::shared_ptr<const Light> light, HiddenFault fault, const Point3& middle, float size)
      : ForwardingLight(std::move(light)), fault_(fault), middle_(middle), size_(size) {}

  int PatchCount() const override { return Is(HiddenFault::TwoPatches) ? 2 : Sound().PatchCount(); }
  PdfDiscrete PatchProbability(int patch) const override {
    return Is(HiddenFault::TwoPatches) ? PdfDiscrete(0.5f) : Sound().PatchProbability(patch);
  }
  float GetIncidentRadianceEstimate(const LightContext& context, const Point3& P) const override {
    const float estimate = Sound().GetIncidentRadianceEstimate(context, P);
    return Is(HiddenFault::EstimateOfTime) && context.time > 0.5f ? 0.5f * estimate : estimate;
  }
  std::optional<SegmentEstimate> GetIncidentRadianceEstimate(const LightContext& context, const Point3& origin,
                                                             const Vector3& direction, float length) const override {
    auto estimate = Sound().GetIncidentRadianceEstimate(context, origin, direction, length);
    if (estimate && Is(HiddenFault::RangeFromFarBefore)) estimate->minT = -kInfinity;
    return estimate;
  }
  std::optional<EmissionBounds> GetEmissionBounds(const LightContext& context) const override {
    auto bounds = Sound().GetEmissionBounds(context);
    if (bounds && Is(HiddenFault::NoEnergy)) bounds->energy = 0;
    if (bounds && Is(HiddenFault::TinyEnergy)) bounds->energy = 1e-6f;
    return bounds;
  }
  std::optional<LightSample> GenerateSamples(const LightContext& context, const Point3& P) const override;
  std::optional<LightEvaluation> EvaluateSamples(const LightContext& context, const LightHit& hit,
                                                 const Point3& P) const override;
  std::optional<EmissionSample> GenerateEmission(const LightContext& context) const override;
  Color EvaluateEmissionForCamera(const LightContext& context, const LightHit& hit) const override {
    const Color seen = Sound().EvaluateEmissionForCamera(context, hit);
    return Is(HiddenFault::CameraOfTime) ? seen * (1 + context.time) : seen;
  }

 private:
  bool Is(HiddenFault fault) const { return fault_ == fault; }

  // Values that samples and evaluations report for one edge. `cosine`: at the light.
  template <class Result>
  void Spoil(const LightContext& context, const Vector3& toLight, float cosine, float distance, Result& result) const;
  // Density that all three methods report for a direction away from the light.
  PdfSolidAngle SpoiltDirection(PdfSolidAngle density, const Vector3& outward) const {
    if (Is(HiddenFault::FineRipple)) return density * (1 + 0.05f * std::sin(40 * outward.x) * std::cos(25 * outward.y));
    if (Is(HiddenFault::Ripple)) return density * (1 + 0.05f * std::sin(9 * outward.x) * std::cos(7 * outward.y));
    if (Is(HiddenFault::Tilt)) return density * (1 + 0.01f * outward.x);
    return density;
  }
  template <class Result>
  void SpoilPlace(Result& result) const {
    if (Is(HiddenFault::NoPositionError)) result.positionError = Vector3(0.0f);
    if (Is(HiddenFault::HugePositionError)) result.positionError = Vector3(1e3f);
    if (Is(HiddenFault::UvwMirrored)) result.uvw.x = 1 - result.uvw.x;
  }

  HiddenFault fault_;
  Point3 middle_;
  float size_;
  mutable std::atomic<int> photons_{0};
  mutable std::atomic<float> lastU_{-1}, lastPdf_{0}, sharedU_{0};
};

template <class Result>
void HiddenFaultLight::Spoil(const LightContext& context, const Vector3& toLight, float cosine, float distance,
                             Result& result) const {
  float factor = 1;
  if (Is(HiddenFault::PdfOffWithoutBidirectional) && !context.bidirectional) factor = 1.1f;
  if (Is(HiddenFault::PdfOfTime)) factor = 1 + 0.2f * context.time;
  if (Is(HiddenFault::PdfOffAtGrazing) && cosine < 0.2f) factor = 1.03f;
  if (Is(HiddenFault::PdfTwiceEdgeOn) && cosine < 0.01f) factor = 2;
  if (Is(HiddenFault::PdfOffFarAway) && distance > 150 * size_) factor = 1.05f;
  if (Is(HiddenFault::PdfOffNear) && distance < 0.05f * size_) factor = 1.2f;
  if (Is(HiddenFault::PdfOffOfDiscrete) && distance > 150 * size_) factor = 1.05f;
  result.pdfDirect = result.pdfDirect * factor;
  float light = 1;
  if (Is(HiddenFault::HalfWithoutBidirectional) && !context.bidirectional) light = 0.5f;
  if (Is(HiddenFault::RadianceOfTime)) light = 1 + 0.5f * context.time;
  result.diffuse *= light;
  result.specular *= light;
  if (Is(HiddenFault::EmitPdfOfTime)) result.pdfEmit = result.pdfEmit * (1 + context.time);
  result.pdfEmitDirection = SpoiltDirection(result.pdfEmitDirection, -toLight);
}

inline std::optional<LightSample> HiddenFaultLight::GenerateSamples(const LightContext& context,
                                                                    const Point3& P) const {
  LightContext used = context;
  if (Is(HiddenFault::PositionOfTime)) used.u.x = std::fmod(context.u.x + 0.37f * context.time, 1.0f);
  if (Is(HiddenFault::SharedNumbers)) {
    sharedU_ = context.u.x;
    std::this_thread::sleep_for(std::chrono::microseconds(20));  // threads meet on a busy machine, too
    used.u.x = sharedU_;
  }
  auto sample = Sound().GenerateSamples(used, P);
  if (!sample) return sample;
  Spoil(context, sample->direction, std::abs(glm::dot(sample->normal, sample->direction)), sample->distance, *sample);
  SpoilPlace(*sample);
  if (Is(HiddenFault::SecondSampleDarker) && lastU_.exchange(context.u.x) == context.u.x) sample->diffuse *= 0.5f;
  lastPdf_ = sample->pdfDirect.value;
  return sample;
}

inline std::optional<LightEvaluation> HiddenFaultLight::EvaluateSamples(const LightContext& context,
                                                                        const LightHit& hit, const Point3& P) const {
  auto evaluation = Sound().EvaluateSamples(context, hit, P);
  if (!evaluation) return evaluation;
  Spoil(context, hit.direction, std::abs(glm::dot(hit.normal, hit.direction)), hit.distance, *evaluation);
  if (Is(HiddenFault::PdfWhereDark) && evaluation->pdfDirect.IsZero()) evaluation->pdfDirect = PdfSolidAngle(1);
  // Right where the sample was made just before.
  if (Is(HiddenFault::EvaluationOfLastSample) && lastPdf_ > 0 && !evaluation->pdfDirect.IsZero())
    evaluation->pdfDirect = PdfSolidAngle(lastPdf_);
  static const thread_local bool isKnown = false;
  static const bool* const first = &isKnown;
  if (Is(HiddenFault::StateOfItsThread) && first != &isKnown) evaluation->pdfDirect = evaluation->pdfDirect * 1.5f;
  return evaluation;
}

inline std::optional<EmissionSample> HiddenFaultLight::GenerateEmission(const LightContext& context) const {
  auto photon = Sound().GenerateEmission(context);
  if (!photon) return photon;
  photon->pdfEmitDirection = SpoiltDirection(photon->pdfEmitDirection, photon->direction);
  SpoilPlace(*photon);
  if (Is(HiddenFault::ShinesFromFarAway)) photon->shinesFrom = 1e9f;
  if (Is(HiddenFault::CosineOfPhotonsOne)) photon->emissionCosine = Sound().Kind() == LightKind::Area ? 1.0f : 0.5f;
  if (Is(HiddenFault::UvwOfPhotonsConstant)) photon->uvw = Point3(0.25f, 0.5f, 0);
  if (Is(HiddenFault::RadianceOfTime)) {
    photon->diffuse *= 1 + 0.5f * context.time;
    photon->specular *= 1 + 0.5f * context.time;
  }
  if (Is(HiddenFault::EmitPdfOfTime)) photon->pdfEmit = photon->pdfEmit * (1 + context.time);
  if (Is(HiddenFault::PhotonsWearOut) && ++photons_ > 600) photon->diffuse *= 0.9f;
  return photon;
}

}  // namespace lampyr::test
