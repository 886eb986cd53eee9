// Maps directions and their densities between a light's local space and render space.
//
// A linear map M carries local directions to render space: ω = M l / |M l|. With A = M⁻¹ the solid angles are related
// by dω_local / dω = |det A| / |A ω|³, which is 1 for rotations, mirrors and uniform scales. A light whose distribution
// is defined in local directions (a cone, an image) multiplies its local density by that factor.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>

#include <glm/matrix.hpp>

#include "lights/light.h"
#include "math/vec.h"

namespace lampyr {

// True if a sum of squares of this size is accurate: squares of larger or smaller components overflow or underflow.
inline bool IsOfGoodSize(float square) {
  return square > 1e-30f && square < 1e30f;
}

// The unit direction of a mapped direction, computed in double where its length would overflow or underflow.
inline Vector3 MappedDirection(const Affine& map, const Vector3& direction) {
  const Vector3 mapped = map.Vector(direction);
  if (IsOfGoodSize(LengthSquared(mapped))) [[likely]]
    return glm::normalize(mapped);
  return Vector3(glm::normalize(glm::dmat3(map.linear) * Vector3d(direction)));
}

inline float LargestComponent(const glm::mat3& m) {
  return std::max({MaxAbsComponent(m[0]), MaxAbsComponent(m[1]), MaxAbsComponent(m[2])});
}

inline Vector3 ToLocalDirection(const LightTransform& transform, const Vector3& direction) {
  return MappedDirection(transform.toLocal, direction);
}

inline Vector3 ToRenderDirection(const LightTransform& transform, const Vector3& local) {
  return MappedDirection(transform.toRender, local);
}

// dω_local / dω at the unit render-space `direction`.
inline float LocalSolidAngleFactor(const LightTransform& transform, const Vector3& direction) {
  const Vector3 local = transform.toLocal.Vector(direction);
  if (IsOfGoodSize(LengthSquared(local))) [[likely]]
    return std::abs(glm::determinant(transform.toLocal.linear * (1.0f / glm::length(local))));
  const glm::dmat3 map(transform.toLocal.linear);
  return static_cast<float>(std::abs(glm::determinant(map)) / std::pow(glm::length(map * Vector3d(direction)), 3));
}

// True if the linear map is a rotation or reflection times a uniform scale, to float precision.
inline bool IsSimilarity(const glm::mat3& map) {
  const float largest = LargestComponent(map);
  const glm::mat3 m = IsOfGoodSize(largest * largest) ? map : map / largest;
  const float xx = glm::dot(m[0], m[0]), yy = glm::dot(m[1], m[1]), zz = glm::dot(m[2], m[2]);
  const float tolerance = 4e-6f * xx;
  return std::abs(yy - xx) <= tolerance && std::abs(zz - xx) <= tolerance &&
         std::abs(glm::dot(m[0], m[1])) <= tolerance && std::abs(glm::dot(m[0], m[2])) <= tolerance &&
         std::abs(glm::dot(m[1], m[2])) <= tolerance;
}

// True if a light's placement is the one that it was built with, so that precomputed values are valid. Compares bits:
// fast, and conservative.
inline bool SamePlacement(const LightTransform& a, const LightTransform& b) {
  static_assert(sizeof(Affine) == 12 * sizeof(float), "no padding to compare");
  return std::memcmp(&a.toRender, &b.toRender, sizeof(Affine)) == 0;
}

// If `now` is `built` followed by a rotation or reflection and a uniform scale: the square of that scale, by which
// areas grow while angles are preserved.
inline std::optional<float> RelativeScaleSquared(const LightTransform& built, const LightTransform& now) {
  const glm::mat3 change = now.toRender.linear * built.toLocal.linear;
  if (!IsSimilarity(change)) return std::nullopt;
  return glm::dot(change[0], change[0]);
}

}  // namespace lampyr
