// Spherical camera: all directions around a point, by the equal-area octahedral map or by latitude and longitude,
// oriented as in pbrt-v4: +z of the maps is the camera's up (y).
//
// With M the linear part of cameraToRender, a camera direction c becomes Mc/|Mc|. This scales solid angles by
//   |det M| / |Mc|³
#include "camera/film_map.h"
#include "sampling/equal_area.h"

namespace lampyr {
namespace {

class SphericalCamera final : public Camera {
 public:
  SphericalCamera(const CameraFrame& frame, SphericalMapping mapping)
      : frame_(frame),
        mapping_(mapping),
        origin_(frame.cameraToRender.Point(Point3d(0.0))),
        toRender_(frame.cameraToRender.Matrix()),
        toCamera_(frame.cameraToRender.InverseMatrix()),
        determinant_(std::abs(glm::determinant(glm::dmat3(frame.cameraToRender.Matrix())))),
        toUnit_(1.0f / static_cast<float>(frame.width), 1.0f / static_cast<float>(frame.height)) {}

  CameraRay GenerateRay(const Point2& film, const Point2& /*lens*/, float time) const override {
    const Point2 uv = film * toUnit_;
    const Vector3 d = mapping_ == SphericalMapping::EqualArea ? EqualAreaSquareToSphere(WrapEqualAreaSquare(uv))
                                                              : LatLongSquareToSphere(uv);
    CameraRay result;
    result.ray.origin = origin_;
    result.ray.direction = glm::normalize(toRender_ * Vector3(d.x, d.z, d.y));
    result.ray.time = time;
    return result;
  }

  std::optional<CameraDensities> EvaluateRay(const Ray& ray, Point2* film) const override {
    Point2 point;
    const double importance = Importance(Vector3d(ray.direction), &point);
    if (film) *film = point;
    CameraDensities result;
    result.pdfPosition = PdfArea(1);
    result.pdfDirection = PdfSolidAngle(static_cast<float>(importance / ImageArea(frame_)));
    result.importance = static_cast<float>(importance);
    return result;
  }

  std::optional<CameraConnection> Connect(const Point3& point, const Point2& /*lens*/) const override {
    const Vector3d toPoint = Vector3d(point) - Vector3d(origin_);
    const double distanceSquared = glm::dot(toPoint, toPoint);
    if (!(distanceSquared > 0)) return std::nullopt;
    CameraConnection result;
    result.position = origin_;
    const Vector3d direction = toPoint / std::sqrt(distanceSquared);
    result.normal = Normal3(direction);
    result.importance = static_cast<float>(Importance(direction, &result.film));
    result.pdfLensSolidAngle = static_cast<float>(distanceSquared);
    return result;
  }

  std::optional<CameraView> View() const override { return CameraView{origin_, {}}; }

  FilmCopies CopiesOf(const Point2& film) const override {
    const float w = static_cast<float>(frame_.width), h = static_cast<float>(frame_.height);
    const Vector2 m = frame_.filmMargin;
    FilmCopies copies;
    if (film.x >= m.x && film.x < w - m.x && film.y >= m.y && film.y < h - m.y) return copies;
    const auto add = [&](float x, float y) {
      if (IsOnFilm(frame_, {x, y})) copies.points[static_cast<size_t>(copies.count++)] = {x, y};
    };
    if (mapping_ == SphericalMapping::EqualArea) {  // the points that WrapEqualAreaSquare maps to `film`
      for (const float x : {-film.x, 2 * w - film.x}) add(x, h - film.y);
      for (const float y : {-film.y, 2 * h - film.y}) add(w - film.x, y);
      for (const float x : {film.x - w, film.x + w}) {
        for (const float y : {film.y - h, film.y + h}) add(x, y);
      }
    } else {  // around the equator, and across the poles to the opposite longitude
      for (const float x : {film.x - w, film.x + w}) add(x, film.y);
      const float across = film.x < 0.5f * w ? film.x + 0.5f * w : film.x - 0.5f * w;
      for (const float y : {-film.y, 2 * h - film.y}) {
        for (const float x : {across - w, across, across + w}) add(x, y);
      }
    }
    return copies;
  }

  bool HasPinhole() const override { return true; }

 private:
  // Pixels per steradian in render space.
  double Importance(const Vector3d& direction, Point2* film) const {
    const Vector3d c = toCamera_ * glm::normalize(direction);
    const double inverseLength = 1 / glm::length(c);  // |Mc| of the unit camera direction
    const Vector3 d = Vector3(c * inverseLength);
    const Vector3 mapped(d.x, d.z, d.y);
    const bool isEqualArea = mapping_ == SphericalMapping::EqualArea;
    *film = (isEqualArea ? EqualAreaSphereToSquare(mapped) : LatLongSphereToSquare(mapped)) / toUnit_;
    const float sinTheta = std::sqrt(mapped.x * mapped.x + mapped.y * mapped.y);
    // At the poles of the latitude-longitude map a solid angle covers a whole row of the image: bounded.
    const float jacobian = isEqualArea ? kEqualAreaJacobian : LatLongJacobian(std::max(sinTheta, 1e-6f));
    const double pixelsPerCameraSolidAngle = ImageArea(frame_) / static_cast<double>(jacobian);
    return pixelsPerCameraSolidAngle * inverseLength * inverseLength * inverseLength / determinant_;
  }

  CameraFrame frame_;
  SphericalMapping mapping_;
  Point3 origin_;
  glm::mat3 toRender_;
  glm::dmat3 toCamera_;
  double determinant_;
  Vector2 toUnit_;
};

}  // namespace

std::unique_ptr<Camera> MakeSphericalCamera(const CameraFrame& frame, SphericalMapping mapping) {
  CheckFrame(frame);
  return std::make_unique<SphericalCamera>(frame, mapping);
}

}  // namespace lampyr
