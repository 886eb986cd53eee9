#include "lights/estimates.h"

namespace lampyr {

namespace {

constexpr float kSmallestCosine = 1e-3f;

// An upper bound of the cosine that any normal of the emitter makes with the way to a point at `toPoint` from the box's
// middle; 0 when all normals face away.
float BoundCosine(const EmissionBounds& bounds, const Vector3& toPoint, float distanceSquared, float radiusSquared) {
  if (distanceSquared <= radiusSquared || bounds.cosThetaO <= -1) return 1;
  float cosine = glm::dot(bounds.axis, toPoint) / std::sqrt(distanceSquared);
  if (bounds.twoSided) cosine = std::abs(cosine);
  const float angle = std::acos(std::clamp(cosine, -1.0f, 1.0f));
  const float spread = std::acos(std::clamp(bounds.cosThetaO, -1.0f, 1.0f)) +
                       std::asin(std::sqrt(std::min(radiusSquared / distanceSquared, 1.0f)));
  // A little slack for the rounding of the three angles.
  const float least = std::max(0.0f, angle - spread - 1e-3f);
  return least < std::acos(std::clamp(bounds.cosThetaE, -1.0f, 1.0f)) ? std::max(std::cos(least), kSmallestCosine)
                                                                      : 0.0f;
}

// Cuts [minT, maxT] to the side of the plane (point, normal) that the normal points to. False when nothing is left.
bool ClipToFront(const Point3& origin, const Vector3& direction, float height, const Normal3& normal, float& minT,
                 float& maxT) {
  const float start = glm::dot(origin, normal) - height;
  const float slope = glm::dot(direction, normal);
  if (slope == 0) return start >= 0;
  const float t = -start / slope;
  if (slope > 0) {
    minT = std::max(minT, t);
  } else {
    maxT = std::min(maxT, t);
  }
  return minT < maxT;
}

}  // namespace

float SurfaceIrradianceEstimate(const EmissionBounds& bounds, float power, const Point3& P) {
  if (!(power > 0) || bounds.box.IsEmpty()) return 0;
  const Vector3 toPoint = P - bounds.box.Center();
  const float radiusSquared = 0.25f * LengthSquared(bounds.box.Diagonal());
  const float distanceSquared = LengthSquared(toPoint);
  const float cosine = BoundCosine(bounds, toPoint, distanceSquared, radiusSquared);
  if (cosine == 0) return 0;
  const float squared = std::max(std::max(distanceSquared, radiusSquared), std::numeric_limits<float>::min());
  const float irradiance = power * kInvPi * (bounds.twoSided ? 0.5f : 1.0f) * cosine / squared;
  return std::clamp(irradiance, std::numeric_limits<float>::min(), std::numeric_limits<float>::max());
}

std::optional<SegmentEstimate> SurfaceSegmentEstimate(const EmissionBounds& bounds, float power, const Point3& origin,
                                                      const Vector3& direction, float length) {
  if (!(power > 0) || bounds.box.IsEmpty()) return std::nullopt;
  SegmentEstimate estimate{0, 0, length};
  if (!bounds.twoSided && bounds.cosThetaO > 0.999999f) {
    // Flat: the plane through the box's lowest corner, lowered by what normals within θo may tilt it and by rounding.
    float height = kInfinity;
    for (int i = 0; i < 8; ++i) height = std::min(height, glm::dot(bounds.axis, bounds.box.Corner(i)));
    height -=
        2e-3f * glm::length(bounds.box.Diagonal()) + 1e-5f * (std::abs(height) + MaxAbsComponent(origin) + length);
    if (!ClipToFront(origin, direction, height, bounds.axis, estimate.minT, estimate.maxT)) return std::nullopt;
  }
  const float t = NearestOnSegment(origin, direction, estimate.minT, estimate.maxT, bounds.box.Center());
  estimate.radiance =
      std::max(SurfaceIrradianceEstimate(bounds, power, origin + t * direction), std::numeric_limits<float>::min());
  return estimate;
}

}  // namespace lampyr
