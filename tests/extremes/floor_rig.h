// The rig of most cases: a floor of reflectance 0.5 in the plane y = 0, a square patch of it seen from straight above
// by an orthographic camera that stands between it and the light. The image's mean is ρ/π times the mean irradiance.
#pragma once

#include <cmath>
#include <functional>
#include <string>

#include "math/vec.h"

namespace lampyr::test {

struct FloorRig {
  double half = 0.5;             // of the patch's side
  double eye = 0.1;              // height of the camera over the floor
  double extent = 20;            // half of the floor's side, around the patch
  Point3d middle{0.3, 0, -0.2};  // of the patch
  Point3d origin{0.0};           // where all of it is: of the light as well
  int places = 32;               // along a side, of the quadrature of expected values
  int pixels = 4;                // along a side of the image
  std::string material = "Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5]\n";
  double turn = 0;     // degrees by which all of it is turned, around no particular axis
  std::string camera;  // instead of an orthographic one that sees the patch
  std::string film;    // further parameters
  std::string floor;   // instead of a bilinear patch: statements, for a floor at the origin of its own space

  // Scene text; `world` are the lights and what stands about, placed at `origin`.
  std::string Scene(const std::string& world, int maxDepth = 1) const;
  // Radiance of the patch, for an irradiance (W/m²) that depends on the place (relative to `origin`).
  double Radiance(const std::function<double(const Point3d&)>& irradiance) const;
};

// Irradiance at P, facing +y, of a rectangle of radiance L that faces it from above, by quadrature over the rectangle:
// from `corner`, with sides u and v. Emission on the side of u × v.
double RectangleIrradiance(const Point3d& P, const Point3d& corner, const Vector3d& u, const Vector3d& v,
                           int cells = 64);

}  // namespace lampyr::test
