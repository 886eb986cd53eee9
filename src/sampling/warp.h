// Maps from the unit square to disks, spheres, hemispheres, cones and triangles: sample, density, and the inverse of
// the sample. Directions are about +z; u is in [0,1)²; Invert… returns a point of [0,1)².
#pragma once

#include "math/density.h"
#include "math/vec.h"

namespace lampyr {

namespace warp_internal {

// (cos, sin) of an angle in [-π/4, π/4] by their series, to float precision.
inline Vector2 CosSinOctant(float angle) {
  const float s = angle * angle;
  const float cosine =
      1 + s * (-0.5f + s * (1.0f / 24 + s * (-1.0f / 720 + s * (1.0f / 40320 - s * (1.0f / 3628800)))));
  const float sine = angle * (1 + s * (-1.0f / 6 + s * (1.0f / 120 + s * (-1.0f / 5040 + s * (1.0f / 362880)))));
  return {cosine, sine};
}

inline float ClampUnit(float u) {
  return std::min(std::max(u, 0.0f), kOneMinusEpsilon);
}

// The angle of (x, y) in turns, in [0,1).
inline float Turns(float x, float y) {
  const float turns = std::atan2(y, x) * (0.5f * kInvPi);
  return ClampUnit(turns < 0 ? turns + 1 : turns);
}

// 1 - cosθ of the unit vector v without cancellation near the pole.
inline float OneMinusCosTheta(const Vector3& v) {
  return v.z > 0.5f ? (v.x * v.x + v.y * v.y) / (1 + v.z) : 1 - v.z;
}

}  // namespace warp_internal

// (cos, sin) of 2π·turns. The reduction to an octant is exact, because it is done in turns.
inline Vector2 CosSinTurns(float turns) {
  const float quarter = std::floor(4 * turns + 0.5f);
  const Vector2 octant = warp_internal::CosSinOctant((turns - 0.25f * quarter) * (2 * kPi));
  const int k = static_cast<int>(quarter) & 3;
  const float a = k & 1 ? octant.y : octant.x;
  const float b = k & 1 ? octant.x : octant.y;
  return {k == 1 || k == 2 ? -a : a, k >= 2 ? -b : b};
}

// 1 - cosθ from sin²θ, θ in [0, π/2]; exact also for angles far below the resolution of cosθ in float.
inline float OneMinusCosFromSinSquared(float sinSquared) {
  return sinSquared / (1 + SafeSqrt(1 - sinSquared));
}

// --- Unit disk, uniform; concentric squares map to concentric circles, and neighbours stay neighbours ([Shirley97]).
inline Point2 SampleConcentricDisk(const Point2& u) {
  const float a = 2 * u.x - 1, b = 2 * u.y - 1;
  const bool horizontal = std::abs(a) > std::abs(b);
  const float r = horizontal ? a : b;
  const float other = horizontal ? b : a;
  const Vector2 direction = warp_internal::CosSinOctant(r != 0 ? (0.25f * kPi) * (other / r) : 0.0f);
  const float along = r * direction.x, across = r * direction.y;
  return {horizontal ? along : across, horizontal ? across : along};
}
inline PdfArea ConcentricDiskPdf() {
  return PdfArea(kInvPi);
}
inline Point2 InvertConcentricDisk(const Point2& p) {
  const bool horizontal = std::abs(p.x) > std::abs(p.y);
  const float along = horizontal ? p.x : p.y;
  const float across = horizontal ? p.y : p.x;
  if (along == 0) return {0.5f, 0.5f};
  const float r = std::copysign(std::sqrt(p.x * p.x + p.y * p.y), along);
  const float other = r * (4 * kInvPi) * std::atan(across / along);
  const float a = horizontal ? r : other, b = horizontal ? other : r;
  return {warp_internal::ClampUnit(0.5f * (a + 1)), warp_internal::ClampUnit(0.5f * (b + 1))};
}

// --- Hemisphere with density cosθ/π. The cosine is never 0, not even on the rim of the square.
inline Vector3 SampleCosineHemisphere(const Point2& u) {
  const Point2 disk = SampleConcentricDisk(u);
  const float r = std::max(std::abs(2 * u.x - 1), std::abs(2 * u.y - 1));
  return {disk.x, disk.y, std::sqrt(std::max((1 - r) * (1 + r), 0x1p-26f))};
}
inline PdfSolidAngle CosineHemispherePdf(float cosTheta) {
  return PdfSolidAngle(std::max(cosTheta, 0.0f) * kInvPi);
}
inline Point2 InvertCosineHemisphere(const Vector3& v) {
  return InvertConcentricDisk({v.x, v.y});
}

// --- Sphere, uniform: u.x goes from the north pole to the south pole.
inline Vector3 SampleUniformSphere(const Point2& u) {
  const Vector2 phi = CosSinTurns(u.y);
  const float r = 2 * SafeSqrt(u.x * (1 - u.x));
  return {r * phi.x, r * phi.y, 1 - 2 * u.x};
}
inline PdfSolidAngle UniformSpherePdf() {
  return PdfSolidAngle(0.25f * kInvPi);
}
inline Point2 InvertUniformSphere(const Vector3& v) {
  return {warp_internal::ClampUnit(0.5f * warp_internal::OneMinusCosTheta(v)), warp_internal::Turns(v.x, v.y)};
}

// --- Cone of directions within θmax of +z, uniform. Takes 1 - cosθmax in (0, 2]: cosθmax itself is 1 for small lights.
inline Vector3 SampleUniformCone(const Point2& u, float oneMinusCosThetaMax) {
  const float t = u.x * oneMinusCosThetaMax;
  const Vector2 phi = CosSinTurns(u.y);
  const float r = SafeSqrt(t * (2 - t));
  return {r * phi.x, r * phi.y, 1 - t};
}
inline PdfSolidAngle UniformConePdf(float oneMinusCosThetaMax) {
  return PdfSolidAngle(1 / (2 * kPi * oneMinusCosThetaMax));
}
inline Point2 InvertUniformCone(const Vector3& v, float oneMinusCosThetaMax) {
  return {warp_internal::ClampUnit(warp_internal::OneMinusCosTheta(v) / oneMinusCosThetaMax),
          warp_internal::Turns(v.x, v.y)};
}

// --- Hemisphere, uniform: the cone of 90°. u.x goes from the pole to the rim, which is never reached.
inline Vector3 SampleUniformHemisphere(const Point2& u) {
  return SampleUniformCone(u, 1);
}
inline PdfSolidAngle UniformHemispherePdf() {
  return PdfSolidAngle(0.5f * kInvPi);
}
inline Point2 InvertUniformHemisphere(const Vector3& v) {
  return InvertUniformCone(v, 1);
}

// --- Triangle, uniform: barycentric coordinates, none negative, with little distortion ([Heitz19]).
inline Vector3 SampleUniformTriangle(const Point2& u) {
  const float half = 0.5f * std::min(u.x, u.y);
  return {u.x - half, u.y - half, 1 - std::max(u.x, u.y)};
}
inline PdfArea UniformTrianglePdf(float area) {
  return PdfArea(area > 0 ? 1 / area : 0.0f);
}
inline Point2 InvertUniformTriangle(const Vector3& barycentric) {
  const float sum = barycentric.x + barycentric.y;
  const float twice = 2 * std::min(barycentric.x, barycentric.y);
  return barycentric.y > barycentric.x ? Point2(warp_internal::ClampUnit(twice), warp_internal::ClampUnit(sum))
                                       : Point2(warp_internal::ClampUnit(sum), warp_internal::ClampUnit(twice));
}

}  // namespace lampyr
