// Maps between square and sphere, for environment images and the spherical camera.
//
// Equal-area octahedral map ([Clarberg08]), oriented as in pbrt-v4: the centre of the square is +z, its corners are -z,
// the midpoint of the right edge is +x, and the midpoint of the lower edge (v = 1) is +y.
//
// Latitude-longitude map: u = φ/2π from +x, v = θ/π from +z.
#pragma once

#include "math/vec.h"
#include "sampling/warp.h"

namespace lampyr {

inline Vector3 EqualAreaSquareToSphere(const Point2& p) {
  const float u = 2 * p.x - 1, v = 2 * p.y - 1;
  const float absU = std::abs(u), absV = std::abs(v);
  const float toEquator = 1 - (absU + absV);  // positive in the diamond that is the upper hemisphere
  const float r = 1 - std::abs(toEquator);
  // φ - π/4 within the quadrant; cos and sin of φ by the rotation through π/4.
  const Vector2 turned = warp_internal::CosSinOctant(r > 0 ? (absV - absU) / r * (0.25f * kPi) : 0.0f);
  const float scale = r * SafeSqrt(2 - r * r) * 0.70710678118654752f;
  return {std::copysign((turned.x - turned.y) * scale, u), std::copysign((turned.x + turned.y) * scale, v),
          std::copysign(1 - r * r, toEquator)};
}

// The inverse map; `direction` is of unit length.
inline Point2 EqualAreaSphereToSquare(const Vector3& direction) {
  const float x = std::abs(direction.x), y = std::abs(direction.y), z = std::abs(direction.z);
  const float r = SafeSqrt(z > 0.5f ? (x * x + y * y) / (1 + z) : 1 - z);
  const float quadrant = x + y > 0 ? std::atan2(y, x) * (2 * kInvPi) : 0.5f;  // φ in units of π/2
  float v = quadrant * r;
  float u = r - v;
  if (direction.z < 0) {
    const float flippedU = 1 - v;
    v = 1 - u;
    u = flippedU;
  }
  return {warp_internal::ClampUnit(0.5f * (std::copysign(u, direction.x) + 1)),
          warp_internal::ClampUnit(0.5f * (std::copysign(v, direction.y) + 1))};
}

// Wraps a point that lies less than one image outside of the square into it: the map folds about the midpoints of its
// edges.
inline Point2 WrapEqualAreaSquare(Point2 p) {
  if (p.x < 0) p = {-p.x, 1 - p.y};
  if (p.x > 1) p = {2 - p.x, 1 - p.y};
  if (p.y < 0) p = {1 - p.x, -p.y};
  if (p.y > 1) p = {1 - p.x, 2 - p.y};
  return p;
}

inline Vector3 LatLongSquareToSphere(const Point2& uv) {
  const Vector2 theta = CosSinTurns(0.5f * uv.y), phi = CosSinTurns(uv.x);
  return {theta.y * phi.x, theta.y * phi.y, theta.x};
}

inline Point2 LatLongSphereToSquare(const Vector3& direction) {
  const float sinTheta = std::sqrt(direction.x * direction.x + direction.y * direction.y);
  return {warp_internal::Turns(direction.x, direction.y),
          warp_internal::ClampUnit(std::atan2(sinTheta, direction.z) * kInvPi)};
}

// |dω/dA| of the latitude-longitude map: a density over the square divided by it is a density in solid angle. 0 at the
// poles, where no density is finite.
inline float LatLongJacobian(float sinTheta) {
  return 2 * kPi * kPi * sinTheta;
}
// |dω/dA| of the equal-area map, constant.
inline constexpr float kEqualAreaJacobian = 4 * kPi;

}  // namespace lampyr
