// Bounds on accumulated rounding error, and a normalisation that survives any length.
#pragma once

#include "math/vec.h"

namespace lampyr {

// Bound on the relative error of n float operations in a row ([Higham02 §3.1]).
constexpr float Gamma(int n) {
  constexpr float u = 0x1p-24f;
  return static_cast<float>(n) * u / (1 - static_cast<float>(n) * u);
}

// `v` scaled to unit length, whatever its length; `fallback` when it is zero or not finite.
inline Vector3 SafeNormalize(const Vector3& v, const Vector3& fallback) {
  const float squared = LengthSquared(v);
  if (squared > 1e-30f && squared < 1e30f) return v * (1.0f / std::sqrt(squared));
  const double length = glm::length(Vector3d(v));
  return length > 0 && std::isfinite(length) ? Vector3(Vector3d(v) / length) : fallback;
}

}  // namespace lampyr
