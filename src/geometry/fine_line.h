// The line of a ray in double. In participating media distances may be far shorter than the rounding of positions: with
// a mean free path of 1e-6 scene units, a float at 1 resolves a tenth of it.
#pragma once

#include <limits>

#include "math/vec.h"

namespace lampyr {

// The straight line that a ray in float is to follow.
struct FineLine {
  Point3d start{0.0};
  Vector3d direction{0.0};  // unit, up to rounding
  double length = std::numeric_limits<double>::infinity();
  // True if the end is a point in space whose side of each surface matters within rounding. Otherwise surfaces within
  // rounding of an end are those that the ray in float hits, which is offset from the surface that it starts on.
  bool isFineAtStart = false, isFineAtEnd = false;
};

// Result of GeometryScene::Trace along a FineLine.
struct LineHit {
  bool isHit = false;
  bool isRejected = false;                             // GeometryScene::RejectedRays
  double t = std::numeric_limits<double>::infinity();  // of the hit, along the line
};

}  // namespace lampyr
