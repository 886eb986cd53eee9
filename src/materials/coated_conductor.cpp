#include "materials/coated_conductor.h"

#include "materials/fresnel.h"

namespace lampyr {

namespace {

// Refracts a direction above the coat into it, at the mean surface; z = 0 if it does not enter (η < 1).
Vector3 IntoCoat(const Vector3& w, float eta) {
  return {w.x / eta, w.y / eta, RefractedCosine(w.z, eta)};
}

// 1 + F·second·(1 + F·later + (F·later)² + …).
Color SumBounces(const Color& F, float second, float later, int bounces) {
  const auto sum = [&](float f) { return 1 + f * second * TruncatedSeries(f * later, bounces - 1); };
  return {sum(F.r), sum(F.g), sum(F.b)};
}

}  // namespace

CoatedConductorBsdf::CoatedConductorBsdf(const TrowbridgeReitz& coat, const TrowbridgeReitz& base, const Color& eta,
                                         const Color& k, const CoatedConductorSettings& settings)
    : coat_(coat),
      base_(WidenedBase(base, coat, settings.eta)),
      eta_(eta),
      k_(k),
      coatSlice_(settings.coat->FindSlice(std::sqrt(coat.alphaX * coat.alphaY))),
      slice_(settings.metal->FindSlice(std::sqrt(coat.alphaX * coat.alphaY), std::sqrt(base.alphaX * base.alphaY))),
      settings_(&settings) {}

float CoatedConductorBsdf::CoatProbability(float cosO) const {
  const float coat = settings_->coat->Reflectance(cosO, coatSlice_);
  const float cosInside = RefractedCosine(cosO, settings_->eta);
  const float base = settings_->metal->Find(cosO, slice_).albedo * FresnelConductor(cosInside, eta_, k_).Average();
  return CoatLobeProbability(coat, base, CoatIsDelta());
}

CoatedConductorBsdf::Base CoatedConductorBsdf::EvaluateBase(const Vector3& wo, const Vector3& wi) const {
  const float eta = settings_->eta;
  const Vector3 o = IntoCoat(wo, eta), i = IntoCoat(wi, eta);
  if (!(o.z > 0) || !(i.z > 0)) return {};
  const HalfVector half = HalfVectorOf(o, i);
  if (!(half.cosine > 0)) return {};
  const float quarterD = 0.25f * base_.D(half.m) / (eta * eta);
  const float stretchO = base_.Stretch(o), stretchI = base_.Stretch(i);
  const Color F = FresnelConductor(half.cosine, eta_, k_);
  const auto ofO = settings_->metal->Find(wo.z, slice_), ofI = settings_->metal->Find(wi.z, slice_);
  const Color S = SumBounces(F, ofO.second * ofI.second, std::sqrt(ofO.later * ofI.later), settings_->bounces);
  const float scale = ofO.scale * ofI.scale;
  // dω'/dω = cosθ / (η² cosθ')
  return {F * S * (scale * quarterD * TrowbridgeReitz::ShadowingFactor(o.z, stretchO, i.z, stretchI)),
          quarterD * TrowbridgeReitz::VisibleFactor(o.z, stretchO) * wi.z / i.z,
          quarterD * TrowbridgeReitz::VisibleFactor(i.z, stretchI) * wo.z / o.z};
}

// Refraction into the coat, reflection at a microfacet of the base, refraction out; nullopt for total reflection.
std::optional<Vector3> CoatedConductorBsdf::SampleBase(const Vector3& wo, const Point2& u) const {
  const float eta = settings_->eta;
  const Vector3 o = IntoCoat(wo, eta);
  if (!(o.z > 0)) return std::nullopt;
  const auto i = SampleMicrofacetMirror(base_, o, u);
  if (!i) return std::nullopt;
  const Vector3 wi(i->x * eta, i->y * eta, RefractedCosine(std::min(i->z, 1.0f), 1 / eta));
  if (!(wi.z > 0)) return std::nullopt;
  return wi;
}

BsdfEvaluation CoatedConductorBsdf::EvaluateUpper(const Vector3& wo, const Vector3& wi) const {
  const float coatO = CoatProbability(wo.z), coatI = CoatProbability(wi.z);
  BsdfEvaluation result;
  if (!base_.IsSmooth()) {
    const Base base = EvaluateBase(wo, wi);
    result.specular = base.f;
    result.pdfForward = PdfSolidAngle((1 - coatO) * base.pdfForward);
    result.pdfReverse = PdfSolidAngle((1 - coatI) * base.pdfReverse);
  }
  if (!CoatIsDelta()) {
    const LobeValue coat = EvaluateCoatLobe(coat_, settings_->eta, wo, wi);
    result.specular += Color(coat.f);
    result.pdfForward.value += coatO * coat.pdfForward;
    result.pdfReverse.value += coatI * coat.pdfReverse;
  }
  return result;
}

BsdfEvaluation CoatedConductorBsdf::Evaluate(const Vector3& wo, const Vector3& wi, TransportMode) const {
  if (!(wo.z * wi.z > 0)) return {};
  return wo.z < 0 ? EvaluateUpper(-wo, -wi) : EvaluateUpper(wo, wi);
}

// The mirror direction as a delta: the reflection of the coat and, with a smooth base, all orders between the two.
void CoatedConductorBsdf::SampleMirror(const Vector3& wo, BsdfSample& sample) const {
  const float cosO = std::abs(wo.z), cosT = RefractedCosine(cosO, settings_->eta);
  const float R = FresnelDielectric(cosO, cosT, settings_->eta);
  sample.wi = {-wo.x, -wo.y, wo.z};
  sample.isDelta = true;
  sample.pdfForward = sample.pdfReverse = PdfSolidAngle(1);
  sample.weightSpecular = Color(R);
  if (base_.IsSmooth() && cosT > 0) {
    const Color base = FresnelConductor(cosT, eta_, k_) * std::exp(-2 * settings_->thickness / cosT);
    sample.weightSpecular += base * SumBounces(base, R, R, settings_->bounces) * Sqr(1 - R);
  }
}

BsdfSample CoatedConductorBsdf::Sample(const Vector3& wo, float uLobe, const Point2& u, TransportMode) const {
  BsdfSample sample;
  if (IsDelta()) {
    SampleMirror(wo, sample);
    return sample;
  }
  const Vector3 o = wo.z < 0 ? -wo : wo;
  const float coatO = CoatProbability(o.z);
  const bool takeCoat = uLobe < coatO;
  if (takeCoat && CoatIsDelta()) {
    SampleMirror(wo, sample);
    sample.weightSpecular = sample.weightSpecular / coatO;
    sample.pdfForward = sample.pdfReverse = PdfSolidAngle(coatO);
    return sample;
  }
  const auto wi = takeCoat ? SampleMicrofacetMirror(coat_, o, u) : SampleBase(o, u);
  if (!wi) return sample;
  const BsdfEvaluation value = EvaluateUpper(o, *wi);
  if (!(value.pdfForward.value > 0)) return sample;
  sample.wi = wo.z < 0 ? -*wi : *wi;
  sample.weightSpecular = value.specular * (wi->z / value.pdfForward.value);
  sample.pdfForward = value.pdfForward;
  sample.pdfReverse = value.pdfReverse;
  return sample;
}

}  // namespace lampyr
