// Cameras: generation of rays, and the importance they carry ([Veach97 §8.3.2.2]; [Pharr23 §5, §13 of the 3rd ed.]).
//
// Film coordinates are in pixels, with (0,0) the upper left corner of the full image. The importance We is normalised
// so that ∫∫ We cosθ dω dA over lens and full image equals the area of the image in pixels: the value of a pixel is the
// mean radiance over that pixel with the reconstruction filter, whichever technique estimates it. In particular
// - the density of a ray through a uniformly chosen film point is We cosθ / (width · height), the product of
//   pdfPosition and pdfDirection;
// - a connection from a surface point to the camera adds β · f · |cosθ at the point| · importance / pdfLensSolidAngle
//   per pixel² at its film point, with β the throughput of the light subpath.
//
// Delta distributions: with a pinhole the position is discrete (an integral over the lens is a sum of one term), with
// parallel rays the direction is. Their densities are then 1, and importance holds the coefficient of the delta.
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
  float weight = 1;  // factor on the radiance; 0: vignetted, and the ray (though valid) is not to be traced
};

// A connection of a light subpath to the camera (t = 1), with the quantities that its weight needs.
struct CameraConnection {
  Point3 position;       // on the lens
  Normal3 normal;        // of the lens; for the spherical camera, the viewing direction
  Point2 film;           // film point of the connection, pixels
  float importance = 0;  // We(position, direction), per pixel²
  // Density of choosing `position`, in solid angle at the connected point (1/sr). For a pinhole it is the discrete 1
  // times distance² / cosθ at the lens, so that importance / pdfLensSolidAngle holds for all cameras; with parallel
  // rays it is 1.
  float pdfLensSolidAngle = 1;
  bool isDelta = true;  // pinhole or parallel rays: no BSDF ray can hit the camera
};

struct CameraDensities {
  PdfArea pdfPosition;  // on the lens; 1 (discrete) for a pinhole
  // Density of the direction given the position, for a uniformly chosen film point of the full image; 1 (discrete) for
  // parallel rays.
  PdfSolidAngle pdfDirection;
  float importance = 0;  // We
};

// The region of space that the image shows: a pyramid, or all directions.
struct CameraView {
  Point3 place{0.0f};           // of the pinhole, or the centre of the lens
  std::vector<Vector3> planes;  // normals of planes through `place`, towards the image; empty: all directions
};

// Film points that have the same ray as another film point.
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
  // Film point, importance and densities of a ray that starts on the lens; nullopt outside of the image, or without
  // ConnectsLightPaths.
  virtual std::optional<CameraDensities> EvaluateRay(const Ray& ray, Point2* film) const = 0;
  // Connects `point` to a point of the lens; nullopt if the film does not see it, or without ConnectsLightPaths.
  virtual std::optional<CameraConnection> Connect(const Point3& point, const Point2& lens) const = 0;
  // Other film points within filmMargin that see the direction of `film`: a spherical image continues beyond an edge
  // with the content at another one. A connection contributes there as well, with the same weight.
  virtual FilmCopies CopiesOf(const Point2& /*film*/) const { return {}; }
  // False if the densities of rays that leave the lens are unknown, because they are refracted at several surfaces.
  // Light paths are then not connected to the camera (t = 1), no weight may include that technique, and rays have
  // weights.
  virtual bool ConnectsLightPaths() const { return true; }
  // Approximate solid angle of a pixel around `ray`, sr; for footprints without ConnectsLightPaths. 0: unknown.
  virtual double PixelSolidAngle(const Ray& /*ray*/) const { return 0; }
  // The region of space that the image shows. nullopt if there is no single place, because rays are parallel or are
  // refracted by elements of the lens.
  virtual std::optional<CameraView> View() const { return std::nullopt; }
  virtual bool HasPinhole() const = 0;                    // the lens is a point: a delta position
  virtual bool HasParallelRays() const { return false; }  // orthographic without a lens: a delta direction
  // True if Connect chooses a direction, which determines the position (orthographic); otherwise it chooses the
  // position. The density of a camera path to the point over that of the connection is pdfPosition · |cosθ| (area at
  // the point) if true, and pdfDirection · |cosθ| / distance² otherwise.
  virtual bool ConnectsByDirection() const { return false; }
};

struct PerspectiveSettings {
  Degrees fov{90};             // over the shorter side of the image, unless the screen window differs from the default
  float lensRadius = 0;        // camera-space units
  float focalDistance = 1e6f;  // camera-space units
};
// With a lens, each film point has a lens centred on it, so that the view remains orthographic; pbrt-v4 centres all
// lenses on the camera's origin.
struct OrthographicSettings {
  float lensRadius = 0;
  float focalDistance = 1e6f;
};
struct RealisticSettings {
  LensPrescription lens;
  double apertureDiameter = 1;  // mm; limited by the stop of the lens
  double focusDistance = 10;    // from the film, camera-space units, taken as metres
  double filmDiagonal = 35;     // mm
  Aperture aperture;            // shape of the stop
};
enum class SphericalMapping { EqualArea, EquiRectangular };

struct CameraFrame {
  Transform cameraToRender;                   // camera space: x right, y up, z forward (left-handed, as pbrt)
  int width = 1, height = 1;                  // of the full image, pixels
  Point2 screenMin{-1, -1}, screenMax{1, 1};  // screen window
  Vector2 filmMargin{0, 0};  // pixels of film beyond the image: the radius of the filter that weights splats
};

// The factories throw an Error for unusable settings: an empty image or screen window, a singular transform, a field of
// view outside of (0°, 180°), a negative lens radius, or a lens whose focal distance is not positive.

// pbrt's default screen window for an aspect ratio (width / height): the shorter side spans [-1,1].
void SetDefaultScreenWindow(CameraFrame& frame, float frameAspectRatio);

std::unique_ptr<Camera> MakePerspectiveCamera(const CameraFrame& frame, const PerspectiveSettings& settings);
std::unique_ptr<Camera> MakeOrthographicCamera(const CameraFrame& frame, const OrthographicSettings& settings);
// Ignores the screen window. Also throws an Error for a lens that cannot be focused at the focus distance, or that
// transmits no light.
std::unique_ptr<Camera> MakeRealisticCamera(const CameraFrame& frame, const RealisticSettings& settings);
std::unique_ptr<Camera> MakeSphericalCamera(const CameraFrame& frame, SphericalMapping mapping);

}  // namespace lampyr
