// Checks of camera settings, and the film plane from a camera's frame.
#include "camera/film_map.h"

#include "base/error.h"

namespace lampyr {

void SetDefaultScreenWindow(CameraFrame& frame, float frameAspectRatio) {
  const float x = frameAspectRatio > 1 ? frameAspectRatio : 1.0f;
  const float y = frameAspectRatio > 1 ? 1.0f : 1 / frameAspectRatio;
  frame.screenMin = {-x, -y};
  frame.screenMax = {x, y};
}

void CheckFrame(const CameraFrame& frame) {
  if (frame.width < 1 || frame.height < 1) throw Error("the image has no pixels");
  const Vector2 extent = frame.screenMax - frame.screenMin;
  const auto isUsable = [](float e) { return e != 0 && std::isfinite(e); };
  if (!isUsable(extent.x) || !isUsable(extent.y)) throw Error("the camera's screen window is empty or not finite");
  if (!frame.cameraToRender.IsAffine()) throw Error("the camera's transform is not affine");
  if (frame.cameraToRender.IsSingular()) throw Error("the camera's transform is singular");
}

void CheckLens(float lensRadius, float focalDistance) {
  if (!(lensRadius >= 0) || !std::isfinite(lensRadius)) throw Error("the camera's lens radius must not be negative");
  if (lensRadius > 0 && !(focalDistance > 0 && std::isfinite(focalDistance))) {
    throw Error("the focal distance of a camera with a lens must be positive");
  }
}

FilmPlane::FilmPlane(const CameraFrame& frame, double screenScale, double distance) {
  const CameraAxes axes(frame.cameraToRender);
  const Point2d screenMin(frame.screenMin), screenMax(frame.screenMax);
  const Point2d middle = (screenMin + screenMax) * (0.5 * screenScale);
  centerFilm = {0.5 * frame.width, 0.5 * frame.height};
  center = axes.x * middle.x + axes.y * middle.y + axes.z * distance;
  dx = axes.x * (screenScale * (screenMax.x - screenMin.x) / frame.width);
  dy = axes.y * (-screenScale * (screenMax.y - screenMin.y) / frame.height);  // film y points down
  normal = glm::cross(dx, dy);
  const Vector3d unit = normal / glm::dot(normal, normal);
  dualX = glm::cross(dy, unit);
  dualY = glm::cross(unit, dx);
  if (glm::dot(normal, axes.z) < 0) normal = -normal;
}

}  // namespace lampyr
