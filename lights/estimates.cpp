#include "lights/estimates.h"

namespace lampyr {

namespace {

constexpr float kSmallestCosine = 1e-3f;

// The bounds of nearly all surfaces have a cosine of 1 or 0.
float AngleOf(float cosine) {
  if (cosine >= 1) return 0;
  return cosine == 0 ? 0.5f * kPi : std::acos(std::max(cosine, -1.0f));
}

// An upper bound of the cosine that any normal of the emitter makes with the way to a point, or to points no nearer; 0
// when all normals face away. `axisCosine`: of the way from the box's middle with the axis.
float BoundCosine(const EmissionBounds& bounds, float axisCosine, float distanceSquared, float radiusSquared) {
  if (distanceSquared <= radiusSquared || bounds.cosThetaO <= -1) return 1;
  const float cosine = bounds.twoSided ? std::abs(axisCosine) : axisCosine;
  const float angle = std::acos(std::clamp(cosine, -1.0f, 1.0f));
  const float spread =
      AngleOf(bounds.cosThetaO) + std::asin(std::sqrt(std::min(radiusSquared / distanceSquared, 1.0f)));
  // A little slack for the rounding of the three angles.
  const float least = std::max(0.0f, angle - spread - 1e-3f);
  return least < AngleOf(bounds.cosThetaE) ? std::max(std::cos(least), kSmallestCosine) : 0.0f;
}

// Irradiance at a distance from the middle of the box, with the bound of the cosine.
float IrradianceOf(const EmissionBounds& bounds, float power, float cosine, float distanceSquared,
                   float radiusSquared) {
  if (cosine == 0) return 0;
  const float squared = std::max(std::max(distanceSquared, radiusSquared), std::numeric_limits<float>::min());
  const float irradiance = power * kInvPi * (bounds.twoSided ? 0.5f : 1.0f) * cosine / squared;
  return std::clamp(irradiance, std::numeric_limits<float>::min(), std::numeric_limits<float>::max());
}

// Cuts [minT, maxT] to the side of the plane (point, normal) that the normal points to. False when nothing is left.
bool ClipToFront(const Point3& origin, const Vector3& direction, float height, const Normal3& normal, float& minT,
                 float& maxT) {
  // The direction is rounded: its error in height grows with t.
  constexpr float kSlopeError = 1e-5f;
  const float start = glm::dot(origin, normal) - height;
  const float slope = glm::dot(direction, normal) + kSlopeError;
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
  const float axisCosine = glm::dot(bounds.axis, toPoint) / std::sqrt(distanceSquared);
  const float cosine = BoundCosine(bounds, axisCosine, distanceSquared, radiusSquared);
  return IrradianceOf(bounds, power, cosine, distanceSquared, radiusSquared);
}

std::optional<SegmentEstimate> SurfaceSegmentEstimate(const EmissionBounds& bounds, float power, const Point3& origin,
                                                      const Vector3& direction, float length) {
  if (!(power > 0) || bounds.box.IsEmpty()) return std::nullopt;
  SegmentEstimate estimate{0, 0, length};
  if (!bounds.twoSided && bounds.cosThetaO > 0.999999f) {
    // Flat: the plane through the box's lowest corner, lowered by what normals within θo may tilt it and by rounding.
    const Vector3 diagonal = bounds.box.Diagonal(), steep = Abs(Vector3(bounds.axis));
    float height = glm::dot(bounds.axis, bounds.box.Center()) - 0.5f * glm::dot(steep, diagonal);
    height -= 2e-3f * glm::length(bounds.box.Diagonal()) + 1e-5f * (std::abs(height) + MaxAbsComponent(origin));
    if (!ClipToFront(origin, direction, height, bounds.axis, estimate.minT, estimate.maxT)) return std::nullopt;
  }
  const Point3 center = bounds.box.Center();
  const float t = NearestOnSegment(origin, direction, estimate.minT, estimate.maxT, center);
  const Vector3d from(origin + estimate.minT * direction - center), along(direction), axis(bounds.axis);
  const double lit = static_cast<double>(estimate.maxT) - static_cast<double>(estimate.minT);
  double axisCosine = LargestCosine(axis, from, along, lit);
  if (bounds.twoSided) axisCosine = std::max(axisCosine, LargestCosine(-axis, from, along, lit));
  const float distanceSquared = LengthSquared(origin + t * direction - center);
  const float radiusSquared = 0.25f * LengthSquared(bounds.box.Diagonal());
  const float cosine = BoundCosine(bounds, static_cast<float>(axisCosine), distanceSquared, radiusSquared);
  estimate.radiance =
      std::max(IrradianceOf(bounds, power, cosine, distanceSquared, radiusSquared), std::numeric_limits<float>::min());
  return estimate;
}

// With x along the line from the foot of the origin at distance D, it is (a + b x)/√(D² + x²): the maximum over the
// line is at x = b D²/a, if a is positive.
double LargestCosine(const Vector3d& n, const Vector3d& from, const Vector3d& along, double length) {
  const double start = glm::dot(from, along);
  const Vector3d across = from - start * along;
  const double a = glm::dot(n, across), b = glm::dot(n, along), distance2 = glm::dot(across, across);
  const auto at = [&](double x) {
    const double squared = distance2 + x * x;
    return squared > 0 ? (a + b * x) / std::sqrt(squared) : glm::length(n);
  };
  double largest = std::max(at(start), std::isinf(length) ? b : at(start + length));
  const double best = a > 0 ? b * distance2 / a : start;
  if (best > start && best < start + length) largest = std::max(largest, at(best));
  return std::min(largest, glm::length(n));
}

// The angle between the vectors (start, distance) and (start + length, distance); for an infinite length, its limit.
double SegmentAngle(double distance, double start, double length) {
  if (std::isinf(length)) return std::atan2(distance, start);
  return std::atan2(distance * length, distance * distance + start * (start + length));
}

}  // namespace lampyr
