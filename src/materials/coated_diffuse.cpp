#include "materials/coated_diffuse.h"

#include "materials/coat_lobe.h"

namespace lampyr {

namespace {

Color SumBounces(const Color& reflectance, float internal, int bounces) {
  return {reflectance.r * TruncatedSeries(reflectance.r * internal, bounces),
          reflectance.g * TruncatedSeries(reflectance.g * internal, bounces),
          reflectance.b * TruncatedSeries(reflectance.b * internal, bounces)};
}

}  // namespace

CoatedDiffuseBsdf::CoatedDiffuseBsdf(const TrowbridgeReitz& microfacets, float eta, const Color& reflectance,
                                     int bounces, const CoatTable& table)
    : microfacets_(microfacets),
      eta_(eta),
      slice_(table.FindSlice(std::sqrt(microfacets.alphaX * microfacets.alphaY))),
      table_(&table) {
  base_ = SumBounces(reflectance, table.InternalReflectance(slice_), bounces) / (eta * eta);
  baseAlbedo_ = base_.Max() * table.MeanTransmittance(slice_);
}

float CoatedDiffuseBsdf::CoatProbability(float cosO, float transmittance) const {
  return CoatLobeProbability(table_->Reflectance(cosO, slice_), transmittance * baseAlbedo_, CoatIsDelta());
}

BsdfEvaluation CoatedDiffuseBsdf::Evaluate(const Vector3& wo, const Vector3& wi, TransportMode) const {
  if (!(wo.z * wi.z > 0)) return {};
  const Vector3 o = wo.z < 0 ? -wo : wo, i = wo.z < 0 ? -wi : wi;
  const float To = table_->Transmittance(o.z, slice_), Ti = table_->Transmittance(i.z, slice_);
  const float coatO = CoatProbability(o.z, To), coatI = CoatProbability(i.z, Ti);
  BsdfEvaluation result;
  result.diffuse = base_ * (To * Ti * kInvPi);
  result.pdfForward = PdfSolidAngle((1 - coatO) * i.z * kInvPi);
  result.pdfReverse = PdfSolidAngle((1 - coatI) * o.z * kInvPi);
  if (CoatIsDelta()) return result;
  const LobeValue coat = EvaluateCoatLobe(microfacets_, eta_, o, i);
  result.specular = Color(coat.f);
  result.pdfForward.value += coatO * coat.pdfForward;
  result.pdfReverse.value += coatI * coat.pdfReverse;
  return result;
}

BsdfSample CoatedDiffuseBsdf::Sample(const Vector3& wo, float uLobe, const Point2& u, TransportMode mode) const {
  const Vector3 o = wo.z < 0 ? -wo : wo;
  const float coatO = CoatProbability(o.z, table_->Transmittance(o.z, slice_));
  const bool takeCoat = uLobe < coatO;
  BsdfSample sample;
  if (takeCoat && CoatIsDelta()) {
    sample.wi = {-wo.x, -wo.y, wo.z};
    sample.weightSpecular = Color(FresnelDielectric(o.z, eta_) / coatO);
    sample.pdfForward = sample.pdfReverse = PdfSolidAngle(coatO);
    sample.isDelta = true;
    return sample;
  }
  if (!takeCoat && base_.IsBlack()) return sample;
  const auto wi = takeCoat ? SampleMicrofacetMirror(microfacets_, o, u) : SampleCosineHemisphere(u);
  if (!wi) return sample;
  const BsdfEvaluation value = Evaluate(o, *wi, mode);
  if (!(value.pdfForward.value > 0)) return sample;
  sample.wi = wo.z < 0 ? -*wi : *wi;
  const float scale = wi->z / value.pdfForward.value;
  sample.weightDiffuse = value.diffuse * scale;
  sample.weightSpecular = value.specular * scale;
  sample.pdfForward = value.pdfForward;
  sample.pdfReverse = value.pdfReverse;
  return sample;
}

}  // namespace lampyr
