// Sampling of the part of a sky that is visible through a portal, by tables in coordinates in which the portal is an
// axis-aligned window from every point ([Bitterli15]): with x and y along the portal's edges and z outwards,
// u = 1/2 + atan(x/z)/π and v = 1/2 + atan(y/z)/π; the unit square is the hemisphere of the sky.
#pragma once

#include <functional>

#include "lights/types/portal_place.h"
#include "lights/types/windowed_table.h"
#include "sampling/tables.h"

namespace lampyr {

class PortalTables {
 public:
  using Radiance = std::function<Color(const Vector3&)>;  // of a unit direction in render space

  PortalTables() = default;
  // `height`: rows of the sky's image, which determine the resolution. `mean`: of the radiance over the sphere, mean of
  // the channels, above 0.
  PortalTables(const PortalPlace& place, const Radiance& radiance, float mean, int height);

  // The window of the sky visible from a point; `share` is 0 if it is too small for differences of sums.
  struct Seen {
    WindowedTable::Window window;
    double share = 0;
  };
  Seen SeenFrom(const PortalView& view) const;
  // A direction, not of unit length, in the portal's axes.
  Vector3d Sample(const Seen& seen, const Point2& u) const { return FromSquare(direct_.Sample(seen.window, u)); }
  // 1/sr
  PdfSolidAngle Density(const Seen& seen, const Vector3d& inAxes) const;

  // Directions of photons, by radiance times cosine; towards the light, in the portal's axes.
  Vector3d SampleEmission(const Point2& u) const { return FromSquare(Point2d(emission_.Sample(u).uv)); }
  PdfSolidAngle EmissionDensity(const Vector3d& inAxes) const;

  // Irradiance through the portal, W/m².
  Color Flux() const { return flux_; }

  static Vector3d ToAxes(const PortalPlace& place, const Vector3d& v) {
    return {glm::dot(v, place.axisX), glm::dot(v, place.axisY), glm::dot(v, place.outward)};
  }
  static Vector3d FromAxes(const PortalPlace& place, const Vector3d& v) {
    return place.axisX * v.x + place.axisY * v.y + place.outward * v.z;
  }

 private:
  static Vector3d FromSquare(const Point2d& uv);
  static Point2d ToSquare(const Vector3d& inAxes);
  // dω / d(u,v) of the direction (x, y, 1).
  static double SolidAngleFactor(double x, double y);

  WindowedTable direct_;
  Distribution2D emission_;
  Color flux_;
};

}  // namespace lampyr
