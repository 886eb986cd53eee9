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

namespace {

float& Lane(Color& color, int lane) {
  return lane == 0 ? color.r : lane == 1 ? color.g : color.b;
}

DielectricBsdf OfLane(const DispersiveBsdf& bsdf, int lane) {
  Color eta = bsdf.eta;
  return {bsdf.microfacets, Lane(eta, lane)};
}

// Reflectances of the lanes at cosθ to the normal, from inside if `inside`.
Color LaneReflectances(const Color& eta, float cosTheta, bool inside) {
  const auto reflectance = [&](float ofLane) { return FresnelDielectric(cosTheta, inside ? 1 / ofLane : ofLane); };
  return {reflectance(eta.r), reflectance(eta.g), reflectance(eta.b)};
}

constexpr int kLanes = 3;

BsdfSample SampleSmoothLanes(const DispersiveBsdf& bsdf, const Vector3& wo, float uLobe, TransportMode mode) {
  BsdfSample sample;
  const bool inside = wo.z < 0;
  Color reflectances = LaneReflectances(bsdf.eta, std::abs(wo.z), inside);
  const float reflected = reflectances.Average();
  sample.isDelta = true;
  if (uLobe < reflected) {
    sample.wi = {-wo.x, -wo.y, wo.z};
    sample.weightSpecular = reflectances / reflected;
    sample.pdfForward = sample.pdfReverse = PdfSolidAngle(reflected);
    return sample;
  }
  sample.isDispersion = true;
  const float transmitted = 1 - Lane(reflectances, bsdf.lane);
  if (!(transmitted > 0)) return sample;
  Color eta = bsdf.eta;
  const float relative = inside ? 1 / Lane(eta, bsdf.lane) : Lane(eta, bsdf.lane);
  const float cosT = RefractedCosine(std::abs(wo.z), relative);
  sample.wi = {-wo.x / relative, -wo.y / relative, inside ? cosT : -cosT};
  if (!(cosT > 0)) return sample;
  const float weight = transmitted / (1 - reflected);
  Lane(sample.weightSpecular, bsdf.lane) = mode == TransportMode::Radiance ? weight / (relative * relative) : weight;
  sample.pdfForward = PdfSolidAngle(1 - reflected);
  sample.pdfReverse = PdfSolidAngle(1 - LaneReflectances(bsdf.eta, cosT, !inside).Average());
  sample.isTransmission = true;
  sample.eta = relative;
  return sample;
}

}  // namespace

BsdfEvaluation DispersiveBsdf::Evaluate(const Vector3& wo, const Vector3& wi, TransportMode mode) const {
  BsdfEvaluation result;
  if (IsDelta()) return result;
  for (int lane = 0; lane < kLanes; ++lane) {
    const BsdfEvaluation f = OfLane(*this, lane).Evaluate(wo, wi, mode);
    Lane(result.specular, lane) = f.specular.r;
    result.pdfForward = result.pdfForward + f.pdfForward;
    result.pdfReverse = result.pdfReverse + f.pdfReverse;
  }
  result.pdfForward = (1.0f / kLanes) * result.pdfForward;
  result.pdfReverse = (1.0f / kLanes) * result.pdfReverse;
  return result;
}

BsdfSample DispersiveBsdf::Sample(const Vector3& wo, float uLobe, const Point2& u, TransportMode mode) const {
  if (IsDelta()) return SampleSmoothLanes(*this, wo, uLobe, mode);
  const int lane = std::min(static_cast<int>(kLanes * uLobe), kLanes - 1);
  BsdfSample sample =
      OfLane(*this, lane).Sample(wo, std::min(kLanes * uLobe - static_cast<float>(lane), kOneMinusEpsilon), u, mode);
  if (!sample || sample.isDelta) return {};
  const BsdfEvaluation f = Evaluate(wo, sample.wi, mode);
  if (!(f.pdfForward.value > 0)) return {};
  sample.weightSpecular = f.specular * (std::abs(sample.wi.z) / f.pdfForward.value);
  sample.pdfForward = f.pdfForward;
  sample.pdfReverse = f.pdfReverse;
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
