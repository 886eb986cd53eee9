// Importance of a cluster of emitters for a segment of a ray in a medium: an estimate of the cluster's light that the
// medium scatters into the ray. The light tree selects in proportion to it.
//
// It is ∫ I/d² dt over the segment, which is the angle under which the cluster sees the segment, over its distance from
// the line, times the largest cosine that the cluster has towards any point of the segment. Equiangular sampling leaves
// just this integral as the weight of a sample ([Kulla12]). Importance is 0 only for clusters from which no point of
// the segment receives light.
#pragma once

#include "lights/selection/importance.h"

namespace lampyr {

// A segment in the tree's coordinates: base + x direction, with x in [start, start + length]. The base is the point of
// the line nearest to the tree's centre, so that a segment from far away is known accurately among the emitters.
struct TreeSegment {
  Point3 base{0.0f};
  Vector3d direction{0, 0, 1};  // unit to double precision
  double start = 0;             // x of the segment's origin
  double length = 0;            // may be infinite

  TreeSegment(const Point3d& origin, const Vector3& along, double distance)
      : direction(Vector3d(along) / glm::length(Vector3d(along))),
        start(glm::dot(origin, direction)),
        length(distance) {
    base = Point3(origin - start * direction);
  }
};

struct SegmentImportance {
  // At least half of the integral of Importance() along the segment, at receivers without a normal; 0 only if that is 0
  // everywhere.
  double value = 0;
  double spread = 0;  // variance of positions over the least squared distance, at most 1
};
// The readable version, for one cluster; segment_importance_lanes.h evaluates eight at a time.
SegmentImportance ImportanceAlong(const ClusterLobe& lobe, const TreeSegment& segment);

// Importance of one emitter by the estimate of its light: `irradiance` in units of Importance(), at the point of
// [minT, maxT] nearest to the lobe's mean.
double OwnImportanceAlong(const ClusterLobe& lobe, const TreeSegment& segment, double irradiance, double minT,
                          double maxT);

// The emitters of a tree, as seen from one segment.
class SegmentEmitters {
 public:
  virtual ~SegmentEmitters() = default;
  // OwnImportanceAlong of an emitter; 0: its light does not reach the segment.
  virtual double ImportanceOf(uint32_t emitter, const ClusterLobe& lobe) const = 0;
};

}  // namespace lampyr
