#include "lights/services/equiangular.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "lights/estimates.h"

namespace lampyr {

EquiangularDistance::EquiangularDistance(const Point3& origin, const Vector3& direction, const Point3& apex, float tMin,
                                         float tMax)
    : tMin_(tMin), tMax_(tMax) {
  const Vector3d toApex = Point3d(apex) - Point3d(origin), along(direction);
  foot_ = glm::dot(toApex, along);
  // The density must not vary between neighbouring floats: D is at least a hundred times their spacing around the foot.
  // For an apex at the very origin, a part of the range.
  constexpr double kSpacing = 0x1p-16, kOfRange = 0x1p-40, kLeast = 1e-30;
  const double range = static_cast<double>(tMax) - static_cast<double>(tMin);
  distance_ = std::max(
      {glm::length(toApex - foot_ * along), kSpacing * std::abs(foot_), kOfRange * std::min(range, 1e10), kLeast});
  start_ = static_cast<double>(tMin) - foot_;
  if (range > 0) angle_ = SegmentAngle(distance_, start_, range);
}

float EquiangularDistance::Sample(float u) const {
  const double angle = static_cast<double>(u) * angle_, cosine = std::cos(angle), sine = std::sin(angle);
  const double above = (distance_ * distance_ + start_ * start_) * sine, below = distance_ * cosine - start_ * sine;
  // Rounding may lead below 0 at the end of a range without an end.
  const double length = below > 0 ? above / below : std::numeric_limits<double>::max();
  const double most = std::min(static_cast<double>(tMax_), static_cast<double>(std::numeric_limits<float>::max()));
  return std::clamp(static_cast<float>(std::min(static_cast<double>(tMin_) + length, most)), tMin_, tMax_);
}

PdfDistance EquiangularDistance::Density(float t) const {
  if (IsEmpty() || !(t >= tMin_ && t <= tMax_)) return PdfDistance(0);
  const double x = static_cast<double>(t) - foot_;
  return PdfDistance(static_cast<float>(distance_ / (angle_ * (distance_ * distance_ + x * x))));
}

double EquiangularDistance::Invert(float t) const {
  if (IsEmpty()) return 0;
  const double length = static_cast<double>(t) - static_cast<double>(tMin_);
  return std::clamp(SegmentAngle(distance_, start_, length) / angle_, 0.0, 1.0);
}

}  // namespace lampyr
