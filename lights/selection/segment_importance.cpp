#include "lights/selection/segment_importance.h"

#include <algorithm>
#include <cmath>

#include "lights/estimates.h"

namespace lampyr {

using namespace importance;

namespace {

// A part of the segment's line, as seen from the mean of a cluster.
struct View {
  Vector3d from, along;    // start of the part, relative to the mean; direction
  double start, length;    // start relative to the foot of the mean; length may be infinite
  double distance2;        // squared distance of the mean from the line
  double nearest, least2;  // coordinate of the nearest point, relative to the foot; its squared distance

  View(const ClusterLobe& lobe, const TreeSegment& segment, double minT, double maxT)
      : from(Point3d(segment.base) - Point3d(lobe.mean) + (segment.start + minT) * segment.direction),
        along(segment.direction),
        start(glm::dot(from, along)),
        length(maxT - minT) {
    const Vector3d across = from - start * along;
    distance2 = glm::dot(across, across);
    nearest = std::clamp(0.0, start, start + length);
    least2 = distance2 + nearest * nearest;
  }

  // ∫ dx / d² over the part, where squared distances are at least `floor` at the nearest point.
  double InverseSquares(double floor) const {
    const double distance = std::sqrt(std::max({distance2, floor - nearest * nearest, static_cast<double>(kNearest2)}));
    return SegmentAngle(distance, start, length) / distance;
  }
};

}  // namespace

SegmentImportance ImportanceAlong(const ClusterLobe& lobe, const TreeSegment& segment) {
  if (!(lobe.intensity > 0) || !(segment.length > 0)) return {};
  const View view(lobe, segment, 0, segment.length);
  const Vector3d normal(lobe.meanNormal);
  double cosine = LargestCosine(normal, view.from, view.along, view.length);
  if (lobe.twoSided) cosine = std::max(cosine, LargestCosine(-normal, view.from, view.along, view.length));
  const double least = std::sqrt(view.least2), radius = static_cast<double>(lobe.radius);
  constexpr double kSlackOfBoth = 2 * static_cast<double>(kSlack);  // this cosine is rounded otherwise than a point's
  if (least > radius &&
      cosine < static_cast<double>(lobe.coneCosine) - static_cast<double>(lobe.coneReach) / least - kSlackOfBoth) {
    return {};
  }
  const auto variance = static_cast<double>(lobe.variance);
  const double floor = std::max(static_cast<double>(kInside) * variance, static_cast<double>(kNearest2));
  const double spread = std::min(variance / std::max(view.least2, floor), 1.0);
  if (view.least2 < floor) cosine = std::max(cosine, 0.0);  // within the cluster, cosines shrink towards 0
  const double unevenness = std::max(1 - glm::dot(normal, normal), 0.0);
  const double root = std::sqrt(cosine * cosine + static_cast<double>(kSpread) * std::min(unevenness + spread, 1.0));
  const double emitted = std::max(0.5 * (lobe.twoSided ? root : root + cosine), static_cast<double>(kLeast));
  return {static_cast<double>(lobe.intensity) * emitted * view.InverseSquares(floor), spread};
}

double OwnImportanceAlong(const ClusterLobe& lobe, const TreeSegment& segment, double irradiance, double minT,
                          double maxT) {
  if (!(irradiance > 0) || !(minT < maxT)) return 0;
  const View view(lobe, segment, minT, maxT);
  const auto radius = static_cast<double>(lobe.radius);
  const double floor = std::max(radius * radius, static_cast<double>(kNearest2));
  return irradiance * std::max(view.least2, floor) * view.InverseSquares(floor);
}

}  // namespace lampyr
