#include "materials/bsdf.h"

#include <algorithm>
#include <cmath>

namespace lampyr {

namespace {

// Reduces an error ε of the length to ε². The frame and the models preserve unit length only up to rounding, which
// would accumulate along a path.
Vector3 Renormalize(const Vector3& v) {
  return v * (1.5f - 0.5f * LengthSquared(v));
}

}  // namespace

float Bsdf::OwnCosine(const Vector3& w) const {
  if (IsMedium()) return 1;
  return IsFibre() ? std::get_if<HairBsdf>(&model_)->ScatteringCosine(frame_.ToLocal(w)) : AbsDot(w, frame_.z);
}

BsdfEvaluation Bsdf::EvaluateInFrame(const Vector3& wo, const Vector3& wi, TransportMode mode) const {
  if (const auto* phase = std::get_if<PhaseBsdf>(&model_)) return phase->Evaluate(wo, wi, mode);
  const Vector3 o = frame_.ToLocal(wo), i = frame_.ToLocal(wi);
  if (o.z == 0 || i.z == 0) return {};
  return std::visit([&](const auto& model) { return model.Evaluate(o, i, mode); }, model_);
}

BsdfSample Bsdf::SampleLocal(const Vector3& wo, float uLobe, const Point2& u, TransportMode mode) const {
  if (wo.z == 0) return {};
  if (const auto* diffuse = std::get_if<DiffuseBsdf>(&model_)) return diffuse->Sample(wo, uLobe, u, mode);
  return std::visit([&](const auto& model) { return model.Sample(wo, uLobe, u, mode); }, model_);
}

BsdfSample Bsdf::Sample(const Vector3& wo, float uLobe, const Point2& u, TransportMode mode) const {
  const auto* phase = std::get_if<PhaseBsdf>(&model_);
  BsdfSample sample = phase ? phase->Sample(wo, uLobe, u, mode) : SampleLocal(frame_.ToLocal(wo), uLobe, u, mode);
  if (sample) sample.wi = Renormalize(phase ? sample.wi : frame_.ToWorld(sample.wi));
  return sample;
}

bool Bsdf::IsDelta() const {
  return std::visit([](const auto& model) { return model.IsDelta(); }, model_);
}

bool Bsdf::IsWide() const {
  // A lobe is narrow below this α of microfacets, or beyond this |g| of a phase function.
  constexpr float kLeastAlpha = 0.25f, kMostMeanCosine = 0.8f;
  if (const auto* phase = std::get_if<PhaseBsdf>(&model_)) return std::abs(phase->g) < kMostMeanCosine;
  if (const auto* metal = std::get_if<ConductorBsdf>(&model_))
    return std::min(metal->microfacets.alphaX, metal->microfacets.alphaY) > kLeastAlpha;
  if (const auto* coated = std::get_if<CoatedDiffuseBsdf>(&model_)) return !coated->IsDelta();
  return std::holds_alternative<DiffuseBsdf>(model_) || std::holds_alternative<DiffuseTransmissionBsdf>(model_) ||
         std::holds_alternative<MeasuredBsdf>(model_);
}

bool Bsdf::IsTransmissive() const {
  return std::visit([](const auto& model) { return model.IsTransmissive(); }, model_);
}

}  // namespace lampyr
