#include "materials/conductor.h"

#include "materials/fresnel.h"

namespace lampyr {

BsdfEvaluation ConductorBsdf::Evaluate(const Vector3& wo, const Vector3& wi, TransportMode) const {
  if (!(wo.z * wi.z > 0) || microfacets.IsSmooth()) return {};
  const Vector3 o = wo.z < 0 ? -wo : wo, i = wo.z < 0 ? -wi : wi;
  const HalfVector half = HalfVectorOf(o, i);
  if (!(half.cosine > 0)) return {};
  const Color F = FresnelConductor(half.cosine, eta, k);
  const float D = microfacets.D(half.m);
  const float stretchO = microfacets.Stretch(o), stretchI = microfacets.Stretch(i);
  BsdfEvaluation result;
  result.specular = F * (0.25f * D * TrowbridgeReitz::ShadowingFactor(o.z, stretchO, i.z, stretchI));
  result.pdfForward = PdfSolidAngle(0.25f * D * TrowbridgeReitz::VisibleFactor(o.z, stretchO));
  result.pdfReverse = PdfSolidAngle(0.25f * D * TrowbridgeReitz::VisibleFactor(i.z, stretchI));
  return result;
}

BsdfSample ConductorBsdf::Sample(const Vector3& wo, float, const Point2& u, TransportMode) const {
  BsdfSample sample;
  if (microfacets.IsSmooth()) {
    sample.wi = {-wo.x, -wo.y, wo.z};
    sample.weightSpecular = FresnelConductor(std::abs(wo.z), eta, k);
    sample.pdfForward = sample.pdfReverse = PdfSolidAngle(1);
    sample.isDelta = true;
    return sample;
  }
  const Vector3 up = wo.z < 0 ? -wo : wo;
  const Vector3 m = microfacets.SampleVisibleNormal(up, u);
  const float cosine = glm::dot(up, m);
  const Vector3 wi = Reflect(up, m, cosine);
  if (!(wi.z > 0)) return sample;
  const float D = microfacets.D(m);
  const float stretchO = microfacets.Stretch(up), stretchI = microfacets.Stretch(wi);
  sample.wi = wo.z < 0 ? -wi : wi;
  sample.weightSpecular =
      FresnelConductor(cosine, eta, k) * TrowbridgeReitz::ShadowingRatio(up.z, stretchO, wi.z, stretchI);
  sample.pdfForward = PdfSolidAngle(0.25f * D * TrowbridgeReitz::VisibleFactor(up.z, stretchO));
  sample.pdfReverse = PdfSolidAngle(0.25f * D * TrowbridgeReitz::VisibleFactor(wi.z, stretchI));
  return sample;
}

}  // namespace lampyr
