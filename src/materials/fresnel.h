// Fresnel reflectances for unpolarised light. η is relative: the index of the far side over that of the side of
// incidence.
#pragma once

#include "math/vec.h"

namespace lampyr {

// Cosine of the refracted angle (≥ 0) for 0 ≤ cosθi; 0 for total internal reflection.
inline float RefractedCosine(float cosThetaI, float eta) {
  return SafeSqrt(1 - (1 - cosThetaI * cosThetaI) / (eta * eta));
}

// Dielectric; cosθi in [0,1] and the corresponding refracted cosine ([Pharr23 §9.3.5]). 1 for total reflection.
inline float FresnelDielectric(float cosThetaI, float cosThetaT, float eta) {
  if (eta == 1) return 0;
  if (cosThetaT == 0) return 1;
  const float parallel = (eta * cosThetaI - cosThetaT) / (eta * cosThetaI + cosThetaT);
  const float perpendicular = (cosThetaI - eta * cosThetaT) / (cosThetaI + eta * cosThetaT);
  return 0.5f * (parallel * parallel + perpendicular * perpendicular);
}
inline float FresnelDielectric(float cosThetaI, float eta) {
  return FresnelDielectric(cosThetaI, RefractedCosine(cosThetaI, eta), eta);
}

// The coefficient cosθi/η - cosθt in the refracted direction -wo/η + (cosθi/η - cosθt) m, without its cancellation near
// η = 1: the difference of the squares is 1/η² - 1.
inline float RefractionShift(float cosThetaI, float cosThetaT, float eta) {
  const float sum = cosThetaI / eta + cosThetaT;
  return sum > 0 ? (1 - eta) * (1 + eta) / (eta * eta * sum) : 0.0f;
}

// Conductor with the complex index η + ik, one channel, cosθi in (0,1] ([Born99 §14.2], in real arithmetic).
inline float FresnelConductor(float cosThetaI, float eta, float k) {
  const float cos2 = cosThetaI * cosThetaI, sin2 = 1 - cos2;
  const float t0 = (eta - k) * (eta + k) - sin2;
  const float twice = 2 * eta * k;
  const float a2b2 = std::sqrt(t0 * t0 + twice * twice);
  // a² = (a2b2 + t0)/2, without cancellation where t0 < 0: (a2b2 + t0)(a2b2 - t0) = (2ηk)².
  const float sum = a2b2 + std::abs(t0);
  const float a = std::sqrt(0.5f * (t0 < 0 ? (sum > 0 ? twice * (twice / sum) : 0.0f) : sum));
  const float t1 = a2b2 + cos2, t2 = 2 * cosThetaI * a;
  const float perpendicular = (t1 - t2) / (t1 + t2);
  const float t3 = cos2 * a2b2 + sin2 * sin2, t4 = t2 * sin2;
  const float ratio = t3 + t4 > 0 ? (t3 - t4) / (t3 + t4) : 1.0f;
  return std::min(std::max(0.5f * perpendicular * (1 + ratio), 0.0f), 1.0f);
}
inline Color FresnelConductor(float cosThetaI, const Color& eta, const Color& k) {
  const float c = std::min(std::max(cosThetaI, 1e-6f), 1.0f);
  return {FresnelConductor(c, eta.r, k.r), FresnelConductor(c, eta.g, k.g), FresnelConductor(c, eta.b, k.b)};
}

}  // namespace lampyr
