// Cameras: where rays start, and the importance they carry ([Veach97 §8.3.2.2]; [Pharr23 §5, §13 of the 3rd ed.]).
//
// Film coordinates are pixels, (0,0) the upper left corner of the full image. The importance We is normalised so that
// ∫∫ We cosθ dω dA over lens and full image equals the image's area in pixels: a measured pixel value is the mean
// radiance over that pixel with the reconstruction filter, whichever technique estimates it. In particular
//   - a ray through a uniformly chosen film point has the density We cosθ / (width · height) = pdfPosition ·
//   pdfDirection;
//   - a connection from a surface point to the camera adds β · f · |cosθ at the point| · importance / pdfLensSolidAngle
//     per pixel² at its film point, β being the throughput of the light subpath.
// Deltas: with a pinhole the position is discrete (an integral over the lens is a sum of one term), with parallel rays
// the direction is; the densities then are 1 and importance holds the coefficient of the delta.
#pragma once

#include <array>
#include <memory>
#include <optional>

#include "camera/aperture.h"
#include "camera/lens_file.h"
#include "geometry/ray.h"
#include "math/angle.h"
#include "math/density.h"
#include "math/transform.h"

namespace lampyr {

struct CameraRay {
  Ray ray;
  float weight = 1;  // multiplies the radiance found; 0: vignetted, and the ray, though valid, is not to be traced
};

// What a light subpath needs to connect to the camera, and a camera path to weigh that connection.
struct CameraConnection {
  Point3 position;       // on the lens
  Normal3 normal;        // of the lens; for the spherical camera, the direction of viewing
  Point2 film;           // pixel coordinates where the connection lands
  float importance = 0;  // We(position, direction), per pixel² (see above)
  // Density of having chosen `position`, as a solid angle seen from the point: 1/sr. For a pinhole the discrete 1 times
  // distance² / cosθ at the lens, so that importance / pdfLensSolidAngle is right for all cameras; 1 with parallel
  // rays.
  float pdfLensSolidAngle = 1;
  bool isDelta = true;  // no BSDF ray from the point can hit the camera: a pinhole, or parallel rays
};

struct CameraDensities {
  PdfArea pdfPosition;         // on the lens; 1 (discrete) for a pinhole
  PdfSolidAngle pdfDirection;  // of the ray given its position, for a uniformly chosen film point of the full image; 1
                               // (discrete) if parallel
  float importance = 0;        // We
};

// Film points that see along the same ray as another one.
struct FilmCopies {
  static constexpr int kMost = 8;
  std::array<Point2, kMost> points;
  int count = 0;
};

class Camera {
 public:
  virtual ~Camera() = default;
  // The ray through a film point; `lens` in [0,1)², `time` in [0,1].
  virtual CameraRay GenerateRay(const Point2& film, const Point2& lens, float time) const = 0;
  // Film point, importance and densities of a ray that starts on the lens; nullopt when outside of the image, or
  // without ConnectsLightPaths.
  virtual std::optional<CameraDensities> EvaluateRay(const Ray& ray, Point2* film) const = 0;
  // Connects `point` to a point of the lens; nullopt when it is not seen by the film, or without ConnectsLightPaths.
  virtual std::optional<CameraConnection> Connect(const Point3& point, const Point2& lens) const = 0;
  // A spherical image goes on beyond its edges, with what lies at another edge: where else, within the film's margin,
  // the direction that `film` sees is seen. A connection lands there, too, with the same weight.
  virtual FilmCopies CopiesOf(const Point2& /*film*/) const { return {}; }
  // False: the densities with which rays leave the lens are not known, because they have come through many surfaces.
  // Then no light path is connected to the camera (t = 1), no weight may count that technique, and rays have weights of
  // their own.
  virtual bool ConnectsLightPaths() const { return true; }
  // Solid angle that a pixel sees around `ray`, steradian, about: without ConnectsLightPaths, for footprints. 0:
  // unknown.
  virtual double PixelSolidAngle(const Ray& /*ray*/) const { return 0; }
  virtual bool HasPinhole() const = 0;                    // the lens is a point: a delta position
  virtual bool HasParallelRays() const { return false; }  // orthographic without a lens: a delta direction
  // Connect chooses its direction, and the position follows (orthographic); elsewhere it chooses the position. A ray's
  // density as a path over that of the connection is pdfPosition · |cosθ| per area at the point, or pdfDirection ·
  // |cosθ| / distance².
  virtual bool ConnectsByDirection() const { return false; }
};

struct PerspectiveSettings {
  Degrees fov{90};             // over the shorter side of the image unless the screen window says otherwise
  float lensRadius = 0;        // camera-space units
  float focalDistance = 1e6f;  // camera-space units
};
// With a lens every film point has a lens of its own around it, so that the view stays orthographic; pbrt-v4 puts all
// of them around the camera's origin.
struct OrthographicSettings {
  float lensRadius = 0;
  float focalDistance = 1e6f;
};
struct RealisticSettings {
  LensPrescription lens;
  double apertureDiameter = 1;  // mm; the lens's own stop limits it
  double focusDistance = 10;    // from the film, camera-space units, which are metres
  double filmDiagonal = 35;     // mm
  Aperture aperture;            // shape of the stop
};
enum class SphericalMapping { EqualArea, EquiRectangular };

struct CameraFrame {
  Transform cameraToRender;                   // camera space: x right, y up, z forward (left-handed, as pbrt)
  int width = 1, height = 1;                  // of the full image, pixels
  Point2 screenMin{-1, -1}, screenMax{1, 1};  // screen window
  Vector2 filmMargin{
      0, 0};  // pixels by which the film sees beyond the image: the radius of a filter that splats are weighed with
};

// The factories throw an Error for settings that make no camera: an empty image or screen window, a singular transform,
// a field of view outside of (0°, 180°), a negative lens radius, or a lens whose focal distance is not positive.

// pbrt's default screen window for an aspect ratio (width / height): the shorter side spans [-1,1].
void SetDefaultScreenWindow(CameraFrame& frame, float frameAspectRatio);

std::unique_ptr<Camera> MakePerspectiveCamera(const CameraFrame& frame, const PerspectiveSettings& settings);
std::unique_ptr<Camera> MakeOrthographicCamera(const CameraFrame& frame, const OrthographicSettings& settings);
// The screen window has no meaning here. Throws an Error also for a lens that makes no image of what is at the focus
// distance, or lets no light through.
std::unique_ptr<Camera> MakeRealisticCamera(const CameraFrame& frame, const RealisticSettings& settings);
std::unique_ptr<Camera> MakeSphericalCamera(const CameraFrame& frame, SphericalMapping mapping);

}  // namespace lampyr
