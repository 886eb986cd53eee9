// The camera of pbrt-v4 with a lens of spherical elements ([Kolb95]; [Pharr23 §5.4]).
//
// The film lies at the camera's origin, the lens in front of it; the unit of camera space is a metre. A film point
// measures ∫ L cosθ cosθ' / r² dA over the plane of the rear vertex at distance z. With points drawn uniformly from the
// bounds of the exit pupil, the weight is cos⁴θ / z² times their area. Rays that do not pass the lens have weight 0.
#include <cmath>

#include "base/error.h"
#include "camera/exit_pupil.h"
#include "camera/film_map.h"

namespace lampyr {
namespace {

constexpr double kMetresPerMillimetre = 1e-3;

// Width and height of the film, mm.
Point2d FilmSize(const CameraFrame& frame, double diagonal) {
  const double aspect = static_cast<double>(frame.height) / frame.width;
  const double width = diagonal / std::sqrt(1 + aspect * aspect);
  return {width, aspect * width};
}

// Distance from the centre of the film to the farthest point that the pixel filter may sample, mm.
double FilmRadius(const CameraFrame& frame, const Point2d& size) {
  const Point2d margin(frame.filmMargin), pixels(frame.width, frame.height);
  return glm::length(size * (0.5 + margin / pixels));
}

class RealisticCamera final : public Camera {
 public:
  RealisticCamera(const CameraFrame& frame, const Point2d& filmSize, const LensSystem& lens)
      : cameraToRender_(frame.cameraToRender),
        filmSize_(filmSize),
        pixels_(frame.width, frame.height),
        lens_(lens),
        pupil_(lens, FilmRadius(frame, filmSize)),
        axis_(glm::normalize(frame.cameraToRender.Vector(Vector3d(0, 0, 1)))),
        inverseRearSquared_(1 / (lens.RearZ() * lens.RearZ())) {
    if (!pupil_.At(0)) throw Error("no light comes through the lens to the middle of the film");
    const std::optional<ThickLens> thick = lens.Approximation();
    imageDistance_ = thick ? thick->rearPrincipal : lens.StopZ();
  }

  CameraRay GenerateRay(const Point2& film, const Point2& lens, float time) const override {
    CameraRay result;
    // The image is upside down.
    const Point2d onFilm = (Point2d(0.5) - Point2d(film) / pixels_) * filmSize_ * Point2d(1, -1);
    const double radius = glm::length(onFilm);
    std::optional<LensSystem::Passed> passed;
    LensRay ray{{onFilm.x, onFilm.y, 0}, {0, 0, 1}};
    if (const std::optional<PupilBounds> bounds = pupil_.At(radius)) {
      const Point2d u(lens), turn = radius > 0 ? onFilm / radius : Point2d(1, 0);
      const double x = bounds->xMin + u.x * (bounds->xMax - bounds->xMin), y = (2 * u.y - 1) * bounds->yMax;
      const Point3d onRear(turn.x * x - turn.y * y, turn.y * x + turn.x * y, lens_.RearZ());
      ray.direction = glm::normalize(onRear - ray.origin);
      passed = lens_.Trace(ray);
      const double cosineSquared = ray.direction.z * ray.direction.z;
      result.weight = static_cast<float>(
          passed ? passed->transmission * cosineSquared * cosineSquared * bounds->Area() * inverseRearSquared_ : 0.0);
    } else {
      result.weight = 0;
    }
    if (passed) ray = passed->ray;
    result.ray.origin = Point3(cameraToRender_.Point(ray.origin * kMetresPerMillimetre));
    result.ray.direction = Vector3(glm::normalize(cameraToRender_.Vector(ray.direction)));
    result.ray.time = time;
    return result;
  }

  std::optional<CameraDensities> EvaluateRay(const Ray&, Point2*) const override { return std::nullopt; }
  std::optional<CameraConnection> Connect(const Point3&, const Point2&) const override { return std::nullopt; }
  bool ConnectsLightPaths() const override { return false; }
  bool HasPinhole() const override { return false; }

  // The solid angle for a thin lens at the rear principal plane.
  double PixelSolidAngle(const Ray& ray) const override {
    const double cosine = std::abs(glm::dot(axis_, Vector3d(ray.direction)));
    const double pixelArea = filmSize_.x * filmSize_.y / (pixels_.x * pixels_.y);
    return pixelArea * cosine * cosine * cosine / (imageDistance_ * imageDistance_);
  }

 private:
  Transform cameraToRender_;
  Point2d filmSize_, pixels_;
  LensSystem lens_;
  ExitPupil pupil_;
  Vector3d axis_;
  double inverseRearSquared_;
  double imageDistance_ = 0;  // mm
};

}  // namespace

std::unique_ptr<Camera> MakeRealisticCamera(const CameraFrame& frame, const RealisticSettings& settings) {
  CheckFrame(frame);
  const auto isUsable = [](double e) { return e > 0 && std::isfinite(e); };
  if (!isUsable(settings.filmDiagonal)) throw Error("the film's diagonal must be above 0");
  if (!isUsable(settings.apertureDiameter)) throw Error("the diameter of the aperture must be above 0");
  if (!isUsable(settings.focusDistance)) throw Error("the focus distance must be above 0");
  const double stopRadius = std::min(0.5 * settings.apertureDiameter, settings.lens.Stop().apertureRadius);
  LensSystem lens(settings.lens, stopRadius, settings.aperture);
  lens.Focus(settings.focusDistance / kMetresPerMillimetre);
  return std::make_unique<RealisticCamera>(frame, FilmSize(frame, settings.filmDiagonal), lens);
}

}  // namespace lampyr
