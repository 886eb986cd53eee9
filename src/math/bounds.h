// Axis-aligned boxes and the bounding sphere of a scene.
#pragma once

#include "math/vec.h"

namespace lampyr {

// An axis-aligned box; empty (min > max) until a point or box is added.
template <class PointType>
struct BoundsOf {
  using Scalar = typename PointType::value_type;
  PointType min = PointType(std::numeric_limits<Scalar>::infinity());
  PointType max = PointType(-std::numeric_limits<Scalar>::infinity());

  bool IsEmpty() const { return !(min.x <= max.x && min.y <= max.y && min.z <= max.z); }
  void Add(const PointType& p) {
    min = glm::min(min, p);
    max = glm::max(max, p);
  }
  void Add(const BoundsOf& b) {
    if (b.IsEmpty()) return;
    Add(b.min);
    Add(b.max);
  }
  PointType Center() const { return min * Scalar(0.5) + max * Scalar(0.5); }
  PointType Diagonal() const { return max - min; }
  PointType Corner(int i) const { return {i & 1 ? max.x : min.x, i & 2 ? max.y : min.y, i & 4 ? max.z : min.z}; }
};

using Bounds3 = BoundsOf<Point3>;
using Bounds3d = BoundsOf<Point3d>;

// Bounding sphere of a scene, for lights at infinity.
struct BoundingSphere {
  Point3 center{0.0f};
  float radius = 1;  // > 0, also for an empty scene
};

}  // namespace lampyr
