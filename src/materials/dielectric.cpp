// Throughout this file, directions are flipped so that wo is in the upper hemisphere, and η is relative to the side of
// wo. w -> -w leaves the distribution of microfacets unchanged, since it is symmetric.
#include "materials/dielectric.h"

#include "materials/fresnel.h"

namespace lampyr {

namespace {

// Refraction at a microfacet m, given by its cosines (both positive).
struct Refraction {
  float cosO, cosI;  // |dot(wo,m)|, |dot(wi,m)|
  float eta;

  // Symmetric except for η² ([Walter07 eq. 17]):
  //   |dω_m/dω_i|·|dot(wo,m)| = |dot(wo,m) dot(wi,m)| / (dot(wi,m) + dot(wo,m)/η)²
  float Jacobian() const { return cosO * cosI / Sqr(RefractionShift(cosO, cosI, eta)); }
};

BsdfEvaluation EvaluateReflection(const TrowbridgeReitz& microfacets, float eta, const Vector3& wo, const Vector3& wi) {
  const HalfVector half = HalfVectorOf(wo, wi);
  if (!(half.cosine > 0)) return {};
  const float FD = 0.25f * FresnelDielectric(half.cosine, eta) * microfacets.D(half.m);
  const float stretchO = microfacets.Stretch(wo), stretchI = microfacets.Stretch(wi);
  BsdfEvaluation result;
  result.specular = Color(FD * TrowbridgeReitz::ShadowingFactor(wo.z, stretchO, wi.z, stretchI));
  result.pdfForward = PdfSolidAngle(FD * TrowbridgeReitz::VisibleFactor(wo.z, stretchO));
  result.pdfReverse = PdfSolidAngle(FD * TrowbridgeReitz::VisibleFactor(wi.z, stretchI));
  return result;
}

BsdfEvaluation EvaluateTransmission(const TrowbridgeReitz& microfacets, float eta, const Vector3& wo, const Vector3& wi,
                                    TransportMode mode) {
  const Vector3 h = eta * wi + wo;
  const float lengthSquared = LengthSquared(h);
  if (!(lengthSquared > 0)) return {};
  Vector3 m = h / std::sqrt(lengthSquared);
  if (m.z < 0) m = -m;
  const float cosO = std::min(glm::dot(wo, m), 1.0f), cosI = std::min(-glm::dot(wi, m), 1.0f);
  if (!(cosO > 0) || !(cosI > 0)) return {};  // a microfacet seen from behind
  const float transmittance = 1 - FresnelDielectric(cosO, cosI, eta);
  const float value = transmittance * microfacets.D(m) * Refraction{cosO, cosI, eta}.Jacobian();
  const float stretchO = microfacets.Stretch(wo), stretchI = microfacets.Stretch(wi);
  const float invEtaSquared = 1 / (eta * eta);
  BsdfEvaluation result;
  const float f = value * TrowbridgeReitz::ShadowingFactor(wo.z, stretchO, -wi.z, stretchI);
  result.specular = Color(mode == TransportMode::Radiance ? f * invEtaSquared : f);
  result.pdfForward = PdfSolidAngle(value * TrowbridgeReitz::VisibleFactor(wo.z, stretchO));
  result.pdfReverse = PdfSolidAngle(value * invEtaSquared * TrowbridgeReitz::VisibleFactor(-wi.z, stretchI));
  return result;
}

void SampleSmooth(float eta, const Vector3& wo, float uLobe, TransportMode mode, BsdfSample& sample) {
  const float cosT = RefractedCosine(wo.z, eta);
  const float F = FresnelDielectric(wo.z, cosT, eta);
  sample.isDelta = true;
  if (uLobe < F) {
    sample.wi = {-wo.x, -wo.y, wo.z};
    sample.weightSpecular = Color(1.0f);
    sample.pdfForward = sample.pdfReverse = PdfSolidAngle(F);
    return;
  }
  sample.wi = {-wo.x / eta, -wo.y / eta, eta == 1 ? -wo.z : -cosT};
  if (!(sample.wi.z < 0)) return;
  sample.weightSpecular = Color(mode == TransportMode::Radiance ? 1 / (eta * eta) : 1.0f);
  sample.pdfForward = sample.pdfReverse = PdfSolidAngle(1 - F);
  sample.isTransmission = true;
  sample.eta = eta;
}

void SampleRough(const TrowbridgeReitz& microfacets, float eta, const Vector3& wo, float uLobe, const Point2& u,
                 TransportMode mode, BsdfSample& sample) {
  const Vector3 m = microfacets.SampleVisibleNormal(wo, u);
  const float cosO = std::min(glm::dot(wo, m), 1.0f);
  if (!(cosO > 0)) return;
  const float cosT = RefractedCosine(cosO, eta);
  const float F = FresnelDielectric(cosO, cosT, eta);
  const float stretchO = microfacets.Stretch(wo);
  const float D = microfacets.D(m);
  if (uLobe < F) {
    sample.wi = Reflect(wo, m, cosO);
    if (!(sample.wi.z > 0)) return;
    const float stretchI = microfacets.Stretch(sample.wi);
    sample.weightSpecular = Color(TrowbridgeReitz::ShadowingRatio(wo.z, stretchO, sample.wi.z, stretchI));
    sample.pdfForward = PdfSolidAngle(0.25f * F * D * TrowbridgeReitz::VisibleFactor(wo.z, stretchO));
    sample.pdfReverse = PdfSolidAngle(0.25f * F * D * TrowbridgeReitz::VisibleFactor(sample.wi.z, stretchI));
    return;
  }
  if (!(cosT > 0)) return;
  sample.wi = wo * (-1 / eta) + RefractionShift(cosO, cosT, eta) * m;
  if (!(sample.wi.z < 0)) return;
  const float stretchI = microfacets.Stretch(sample.wi);
  const float invEtaSquared = 1 / (eta * eta);
  const float ratio = TrowbridgeReitz::ShadowingRatio(wo.z, stretchO, -sample.wi.z, stretchI);
  const float value = (1 - F) * D * Refraction{cosO, cosT, eta}.Jacobian();
  sample.weightSpecular = Color(mode == TransportMode::Radiance ? ratio * invEtaSquared : ratio);
  sample.pdfForward = PdfSolidAngle(value * TrowbridgeReitz::VisibleFactor(wo.z, stretchO));
  sample.pdfReverse = PdfSolidAngle(value * invEtaSquared * TrowbridgeReitz::VisibleFactor(-sample.wi.z, stretchI));
  sample.isTransmission = true;
  sample.eta = eta;
}

}  // namespace

BsdfEvaluation DielectricBsdf::Evaluate(const Vector3& wo, const Vector3& wi, TransportMode mode) const {
  if (IsDelta()) return {};
  const bool inside = wo.z < 0;
  const Vector3 o = inside ? -wo : wo, i = inside ? -wi : wi;
  const float relative = inside ? 1 / eta : eta;
  return i.z > 0 ? EvaluateReflection(microfacets, relative, o, i)
                 : EvaluateTransmission(microfacets, relative, o, i, mode);
}

BsdfSample DielectricBsdf::Sample(const Vector3& wo, float uLobe, const Point2& u, TransportMode mode) const {
  const bool inside = wo.z < 0;
  const Vector3 o = inside ? -wo : wo;
  const float relative = inside ? 1 / eta : eta;
  BsdfSample sample;
  if (IsDelta()) {
    SampleSmooth(relative, o, uLobe, mode, sample);
  } else {
    SampleRough(microfacets, relative, o, uLobe, u, mode, sample);
  }
  if (inside) sample.wi = -sample.wi;
  return sample;
}

float ThinReflectance(float cosTheta, float eta) {
  const float R = FresnelDielectric(cosTheta, eta);
  return R < 1 ? R + Sqr(1 - R) * R / (1 - R * R) : 1.0f;
}

BsdfSample ThinDielectricBsdf::Sample(const Vector3& wo, float uLobe, const Point2&, TransportMode) const {
  const float R = isReflectionOnly ? 1.0f : ThinReflectance(std::abs(wo.z), eta);
  const bool reflects = uLobe < R;
  BsdfSample sample;
  sample.wi = reflects ? Vector3(-wo.x, -wo.y, wo.z) : -wo;
  sample.weightSpecular = reflects ? Color(1.0f) : transmittance;
  sample.pdfForward = sample.pdfReverse = PdfSolidAngle(reflects ? R : 1 - R);
  sample.isDelta = true;
  sample.isTransmission = !reflects;
  return sample;
}

}  // namespace lampyr
