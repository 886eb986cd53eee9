#include "lights/cone_bound.h"

#include <array>

#include "lights/direction_map.h"
#include "math/frame.h"
#include "sampling/warp.h"

namespace lampyr {

void SetConeBounds(const LightTransform& transform, const Vector3& axis, float w, EmissionBounds& bounds) {
  bounds.axis = ToRenderDirection(transform, axis);
  bounds.cosThetaO = 1;
  bounds.cosThetaE = 1 - w;
  if (IsSimilarity(transform.toRender.linear)) return;
  // A convex cone stays one: its widest direction lies on the rim. Beyond 90° nothing is promised.
  if (w >= 1) {
    bounds.cosThetaE = -1;
    return;
  }
  const Frame frame = Frame::FromNormal(axis);
  const float r = SafeSqrt(w * (2 - w));
  float widest = 0;
  for (int i = 0; i < 256; ++i) {
    const Vector2 around = CosSinTurns(static_cast<float>(i) / 256);
    const Vector3 rim = ToRenderDirection(transform, frame.ToWorld({r * around.x, r * around.y, 1 - w}));
    widest = std::max(widest, AngleBetween(rim, bounds.axis));
  }
  bounds.cosThetaE = std::cos(std::min(1.01f * widest, kPi));
}

// In local space, where the ray is x(t) = o + t d with the light's point as origin: inside while (x·a)² ≥ cos² |x|² and
// x·a ≥ 0.
bool ClipToCone(const LightTransform& transform, const Point3& from, const Vector3& axis, float w, const Point3& origin,
                const Vector3& direction, float& minT, float& maxT) {
  const double cosine = static_cast<double>(1 - w) - 1e-4;
  if (cosine <= 0) return true;
  const Vector3d o(transform.toLocal.Point(origin) - from), d(transform.toLocal.Vector(direction)), a(axis);
  const double da = glm::dot(d, a), oa = glm::dot(o, a), c2 = cosine * cosine;
  const double A = da * da - c2 * glm::dot(d, d), B = da * oa - c2 * glm::dot(o, d), C = oa * oa - c2 * glm::dot(o, o);
  const double low = static_cast<double>(minT), high = static_cast<double>(maxT);
  std::array<double, 4> knots = {low, low, high, high};
  const double discriminant = B * B - A * C;
  if (discriminant > 0) {
    const double q = -(B + std::copysign(std::sqrt(discriminant), B));
    knots[1] = std::clamp(q != 0 ? C / q : low, low, high);
    knots[2] = std::clamp(A != 0 ? q / A : high, low, high);
    if (knots[1] > knots[2]) std::swap(knots[1], knots[2]);
  }
  double first = high, last = low;
  for (size_t i = 0; i < 3; ++i) {
    if (!(knots[i] < knots[i + 1])) continue;
    const double t = std::isinf(knots[i + 1]) ? 2 * (knots[i] + 1 / glm::length(d)) : 0.5 * (knots[i] + knots[i + 1]);
    if (A * t * t + 2 * B * t + C < 0 || oa + t * da < 0) continue;
    first = std::min(first, knots[i]);
    last = std::max(last, knots[i + 1]);
  }
  if (!(first < last)) return false;
  minT = static_cast<float>(first);
  maxT = static_cast<float>(last);
  return true;
}

}  // namespace lampyr
