// A lens of spherical surfaces around an axis: rays through it, its thick-lens approximation, and focusing
// ([Kolb95]; [Pharr23 §5.4]).
//
// Lens space: millimetres, the film at z = 0, the scene towards +z; x and y are the camera's.
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
  // `stopRadius`: mm; not above that of the prescription.
  LensSystem(const LensPrescription& lens, double stopRadius, Aperture aperture = {});

  struct Passed {
    LensRay ray;              // from the front surface on
    double transmission = 1;  // of the aperture
  };
  // A ray from the film through all surfaces; nullopt if it is vignetted or reflected totally.
  std::optional<Passed> Trace(LensRay ray) const;
  // Largest of (distance from the axis / radius of the aperture)² over all surfaces: up to 1 if the ray passes them.
  // Infinite for a ray that misses a sphere or is reflected totally.
  double Clearance(LensRay ray) const;

  // Of rays near the axis; nullopt if the lens has no power.
  std::optional<ThickLens> Approximation() const;
  // Moves the lens along the axis until what is `distance` (mm) from the film is in focus by the thick-lens
  // approximation; a lens without power stays where it is. Throws an Error if it cannot be focused there.
  void Focus(double distance);

  double RearZ() const { return surfaces_.front().z; }  // of the rear vertex
  double StopZ() const;
  // Radius around the axis, in the plane of the rear vertex, of all that rays from film points up to `filmRadius` away
  // from the axis may cross on their way to the rear surface.
  double RearReach(double filmRadius) const;

 private:
  struct Surface {
    double z = 0, curvature = 0;  // of the vertex; 1/mm, positive: the centre lies towards the film; 0: the stop
    double radius = 0;            // of the aperture
    double eta = 1;               // index on the film's side over that on the scene's
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
