#include "materials/conductor.h"

#include "materials/fresnel.h"

namespace lampyr {

BsdfEvaluation ConductorBsdf::Evaluate(const Vector3& wo, const Vector3& wi, TransportMode) const {
  if (!(wo.z * wi.z > 0) || microfacets.IsSmooth()) return {};
  const float cosO = std::abs(wo.z), cosI = std::abs(wi.z);
  const Vector3 h = wo + wi;
  const float lengthSquared = LengthSquared(h);
  if (!(lengthSquared > 1e-20f)) return {};
  Vector3 m = h / std::sqrt(lengthSquared);
  const Color F = FresnelConductor(glm::dot(wo, m), eta, k);
  if (m.z < 0) m = -m;
  const float D = microfacets.D(m);
  const float stretchO = microfacets.Stretch(wo), stretchI = microfacets.Stretch(wi);
  BsdfEvaluation result;
  result.specular = F * (0.25f * D * TrowbridgeReitz::ShadowingFactor(cosO, stretchO, cosI, stretchI));
  result.pdfForward = PdfSolidAngle(0.25f * D * TrowbridgeReitz::VisibleFactor(cosO, stretchO));
  result.pdfReverse = PdfSolidAngle(0.25f * D * TrowbridgeReitz::VisibleFactor(cosI, stretchI));
  return result;
}

std::optional<BsdfSample> ConductorBsdf::Sample(const Vector3& wo, float, const Point2& u, TransportMode) const {
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
  if (!(wi.z > 0)) return std::nullopt;
  const float D = microfacets.D(m);
  const float stretchO = microfacets.Stretch(up), stretchI = microfacets.Stretch(wi);
  sample.wi = wo.z < 0 ? -wi : wi;
  sample.weightSpecular =
      FresnelConductor(cosine, eta, k) * TrowbridgeReitz::ShadowingRatio(up.z, stretchO, wi.z, stretchI);
  sample.pdfForward = PdfSolidAngle(0.25f * D * TrowbridgeReitz::VisibleFactor(up.z, stretchO));
  sample.pdfReverse = PdfSolidAngle(0.25f * D * TrowbridgeReitz::VisibleFactor(wi.z, stretchI));
  return sample;
}

Color ConductorBsdf::ApproximateAlbedo() const { return FresnelConductor(1, eta, k); }

}  // namespace lampyr
