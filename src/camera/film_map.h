// Shared by the cameras: checks of the frame, and the affine map from film to render space in double precision.
#pragma once

#include "camera/camera.h"

namespace lampyr {

inline bool IsOnFilm(const CameraFrame& frame, const Point2d& film) {
  const double marginX = static_cast<double>(frame.filmMargin.x), marginY = static_cast<double>(frame.filmMargin.y);
  return film.x >= -marginX && film.x < frame.width + marginX && film.y >= -marginY && film.y < frame.height + marginY;
}

inline double ImageArea(const CameraFrame& frame) {
  return static_cast<double>(frame.width) * static_cast<double>(frame.height);
}

// Throws an Error unless the frame has pixels, a screen window and an invertible affine transform.
void CheckFrame(const CameraFrame& frame);
void CheckLens(float lensRadius, float focalDistance);

// The plane z = distance of camera space in render space, in film coordinates. Relative to the camera's origin, film
// point (x, y) is at
//   center + (x - centerFilm.x)·dx + (y - centerFilm.y)·dy
struct FilmPlane {
  Vector3d center, dx, dy;
  Point2d centerFilm;
  Vector3d normal;        // ±dx × dy, pointing away from the camera; its length is the area of a pixel
  Vector3d dualX, dualY;  // dot(p, dualX) is the coordinate along dx of a point p of the plane through 0

  // `screenScale` converts screen coordinates to camera-space units.
  FilmPlane(const CameraFrame& frame, double screenScale, double distance);

  // The film point of `p`, a point of the plane relative to the camera's origin.
  Point2d FilmPoint(const Vector3d& p) const {
    const Vector3d d = p - center;
    return {centerFilm.x + glm::dot(d, dualX), centerFilm.y + glm::dot(d, dualY)};
  }
};

// Columns of cameraToRender: the camera's axes and origin in render space.
struct CameraAxes {
  Vector3d x, y, z;
  Point3d origin;

  explicit CameraAxes(const Transform& cameraToRender)
      : x(cameraToRender.Vector({1, 0, 0})),
        y(cameraToRender.Vector({0, 1, 0})),
        z(cameraToRender.Vector({0, 0, 1})),
        origin(cameraToRender.Point(Point3d(0.0))) {}

  double LensStretch() const { return glm::length(glm::cross(x, y)); }  // render-space area per area on the lens
};

}  // namespace lampyr
