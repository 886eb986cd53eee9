// Orthographic camera with parallel rays, or with a thin lens around each film point (an object-space telecentric
// lens).
//
// Film points lie on the plane z = 0 of camera space, with a render-space area `a` per pixel. Without a lens, the
// direction ω is a delta whose coefficient in We is 1/(a cosθ). With a lens, a ray starts at film point + l, l uniform
// over the lens of area A, and goes through film point + focalDistance·z. At a given position dω = cos³θ/h² dl, with h
// the height of the plane of focus, hence We = h²/(a A cos⁴θ). The density of positions is that of film points: at the
// border of the image, where fewer lenses overlap, only its product with pdfDirection is exact.
#include "base/error.h"
#include "camera/film_map.h"
#include "sampling/warp.h"

namespace lampyr {
namespace {

class OrthographicCamera final : public Camera {
 public:
  OrthographicCamera(const CameraFrame& frame, const OrthographicSettings& settings)
      : frame_(frame),
        plane_(frame, 1, 0),
        origin_(CameraAxes(frame.cameraToRender).origin),
        hasLens_(settings.lensRadius > 0) {
    const CameraAxes axes(frame.cameraToRender);
    const double radius = static_cast<double>(settings.lensRadius);
    const double focalDistance = hasLens_ ? static_cast<double>(settings.focalDistance) : 1;
    toFocus_ = axes.z * focalDistance;
    lensX_ = axes.x * radius;
    lensY_ = axes.y * radius;
    pixelArea_ = glm::length(plane_.normal);
    unitNormal_ = plane_.normal / pixelArea_;
    focalHeight_ = glm::dot(unitNormal_, toFocus_);
    inverseLensArea_ = hasLens_ ? 1 / (static_cast<double>(kPi) * radius * radius * axes.LensStretch()) : 1;
    inverseLensRadii_ = hasLens_ ? Point2d(1 / glm::dot(lensX_, lensX_), 1 / glm::dot(lensY_, lensY_)) : Point2d(0.0);
    if (hasLens_)
      lensLimit_ = 1.001 + 1e-13 * glm::dot(toFocus_, toFocus_) * (inverseLensRadii_.x + inverseLensRadii_.y);
    direction_ = glm::normalize(toFocus_);
    center_ = plane_.center + Vector3d(origin_);
    dx_ = plane_.dx;
    dy_ = plane_.dy;
    centerFilm_ = plane_.centerFilm;
    toFocusFloat_ = toFocus_ * (1 / focalDistance);
    lensXFloat_ = lensX_;
    lensYFloat_ = lensY_;
    inverseFocalDistance_ = static_cast<float>(1 / focalDistance);
  }

  CameraRay GenerateRay(const Point2& film, const Point2& lens, float time) const override {
    CameraRay result;
    result.ray.origin = center_ + ((film.x - centerFilm_.x) * dx_ + (film.y - centerFilm_.y) * dy_);
    result.ray.direction = direction_;
    if (hasLens_) {
      const Vector3 offset = LensOffset(lens);
      result.ray.origin += offset;
      result.ray.direction = glm::normalize(toFocusFloat_ - offset * inverseFocalDistance_);
    }
    result.ray.time = time;
    return result;
  }

  std::optional<CameraDensities> EvaluateRay(const Ray& ray, Point2* film) const override {
    const Vector3d direction = glm::normalize(Vector3d(ray.direction));
    const double cosTheta = glm::dot(unitNormal_, direction);
    if (!(cosTheta > 0)) return std::nullopt;
    Vector3d filmPoint = Vector3d(ray.origin) - Vector3d(origin_);
    if (hasLens_) {
      const Vector3d offset = toFocus_ - direction * (focalHeight_ / cosTheta);
      if (!IsOnLens(offset)) return std::nullopt;
      filmPoint -= offset;
    } else if (!(glm::dot(direction, Vector3d(direction_)) > 1 - 1e-6)) {
      return std::nullopt;
    }
    const Point2d point = plane_.FilmPoint(filmPoint);
    if (!IsOnFilm(frame_, point)) return std::nullopt;
    if (film) *film = Point2(point);
    CameraDensities result;
    const double pdfDirection = PdfDirection(cosTheta);
    result.pdfPosition = PdfArea(static_cast<float>(1 / (pixelArea_ * ImageArea(frame_))));
    result.pdfDirection = PdfSolidAngle(static_cast<float>(pdfDirection));
    result.importance = static_cast<float>(pdfDirection / (pixelArea_ * cosTheta));
    return result;
  }

  std::optional<CameraConnection> Connect(const Point3& point, const Point2& lens) const override {
    const Vector3d offset = hasLens_ ? Vector3d(LensOffset(lens)) : Vector3d(0.0);
    const Vector3d direction = glm::normalize(toFocus_ - offset);
    const double cosTheta = glm::dot(unitNormal_, direction);
    const Vector3d fromOrigin = Vector3d(point) - Vector3d(origin_);
    const double height = glm::dot(unitNormal_, fromOrigin);
    if (!(height > 0)) return std::nullopt;
    const Vector3d start = fromOrigin - direction * (height / cosTheta);
    const Point2d film = plane_.FilmPoint(start - offset);
    if (!IsOnFilm(frame_, film)) return std::nullopt;
    CameraConnection result;
    result.position = Point3(start + Vector3d(origin_));
    result.normal = Normal3(unitNormal_);
    result.film = Point2(film);
    const double pdfDirection = PdfDirection(cosTheta);
    result.importance = static_cast<float>(pdfDirection / (pixelArea_ * cosTheta));
    result.pdfLensSolidAngle = static_cast<float>(pdfDirection);
    result.isDelta = !hasLens_;
    return result;
  }

  bool HasPinhole() const override { return false; }
  bool HasParallelRays() const override { return !hasLens_; }
  bool ConnectsByDirection() const override { return true; }

 private:
  Vector3 LensOffset(const Point2& u) const {
    const Point2 disk = SampleConcentricDisk(u);
    return disk.x * lensXFloat_ + disk.y * lensYFloat_;
  }

  // 1/sr given the position; 1 with parallel rays. Equals the density with which Connect chooses its direction.
  double PdfDirection(double cosTheta) const {
    return hasLens_ ? inverseLensArea_ * focalHeight_ * focalHeight_ / (cosTheta * cosTheta * cosTheta) : 1;
  }

  bool IsOnLens(const Vector3d& offset) const {
    // The film axes may be sheared: the coordinates along them use the dual basis of the film plane.
    const double x = glm::dot(offset, plane_.dualX) * glm::dot(plane_.dx, lensX_) * inverseLensRadii_.x;
    const double y = glm::dot(offset, plane_.dualY) * glm::dot(plane_.dy, lensY_) * inverseLensRadii_.y;
    return x * x + y * y <= lensLimit_;
  }

  CameraFrame frame_;
  FilmPlane plane_;
  Point3 origin_;
  bool hasLens_;
  Vector3d toFocus_;  // from a film point to the point it focuses on
  Vector3d lensX_, lensY_;
  Vector3d unitNormal_;
  double pixelArea_, focalHeight_, inverseLensArea_;
  Point2d inverseLensRadii_;  // squared, along lensX_ and lensY_
  double lensLimit_ = 1;      // squared radius limit of the lens, with tolerance for rounded directions
  // Copies in single precision, for rays.
  Point3 center_;
  Vector3 direction_, dx_, dy_, toFocusFloat_, lensXFloat_, lensYFloat_;
  Point2 centerFilm_;
  float inverseFocalDistance_;
};

}  // namespace

std::unique_ptr<Camera> MakeOrthographicCamera(const CameraFrame& frame, const OrthographicSettings& settings) {
  CheckFrame(frame);
  CheckLens(settings.lensRadius, settings.focalDistance);
  return std::make_unique<OrthographicCamera>(frame, settings);
}

}  // namespace lampyr
