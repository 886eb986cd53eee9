// Maps directions and their densities between a light's local space and render space.
//
// A linear map M carries local directions to render space: ω = M l / |M l|. With A = M⁻¹ the solid angles are related
// by dω_local / dω = |det A| / |A ω|³, which is 1 for rotations, mirrors and uniform scales. A light whose distribution
// is defined in local directions (a cone, an image) multiplies its local density by that factor.
#pragma once

#include <cstring>
#include <optional>

#include <glm/matrix.hpp>

#include "lights/light.h"
#include "math/vec.h"

namespace lampyr {

inline Vector3 ToLocalDirection(const LightTransform& transform, const Vector3& direction) {
  return glm::normalize(transform.toLocal.Vector(direction));
}

inline Vector3 ToRenderDirection(const LightTransform& transform, const Vector3& local) {
  return glm::normalize(transform.toRender.Vector(local));
}

// dω_local / dω at the unit render-space `direction`. Scaled first, so that no size of transform overflows.
inline float LocalSolidAngleFactor(const LightTransform& transform, const Vector3& direction) {
  const float length = glm::length(transform.toLocal.Vector(direction));
  return std::abs(glm::determinant(transform.toLocal.linear * (1.0f / length)));
}

// True if the linear map is a rotation or reflection times a uniform scale, to float precision.
inline bool IsSimilarity(const glm::mat3& m) {
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
