// Bounds of the exit pupil in the plane of the rear vertex, for rings of film points around the axis ([Steinert11];
// [Pharr23 §5.4.5]).
#pragma once

#include <optional>
#include <vector>

#include "camera/lens_system.h"

namespace lampyr {

// A rectangle in the plane of the rear vertex, mm, for film points at (radius, 0). For other film points it is rotated
// around the axis with them.
struct PupilBounds {
  double xMin = 0, xMax = 0, yMax = 0;  // y from -yMax to yMax

  double Area() const { return (xMax - xMin) * 2 * yMax; }
};

class ExitPupil {
 public:
  // Exit pupils of film points up to `filmRadius` (mm, > 0) from the axis. `lens` is in focus.
  ExitPupil(const LensSystem& lens, double filmRadius);

  // Bounds of the exit pupil for a film point at `radius` (mm); nullopt if no light reaches it.
  std::optional<PupilBounds> At(double radius) const;

 private:
  // The bounds at the inner radius of a ring, and their displacement along x per radius.
  struct Ring {
    std::optional<PupilBounds> bounds;
    double shift = 0;
  };

  double ringWidth_;
  std::vector<Ring> rings_;
};

}  // namespace lampyr
