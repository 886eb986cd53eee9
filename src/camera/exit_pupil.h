// Where light leaves a lens towards a film point: bounds of the exit pupil in the plane of the rear vertex, for rings
// of film points around the axis ([Steinert11]; [Pharr23 §5.4.5]).
#pragma once

#include <optional>
#include <vector>

#include "camera/lens_system.h"

namespace lampyr {

// A rectangle of the plane, mm: for film points at (radius, 0). For others it is turned with them around the axis.
struct PupilBounds {
  double xMin = 0, xMax = 0, yMax = 0;  // y from -yMax to yMax

  double Area() const { return (xMax - xMin) * 2 * yMax; }
};

class ExitPupil {
 public:
  // Of film points up to `filmRadius` (mm, > 0) from the axis. `lens` is in focus.
  ExitPupil(const LensSystem& lens, double filmRadius);

  // Bounds of all that a film point at `radius` receives; nullopt: nothing.
  std::optional<PupilBounds> At(double radius) const;

 private:
  // The bounds at the ring's inner radius, and how far along x they move per length of the radius.
  struct Ring {
    std::optional<PupilBounds> bounds;
    double shift = 0;
  };

  double ringWidth_;
  std::vector<Ring> rings_;
};

}  // namespace lampyr
