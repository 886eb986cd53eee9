// Reflection at the outer boundary of a coat, seen from outside: shared by the coated models. wo.z > 0.
#pragma once

#include <optional>

#include "materials/fresnel.h"
#include "materials/microfacet.h"
#include "materials/scattering.h"

namespace lampyr {

// Probability of sampling the lobe of the coat, from rough estimates of the reflectances of coat and base. It is at
// least 0.1 and at most 0.95 for a rough coat, whose Fresnel factor varies over the lobe: if either estimate were far
// too low, the weight of a sample would be 1/probability.
inline float CoatLobeProbability(float coat, float base, bool coatIsDelta) {
  if (!(base > 0)) return 1;
  const float probability = coat / (coat + base);
  return coatIsDelta ? probability : std::min(std::max(probability, 0.1f), 0.95f);
}

// Value and densities of a lobe.
struct LobeValue {
  float f = 0, pdfForward = 0, pdfReverse = 0;
};

// Rough boundaries only. The densities are those of sampling a visible microfacet and reflecting at it, without the
// Fresnel factor.
inline LobeValue EvaluateCoatLobe(const TrowbridgeReitz& microfacets, float eta, const Vector3& wo, const Vector3& wi) {
  const HalfVector half = HalfVectorOf(wo, wi);
  if (!(half.cosine > 0)) return {};
  const float quarterD = 0.25f * microfacets.D(half.m);
  const float stretchO = microfacets.Stretch(wo), stretchI = microfacets.Stretch(wi);
  const float F = FresnelDielectric(half.cosine, eta);
  return {F * quarterD * TrowbridgeReitz::ShadowingFactor(wo.z, stretchO, wi.z, stretchI),
          quarterD * TrowbridgeReitz::VisibleFactor(wo.z, stretchO),
          quarterD * TrowbridgeReitz::VisibleFactor(wi.z, stretchI)};
}

// The mirror direction at a sampled visible microfacet; nullopt if it points into the surface.
inline std::optional<Vector3> SampleMicrofacetMirror(const TrowbridgeReitz& microfacets, const Vector3& wo,
                                                     const Point2& u) {
  const Vector3 m = microfacets.SampleVisibleNormal(wo, u);
  const Vector3 wi = Reflect(wo, m, glm::dot(wo, m));
  if (!(wi.z > 0)) return std::nullopt;
  return wi;
}

}  // namespace lampyr
