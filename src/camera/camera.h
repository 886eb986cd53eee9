// Cameras: where rays start, and the importance they carry ([Veach97 §8.3.2.2]; [Pharr23 §5, §13 of the 3rd ed.]).
//
// Film coordinates are pixels, (0,0) the upper left corner of the full image. The importance We is normalised so that
// ∫∫ We cosθ dω dA over lens and full image equals the image's area in pixels: a measured pixel value is the mean
// radiance over that pixel with the reconstruction filter, whichever technique estimates it.
#pragma once

#include <memory>
#include <optional>

#include "geometry/ray.h"
#include "math/angle.h"
#include "math/density.h"
#include "math/transform.h"

namespace lampyr {

struct CameraRay {
  Ray ray;
  float weight = 1;  // multiplies the radiance found (1 for all cameras with exact sampling)
};

// What a light subpath needs to connect to the camera, and a camera path to weigh that connection.
struct CameraConnection {
  Point3 position;           // on the lens
  Normal3 normal;            // of the lens; for the spherical camera, the direction of viewing
  Point2 film;               // pixel coordinates where the connection lands
  float importance = 0;      // We(position, direction), per pixel² (see above)
  float pdfLensSolidAngle = 1;  // density of having chosen `position` on the lens seen from the point: 1/sr; 1 for a pinhole (isDelta)
  bool isDelta = true;       // the lens is a point
};

struct CameraDensities {
  PdfArea pdfPosition;             // on the lens; 1 (discrete) for a pinhole
  PdfSolidAngle pdfDirection;      // of the ray given its position, for a uniformly chosen film point of the full image
  float importance = 0;            // We
};

class Camera {
 public:
  virtual ~Camera() = default;
  // The ray through a film point; `lens` in [0,1)², `time` in [0,1].
  virtual CameraRay GenerateRay(const Point2& film, const Point2& lens, float time) const = 0;
  // Film point, importance and densities of a ray that starts on the lens; nullopt when outside of the image.
  virtual std::optional<CameraDensities> EvaluateRay(const Ray& ray, Point2* film) const = 0;
  // Connects `point` to a point of the lens; nullopt when it is not seen by the film.
  virtual std::optional<CameraConnection> Connect(const Point3& point, const Point2& lens) const = 0;
  virtual bool HasPinhole() const = 0;  // the lens is a point: a delta position
};

struct PerspectiveSettings {
  Degrees fov{90};             // over the shorter side of the image unless the screen window says otherwise
  float lensRadius = 0;        // camera-space units
  float focalDistance = 1e6f;  // camera-space units
};
struct OrthographicSettings {
  float lensRadius = 0;
  float focalDistance = 1e6f;
};
enum class SphericalMapping { EqualArea, EquiRectangular };

struct CameraFrame {
  Transform cameraToRender;      // camera space: x right, y up, z forward (left-handed, as pbrt)
  int width = 1, height = 1;     // of the full image, pixels
  Point2 screenMin{-1, -1}, screenMax{1, 1};  // screen window
};

// pbrt's default screen window for the given image: the shorter side spans [-1,1].
void SetDefaultScreenWindow(CameraFrame& frame, float frameAspectRatio);

std::unique_ptr<Camera> MakePerspectiveCamera(const CameraFrame& frame, const PerspectiveSettings& settings);
std::unique_ptr<Camera> MakeOrthographicCamera(const CameraFrame& frame, const OrthographicSettings& settings);
std::unique_ptr<Camera> MakeSphericalCamera(const CameraFrame& frame, SphericalMapping mapping);

}  // namespace lampyr
