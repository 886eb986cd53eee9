// A lens of spherical surfaces around an axis: tracing of rays, thick-lens approximation and focusing ([Kolb95];
// [Pharr23 §5.4]).
//
// Lens space: millimetres, the film at z = 0, the scene towards +z; x and y are those of the camera.
#pragma once

#include <optional>
#include <vector>

#include "camera/aperture.h"
#include "camera/lens_file.h"

namespace lampyr {

struct LensRay {
  Point3d origin;
  Vector3d direction;  // unit, towards +z
};

struct ThickLens {
  double focalLength = 0;                        // mm
  double frontPrincipal = 0, rearPrincipal = 0;  // planes, z
};

class LensSystem {
 public:
  // `stopRadius`: mm; at most that of the prescription.
  LensSystem(const LensPrescription& lens, double stopRadius, Aperture aperture = {});

  struct Passed {
    LensRay ray;              // behind the front surface
    double transmission = 1;  // of the aperture
  };
  // Traces a ray from the film through all surfaces; nullopt if it is vignetted or totally reflected.
  std::optional<Passed> Trace(LensRay ray) const;
  // Maximum over all surfaces of (distance from the axis / radius of the aperture)²: at most 1 if the ray passes.
  // Infinite for a ray that misses a sphere or is totally reflected.
  double Clearance(LensRay ray) const;

  // Paraxial approximation; nullopt if the lens has no power.
  std::optional<ThickLens> Approximation() const;
  // Moves the lens along the axis so that objects at `distance` (mm) from the film are in focus by the thick-lens
  // approximation; a lens without power stays where it is. Throws an Error if the lens cannot be focused there.
  void Focus(double distance);

  double RearZ() const { return surfaces_.front().z; }  // of the rear vertex
  double StopZ() const;
  // Radius around the axis, in the plane of the rear vertex, that contains all rays from film points up to `filmRadius`
  // from the axis to the rear surface.
  double RearReach(double filmRadius) const;

 private:
  struct Surface {
    double z = 0, curvature = 0;  // of the vertex; 1/mm, positive: centre towards the film, 0: the stop
    double radius = 0;            // of the aperture
    double eta = 1;               // index on the side of the film over that on the side of the scene
    bool isStop = false;
  };

  static bool Meet(const Surface& surface, LensRay& ray, Vector3d& normal);
  static bool Refract(const Surface& surface, const Vector3d& normal, LensRay& ray);
  double RearZInFocus(double distance) const;
  void Place(double rearZ);

  LensPrescription lens_;
  Aperture aperture_;
  double inverseStopRadius_;
  std::vector<Surface> surfaces_;  // from the film to the scene
};

}  // namespace lampyr
