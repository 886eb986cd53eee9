// The Trowbridge-Reitz (GGX) distribution of microfacets with height-correlated Smith shadowing ([Walter07],
// [Heitz14]).
//
// All directions here are in the upper hemisphere (z ≥ 0). Shadowing is never computed on its own, but in the ratios in
// which it occurs, in which no cosine is a divisor. With s(w) = sqrt(z² + (αx·x)² + (αy·y)²), Λ = (s/z - 1)/2:
//   G1(wo)/cosθo = 2 / (cosθo + so),   G2/(cosθo·cosθi) = 2 / (so·cosθi + si·cosθo).
#pragma once

#include "math/vec.h"
#include "sampling/warp.h"

namespace lampyr {

struct TrowbridgeReitz {
  float alphaX = 0, alphaY = 0;

  TrowbridgeReitz() = default;
  // Both are at least 1e-4, unless the surface counts as smooth.
  TrowbridgeReitz(float x, float y) : alphaX(x), alphaY(y) {
    if (!IsSmooth()) alphaX = std::max(alphaX, 1e-4f), alphaY = std::max(alphaY, 1e-4f);
  }

  // True if the surface is treated as a perfect mirror, a delta (the threshold of pbrt-v4).
  bool IsSmooth() const { return std::max(alphaX, alphaY) < 1e-3f; }

  // The rougher microfacets of pbrt-v4's "regularize": α below 0.3 is doubled, to between 0.1 and 0.3.
  TrowbridgeReitz Roughened() const {
    const auto roughen = [](float alpha) { return alpha < 0.3f ? std::min(std::max(2 * alpha, 0.1f), 0.3f) : alpha; };
    return {roughen(alphaX), roughen(alphaY)};
  }

  // Distribution of microfacet normals, 1/sr, m.z ≥ 0.
  float D(const Vector3& m) const {
    const float x = m.x / alphaX, y = m.y / alphaY;
    const float e = x * x + y * y + m.z * m.z;
    return 1 / (kPi * alphaX * alphaY * e * e);
  }

  // s(w), see above.
  float Stretch(const Vector3& w) const { return std::sqrt(w.z * w.z + Sqr(alphaX * w.x) + Sqr(alphaY * w.y)); }

  // G1(wo)/cosθo: the density of SampleVisibleNormal divided by D(m)·dot(wo, m).
  static float VisibleFactor(float cosO, float stretchO) { return 2 / (cosO + stretchO); }
  // G2/(cosθo·cosθi).
  static float ShadowingFactor(float cosO, float stretchO, float cosI, float stretchI) {
    return 2 / (stretchO * cosI + stretchI * cosO);
  }
  // G2/G1(wo): the weight of a sampled visible microfacet.
  static float ShadowingRatio(float cosO, float stretchO, float cosI, float stretchI) {
    return cosI * (cosO + stretchO) / (stretchO * cosI + stretchI * cosO);
  }

  // Samples a microfacet normal visible from wo (z > 0), by spherical caps ([Dupuy23]). Density
  // D·G1(wo)·dot(wo,m)/cosθo.
  Vector3 SampleVisibleNormal(const Vector3& wo, const Point2& u) const {
    const Vector3 stretched(alphaX * wo.x, alphaY * wo.y, wo.z);
    const Vector3 standard = stretched / std::sqrt(LengthSquared(stretched));
    const Vector2 phi = CosSinTurns(u.x);
    const float z = (1 - u.y) * (1 + standard.z) - standard.z;
    const float sine = SafeSqrt((1 - z) * (1 + z));
    const Vector3 h(sine * phi.x + standard.x, sine * phi.y + standard.y, z + standard.z);
    const Vector3 m(alphaX * h.x, alphaY * h.y, std::max(h.z, 0.0f));
    const float lengthSquared = LengthSquared(m);
    return lengthSquared > 1e-30f ? m / std::sqrt(lengthSquared) : Vector3(0, 0, 1);
  }
};

// The microfacet that reflects wo into wi (both with z > 0), and the cosine at it, |wo + wi|/2, which rounding near
// grazing angles cannot make negative. A cosine of 0: no such microfacet.
struct HalfVector {
  Vector3 m;
  float cosine;
};
inline HalfVector HalfVectorOf(const Vector3& wo, const Vector3& wi) {
  const Vector3 h = wo + wi;
  const float length = std::sqrt(LengthSquared(h));
  if (!(length > 1e-10f)) return {{0, 0, 1}, 0};
  return {h / length, std::min(0.5f * length, 1.0f)};
}

inline Vector3 Reflect(const Vector3& wo, const Vector3& m, float cosine) {
  return 2 * cosine * m - wo;
}

}  // namespace lampyr
