// Perspective camera, pinhole or thin lens ([Pharr23 §5.2.3]; We as in [Veach97 §8.3.2.2]).
//
// All formulas hold in render space for an arbitrary affine cameraToRender. Let D(x,y) be the point of the plane z = 1
// that film point (x,y) sees, relative to the camera's origin, N = ∂D/∂x × ∂D/∂y and det = N·D (a constant). A ray of
// unit direction ω then covers dx dy / dω = det² / (N·ω)³ pixels per steradian. The same holds for a ray that starts at
// a lens point l and goes through focalDistance·D, because l is perpendicular to N.
#include "base/error.h"
#include "camera/film_map.h"
#include "sampling/warp.h"

namespace lampyr {
namespace {

class PerspectiveCamera final : public Camera {
 public:
  PerspectiveCamera(const CameraFrame& frame, const PerspectiveSettings& settings, double tanHalfFov)
      : frame_(frame),
        plane_(frame, tanHalfFov, 1),
        origin_(CameraAxes(frame.cameraToRender).origin),
        hasLens_(settings.lensRadius > 0),
        focalDistance_(hasLens_ ? static_cast<double>(settings.focalDistance) : 1) {
    const CameraAxes axes(frame.cameraToRender);
    const double radius = static_cast<double>(settings.lensRadius);
    lensX_ = axes.x * radius;
    lensY_ = axes.y * radius;
    inverseFocalDistance_ = static_cast<float>(1 / focalDistance_);
    pdfLensArea_ = hasLens_ ? 1 / (static_cast<double>(kPi) * radius * radius * axes.LensStretch()) : 1;
    determinant_ = glm::dot(plane_.normal, plane_.center);
    unitNormal_ = glm::normalize(plane_.normal);
    center_ = plane_.center;
    dx_ = plane_.dx;
    dy_ = plane_.dy;
    centerFilm_ = plane_.centerFilm;
  }

  CameraRay GenerateRay(const Point2& film, const Point2& lens, float time) const override {
    CameraRay result;
    Vector3 direction = DirectionOf(film);
    result.ray.origin = origin_;
    if (hasLens_) {
      const Vector3 offset = LensOffset(lens);
      result.ray.origin += offset;
      direction -= offset * inverseFocalDistance_;
    }
    result.ray.direction = glm::normalize(direction);
    result.ray.time = time;
    return result;
  }

  std::optional<CameraDensities> EvaluateRay(const Ray& ray, Point2* film) const override {
    const Vector3d offset = hasLens_ ? Vector3d(ray.origin) - Vector3d(origin_) : Vector3d(0.0);
    const Vector3d direction = glm::normalize(Vector3d(ray.direction));
    const double normalDotDirection = glm::dot(plane_.normal, direction);
    if (!(normalDotDirection > 0)) return std::nullopt;
    const Point2d point = FilmPoint(offset, direction, normalDotDirection);
    if (!IsOnFilm(frame_, point)) return std::nullopt;
    if (film) *film = Point2(point);
    CameraDensities result;
    const double pixelsPerSolidAngle = PixelsPerSolidAngle(normalDotDirection);
    const double cosTheta = glm::dot(unitNormal_, direction);
    result.pdfPosition = PdfArea(static_cast<float>(pdfLensArea_));
    result.pdfDirection = PdfSolidAngle(static_cast<float>(pixelsPerSolidAngle / ImageArea(frame_)));
    result.importance = static_cast<float>(pdfLensArea_ * pixelsPerSolidAngle / cosTheta);
    return result;
  }

  std::optional<CameraConnection> Connect(const Point3& point, const Point2& lens) const override {
    const Vector3 lensOffset = hasLens_ ? LensOffset(lens) : Vector3(0.0f);
    CameraConnection result;
    result.position = origin_ + lensOffset;
    const Vector3d offset = hasLens_ ? Vector3d(result.position) - Vector3d(origin_) : Vector3d(0.0);
    const Vector3d toPoint = Vector3d(point) - Vector3d(result.position);
    const double distanceSquared = glm::dot(toPoint, toPoint);
    const double normalDotVector = glm::dot(plane_.normal, toPoint);
    if (!(distanceSquared > 0) || !(normalDotVector > 0)) return std::nullopt;
    const Point2d film = FilmPoint(offset, toPoint, normalDotVector);
    if (!IsOnFilm(frame_, film)) return std::nullopt;
    const double distance = std::sqrt(distanceSquared);
    const double cosTheta = glm::dot(unitNormal_, toPoint) / distance;
    result.normal = Normal3(unitNormal_);
    result.film = Point2(film);
    result.importance = static_cast<float>(pdfLensArea_ * PixelsPerSolidAngle(normalDotVector / distance) / cosTheta);
    result.pdfLensSolidAngle = static_cast<float>(pdfLensArea_ * distanceSquared / cosTheta);
    result.isDelta = !hasLens_;
    return result;
  }

  std::optional<CameraView> View() const override {
    CameraView view{origin_, {Vector3(unitNormal_)}};
    const auto w = static_cast<float>(frame_.width), h = static_cast<float>(frame_.height);
    const Point2 corners[5] = {{0, 0}, {w, 0}, {w, h}, {0, h}, {0, 0}};
    const Vector3 middle = DirectionOf({0.5f * w, 0.5f * h});
    for (int i = 0; i < 4; ++i) {
      const Vector3d across = glm::cross(Vector3d(DirectionOf(corners[i])), Vector3d(DirectionOf(corners[i + 1])));
      const double side = glm::dot(across, Vector3d(middle));
      if (side != 0 && std::isfinite(side)) view.planes.push_back(Vector3(glm::normalize(side > 0 ? across : -across)));
    }
    return view;
  }

  bool HasPinhole() const override { return !hasLens_; }

 private:
  // From the origin to the point at distance 1 that the film point sees; not unit.
  Vector3 DirectionOf(const Point2& film) const {
    return center_ + (film.x - centerFilm_.x) * dx_ + (film.y - centerFilm_.y) * dy_;
  }
  Vector3 LensOffset(const Point2& u) const {
    const Point2 disk = SampleConcentricDisk(u);
    return disk.x * lensX_ + disk.y * lensY_;
  }

  // The film point of the ray from `offset`, relative to the camera's origin, along `direction` (of any length).
  Point2d FilmPoint(const Vector3d& offset, const Vector3d& direction, double normalDotDirection) const {
    const Vector3d onPlane = direction * (determinant_ / normalDotDirection);
    return plane_.FilmPoint(hasLens_ ? onPlane + offset / focalDistance_ : onPlane);
  }

  double PixelsPerSolidAngle(double normalDotDirection) const {
    const double ratio = determinant_ / normalDotDirection;
    return ratio * ratio / normalDotDirection;
  }

  CameraFrame frame_;
  FilmPlane plane_;
  Point3 origin_;
  bool hasLens_;
  double focalDistance_;  // 1 for a pinhole
  double pdfLensArea_;    // 1 for a pinhole
  double determinant_;
  Vector3d unitNormal_;
  // Copies in single precision, for rays.
  Vector3 center_, dx_, dy_, lensX_, lensY_;
  Point2 centerFilm_;
  float inverseFocalDistance_;
};

}  // namespace

std::unique_ptr<Camera> MakePerspectiveCamera(const CameraFrame& frame, const PerspectiveSettings& settings) {
  CheckFrame(frame);
  CheckLens(settings.lensRadius, settings.focalDistance);
  const double fov = static_cast<double>(settings.fov.value);
  if (!(fov > 0 && fov < 180)) throw Error("the camera's field of view must be between 0 and 180 degrees");
  return std::make_unique<PerspectiveCamera>(frame, settings, std::tan(fov * (3.14159265358979323846 / 360)));
}

}  // namespace lampyr
