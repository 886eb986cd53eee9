// Cameras: rays and their film points, connections, densities and the normalisation of We, under transforms that are
// scaled, mirrored, sheared and far away.
#include "camera/camera.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "sampling/rng.h"
#include "sampling/sampler.h"
#include "sampling/warp.h"

namespace lampyr {
namespace {

double Double(float v) {
  return static_cast<double>(v);
}

struct NamedCamera {
  std::string name;
  CameraFrame frame;
  std::unique_ptr<Camera> camera;
  double scale = 1;  // of the transform
  bool isSpherical = false;
  float filmError = 1e-3f;  // pixels
};

std::vector<std::pair<std::string, Transform>> Transforms() {
  const Transform place = Transform::Translate({3, -2, 5}) * Transform::Rotate(50, {1, 2, 0.5});
  const glm::dmat4 shear(glm::dvec4(1, 0, 0, 0), glm::dvec4(0.3, 1, 0, 0), glm::dvec4(0.2, -0.1, 1, 0),
                         glm::dvec4(0, 0, 0, 1));
  return {{"identity", Transform()},
          {"placed", place},
          {"small", place * Transform::Scale(Vector3d(1e-3))},
          {"large", place * Transform::Scale(Vector3d(1e3))},
          {"mirrored", place * Transform::Scale({-1, 1, 1})},
          {"stretched", place * Transform::Scale({2, 0.7, 1.3})},
          {"sheared", place * Transform(shear)},
          {"far", Transform::Translate({1e4, -1e4, 1e4}) * Transform::Rotate(20, {0, 1, 0})}};
}

std::vector<NamedCamera> Cameras() {
  std::vector<NamedCamera> cameras;
  for (const auto& [name, transform] : Transforms()) {
    CameraFrame frame;
    frame.cameraToRender = transform;
    frame.width = 640;
    frame.height = 400;
    SetDefaultScreenWindow(frame, 1.6f);
    CameraFrame shifted = frame;  // an off-centre screen window
    shifted.screenMin = {-0.2f, 0.1f};
    shifted.screenMax = {0.9f, 1.4f};
    const double scale = name == "small" ? 1e-3 : name == "large" ? 1e3 : 1;
    // The film point of a ray from a lens is made of its position: one 10⁴ away is rounded to 5e-4, and one of a camera
    // of 1e-3 that stands 5 away to 3e-4 of the camera.
    const float lensError = name == "far" ? 1.0f : name == "small" ? 0.2f : 2e-3f;
    const auto add = [&](const std::string& kind, const CameraFrame& f, std::unique_ptr<Camera> camera,
                         float filmError) {
      cameras.push_back({kind + " " + name, f, std::move(camera), scale, kind.starts_with("spherical"), filmError});
    };
    add("pinhole", frame, MakePerspectiveCamera(frame, {Degrees(70)}), 1e-3f);
    add("pinhole shifted", shifted, MakePerspectiveCamera(shifted, {Degrees(40)}), 1e-3f);
    add("lens", frame, MakePerspectiveCamera(frame, {Degrees(70), 0.1f, 2.0f}), lensError);
    add("lens shifted", shifted, MakePerspectiveCamera(shifted, {Degrees(40), 0.3f, 5.0f}), lensError);
    const float filmRounding = name == "far" ? 1.0f : name == "small" ? 0.5f : 1e-3f;  // of positions, in pixels
    add("orthographic", frame, MakeOrthographicCamera(frame, {}), filmRounding);
    add("orthographic lens", shifted, MakeOrthographicCamera(shifted, {0.2f, 3.0f}), std::max(filmRounding, 2e-3f));
    add("spherical equal-area", frame, MakeSphericalCamera(frame, SphericalMapping::EqualArea), 2e-3f);
    add("spherical lat-long", frame, MakeSphericalCamera(frame, SphericalMapping::EquiRectangular), 2e-3f);
  }
  return cameras;
}

Point2 RandomFilm(const CameraFrame& frame, Rng& rng) {
  const Point2 u = rng.NextPoint2();
  return {1 + u.x * static_cast<float>(frame.width - 2), 1 + u.y * static_cast<float>(frame.height - 2)};
}

TEST(Camera, RayAndConnectionComeBackToTheFilmPoint) {
  for (const NamedCamera& c : Cameras()) {
    Rng rng(1);
    for (int i = 0; i < 2000; ++i) {
      const Point2 film = RandomFilm(c.frame, rng), lens = rng.NextPoint2();
      const Ray ray = c.camera->GenerateRay(film, lens, 0.25f).ray;
      ASSERT_NEAR(glm::length(ray.direction), 1.0f, 3e-7f) << c.name;
      ASSERT_EQ(ray.time, 0.25f);
      Point2 back;
      const auto densities = c.camera->EvaluateRay(ray, &back);
      ASSERT_TRUE(densities) << c.name << " " << film.x << " " << film.y;
      // Near the poles of latitude and longitude a pixel is narrower than a float direction can tell.
      const float poleError =
          c.name.starts_with("spherical") ? 10 / std::max(1.0f, std::min(film.y, 400 - film.y)) : 0.0f;
      const float filmError = c.filmError * (1 + poleError);
      ASSERT_LT(glm::length(back - film), filmError) << c.name;
      EXPECT_GT(densities->pdfPosition.value, 0.0f);
      EXPECT_GT(densities->pdfDirection.value, 0.0f);

      const float distance = static_cast<float>(c.scale) * (0.5f + 20 * rng.NextFloat());
      const Point3 point = ray.origin + ray.direction * distance;
      const auto connection = c.camera->Connect(point, lens);
      ASSERT_TRUE(connection) << c.name;
      const float pointRounding = 3e-7f * (MaxAbsComponent(point) + MaxAbsComponent(ray.origin)) / distance * 500;
      ASSERT_LT(glm::length(connection->film - film), filmError + 3 * pointRounding * 2) << c.name;
      // The connection's We is that of the ray.
      EXPECT_NEAR(connection->importance / densities->importance, 1.0f, 1e-3f + 0.02f * pointRounding) << c.name;
      EXPECT_NEAR(glm::length(connection->normal), 1.0f, 1e-6f);
      EXPECT_EQ(connection->isDelta, c.camera->HasPinhole() || c.camera->HasParallelRays());
      if (!c.isSpherical) {  // We cosθ / pixels = pdfPosition · pdfDirection
        const double cosTheta = Double(glm::dot(connection->normal, ray.direction));
        const double product = Double(densities->pdfPosition.value) * Double(densities->pdfDirection.value);
        EXPECT_NEAR(Double(densities->importance) * cosTheta / (640 * 400) / product, 1, 1e-5) << c.name;
      }
    }
  }
}

// ∫ of what a connection adds over all points of a plane in front of the camera, per pixel² = the image's area: the
// light tracer's normalisation. Points are sampled by film point and lens, and weighed by their density on the plane.
TEST(Camera, ConnectionsFromAPlaneMeasureThePixelCount) {
  for (const NamedCamera& c : Cameras()) {
    if (c.isSpherical) continue;
    // A plane across the view, tilted; a rectangle of it that covers more than the view.
    const Ray middle = c.camera->GenerateRay({320, 200}, {0.5f, 0.5f}, 0).ray;
    const float distance = 7 * static_cast<float>(c.scale);
    const Point3 center = middle.origin + middle.direction * distance;
    const Normal3 normal = glm::normalize(-middle.direction + Vector3(0.05f, 0.1f, -0.07f));
    const Vector3 s = glm::normalize(glm::cross(normal, Vector3(0.3f, 0.8f, 0.1f))), t = glm::cross(normal, s);
    const bool isShifted = c.name.find("shifted") != std::string::npos;
    const float extent = c.name.starts_with("orthographic lens") ? 1.3f
                         : c.camera->HasParallelRays()           ? 2.5f
                         : isShifted                             ? 3.4f
                                                                 : 12.0f;
    const float half = extent * distance / 7 * (c.name.find("stretched") != std::string::npos ? 1.4f : 1.0f);
    Sampler sampler(SamplerKind::Sobol, 3);
    constexpr uint32_t kCount = 1u << 17;
    double sum = 0, squares = 0;
    for (uint32_t i = 0; i < kCount; ++i) {
      sampler.StartPixelSample(0, 0, i);
      const Point2 u = sampler.Get2D();
      const Point3 point = center + s * (half * (2 * u.x - 1)) + t * (half * (2 * u.y - 1));
      const auto connection = c.camera->Connect(point, sampler.Get2D());
      if (!connection) continue;
      const Vector3 toCamera = connection->position - point;
      const double cosine = Double(glm::dot(normal, glm::normalize(toCamera)));
      ASSERT_GT(cosine, 0) << c.name;
      const double value = cosine * Double(connection->importance) / Double(connection->pdfLensSolidAngle);
      sum += value;
      squares += value * value;
    }
    const double area = 4 * Double(half) * Double(half);
    const double toPixels = area / kCount / (640.0 * 400);
    // The standard error of independent samples, which those of Sobol stay below.
    const double error = toPixels * std::sqrt(squares - sum * sum / kCount);
    EXPECT_LT(error, 0.01) << c.name;  // else the next line would not find a wrong factor
    EXPECT_NEAR(toPixels * sum, 1, 4.5 * error) << c.name;
  }
}

// The same by blocks of pixels for cameras that see all around them: a uniform sphere of radiance 1 is measured as 1.
TEST(Camera, ConnectionsSpreadEvenlyOverTheFilm) {
  for (const NamedCamera& c : Cameras()) {
    if (!c.isSpherical) continue;
    Sampler sampler(SamplerKind::Sobol, 5);
    constexpr uint32_t kCount = 1u << 17;
    std::vector<double> blocks(8 * 5);
    const Point3 eye = c.camera->GenerateRay({1, 1}, {0, 0}, 0).ray.origin;
    const float radius = 3;
    for (uint32_t i = 0; i < kCount; ++i) {
      sampler.StartPixelSample(0, 0, i);
      const auto connection = c.camera->Connect(eye + radius * SampleUniformSphere(sampler.Get2D()), {0, 0});
      ASSERT_TRUE(connection);
      const size_t x = static_cast<size_t>(connection->film.x / 80), y = static_cast<size_t>(connection->film.y / 80);
      ASSERT_TRUE(x < 8 && y < 5) << c.name;
      blocks[y * 8 + x] +=
          Double(connection->importance) / Double(connection->pdfLensSolidAngle) * 4 * Double(kPi) * 9 / kCount;
    }
    for (size_t i = 0; i < blocks.size(); ++i) {
      // Latitude and longitude: the importance grows as 1/sinθ towards the poles, and with it the noise of this
      // estimate.
      const bool isAtPole = c.name.starts_with("spherical lat") && (i < 8 || i >= 32);
      EXPECT_NEAR(blocks[i] / (80 * 80), 1, isAtPole ? 0.2 : 0.03) << c.name;
    }
  }
}

// pdfDirection integrates to 1 over the directions from one position on the lens.
TEST(Camera, DirectionDensityIntegratesToOne) {
  for (const NamedCamera& c : Cameras()) {
    if (c.camera->HasParallelRays()) continue;
    if (c.name.starts_with("orthographic")) continue;  // a product density: tested with We above
    const Ray start = c.camera->GenerateRay({320, 200}, {0.9f, 0.4f}, 0).ray;
    Sampler sampler(SamplerKind::Sobol, 9);
    constexpr uint32_t kCount = 1u << 17;
    double sum = 0;
    for (uint32_t i = 0; i < kCount; ++i) {
      sampler.StartPixelSample(0, 0, i);
      const auto densities = c.camera->EvaluateRay({start.origin, SampleUniformSphere(sampler.Get2D())}, nullptr);
      if (densities) sum += Double(densities->pdfDirection.value);
    }
    EXPECT_NEAR(sum / kCount * 4 * Double(kPi), 1, 0.02) << c.name;
  }
}

TEST(Camera, RasterConventionsAreThoseOfPbrt) {
  CameraFrame frame;
  frame.width = 200;
  frame.height = 100;
  SetDefaultScreenWindow(frame, 2);
  const auto perspective = MakePerspectiveCamera(frame, {Degrees(90)});
  const auto direction = [](const Camera& camera, Point2 film) {
    return camera.GenerateRay(film, {0.5f, 0.5f}, 0).ray.direction;
  };
  const auto expectNear = [](const Vector3& a, const Vector3& b) {
    EXPECT_LT(glm::length(a - b), 1e-6f) << a.x << " " << a.y << " " << a.z;
  };
  expectNear(direction(*perspective, {100, 50}), {0, 0, 1});
  expectNear(direction(*perspective, {0, 0}),
             glm::normalize(Vector3(-2, 1, 1)));  // upper left; fov over the shorter side
  expectNear(direction(*perspective, {200, 100}), glm::normalize(Vector3(2, -1, 1)));
  const auto orthographic = MakeOrthographicCamera(frame, {});
  expectNear(direction(*orthographic, {0, 0}), {0, 0, 1});
  expectNear(orthographic->GenerateRay({0, 0}, {0, 0}, 0).ray.origin, {-2, 1, 0});
  const auto latLong = MakeSphericalCamera(frame, SphericalMapping::EquiRectangular);
  expectNear(direction(*latLong, {37, 0}), {0, 1, 0});  // up
  expectNear(direction(*latLong, {0, 50}), {1, 0, 0});
  expectNear(direction(*latLong, {50, 50}), {0, 0, 1});
  const auto equalArea = MakeSphericalCamera(frame, SphericalMapping::EqualArea);
  expectNear(direction(*equalArea, {100, 50}), {0, 1, 0});
  expectNear(direction(*equalArea, {0, 0}), {0, -1, 0});
  expectNear(direction(*equalArea, {200, 50}), {1, 0, 0});
  expectNear(direction(*equalArea, {100, 100}), {0, 0, 1});
  SetDefaultScreenWindow(frame, 0.5f);
  EXPECT_EQ(frame.screenMax, Point2(1, 2));
}

TEST(Camera, LensRaysMeetOnThePlaneOfFocus) {
  for (const NamedCamera& c : Cameras()) {
    if (c.name.find("lens") == std::string::npos || c.name.find("far") != std::string::npos) continue;
    const float focus = c.name.starts_with("lens shifted") ? 5.0f : c.name.starts_with("lens") ? 2.0f : 3.0f;
    const Transform toCamera = c.frame.cameraToRender.Inverse();
    Rng rng(4);
    const Point2 film = RandomFilm(c.frame, rng);
    Point3d first(0.0);
    for (int i = 0; i < 100; ++i) {
      const Ray ray = c.camera->GenerateRay(film, rng.NextPoint2(), 0).ray;
      const Point3d o = toCamera.Point(Point3d(ray.origin));
      const Vector3d d = toCamera.Vector(Vector3d(ray.direction));
      const Point3d hit = o + d * ((Double(focus) - o.z) / d.z);
      if (i == 0) first = hit;
      // Positions of a small camera in a large scene are rounded to a float of the scene's coordinates.
      EXPECT_LT(glm::length(hit - first), c.name.ends_with("small") ? 5e-3 : 1e-5) << c.name;
    }
  }
}

TEST(Camera, WhatIsNotSeenDoesNotConnect) {
  for (const NamedCamera& c : Cameras()) {
    if (c.isSpherical) continue;
    const Ray ray = c.camera->GenerateRay({320, 200}, {0.5f, 0.5f}, 0).ray;
    const float scale = static_cast<float>(c.scale);
    EXPECT_FALSE(c.camera->Connect(ray.origin - 3 * scale * ray.direction, {0.5f, 0.5f})) << c.name;
    EXPECT_FALSE(c.camera->EvaluateRay({ray.origin, -ray.direction}, nullptr)) << c.name;
    const Ray outside = c.camera->GenerateRay({643, 200}, {0.5f, 0.5f}, 0).ray;
    EXPECT_FALSE(c.camera->EvaluateRay(outside, nullptr)) << c.name;
    EXPECT_FALSE(c.camera->Connect(outside.origin + 10 * scale * outside.direction, {0.5f, 0.5f})) << c.name;
    if (c.camera->HasPinhole()) {
      EXPECT_FALSE(c.camera->Connect(ray.origin, {0.5f, 0.5f})) << c.name;
    }
  }
}

TEST(Camera, TheMarginSeesBeyondTheImage) {
  CameraFrame frame;
  frame.width = frame.height = 100;
  frame.filmMargin = {2, 3};
  const auto camera = MakePerspectiveCamera(frame, {Degrees(60)});
  const auto isSeen = [&](Point2 film) {
    return camera->EvaluateRay(camera->GenerateRay(film, {0, 0}, 0).ray, nullptr).has_value();
  };
  EXPECT_TRUE(isSeen({-1.9f, 102.9f}));
  EXPECT_FALSE(isSeen({-2.1f, 50}));
  EXPECT_FALSE(isSeen({50, 103.1f}));
}

TEST(Camera, ExtremesStayFinite) {
  CameraFrame frame;
  frame.width = 4096;
  frame.height = 4096;
  for (const float fov : {1e-2f, 1.0f, 90.0f, 179.9f}) {
    for (const float radius : {0.0f, 1e-6f, 1e3f}) {
      const auto camera = MakePerspectiveCamera(frame, {Degrees(fov), radius, 1e6f});
      Rng rng(3);
      for (int i = 0; i < 1000; ++i) {
        const Point2 film = RandomFilm(frame, rng), lens = rng.NextPoint2();
        const Ray ray = camera->GenerateRay(film, lens, 0).ray;
        ASSERT_TRUE(IsFinite(ray.origin) && IsFinite(ray.direction));
        for (const float distance : {1e-6f, 1.0f, 1e6f}) {
          const auto connection = camera->Connect(ray.origin + distance * ray.direction, lens);
          if (!connection) continue;
          ASSERT_TRUE(std::isfinite(connection->importance) && connection->importance > 0) << fov << " " << radius;
          ASSERT_TRUE(std::isfinite(connection->pdfLensSolidAngle) && connection->pdfLensSolidAngle > 0);
        }
      }
    }
  }
}

TEST(Camera, SettingsThatMakeNoCameraAreErrors) {
  const CameraFrame good;
  const auto expectError = [](const CameraFrame& frame, const PerspectiveSettings& settings) {
    EXPECT_THROW(MakePerspectiveCamera(frame, settings), Error);
  };
  EXPECT_NO_THROW(MakePerspectiveCamera(good, {}));
  expectError(good, {Degrees(0)});
  expectError(good, {Degrees(180)});
  expectError(good, {Degrees(std::numeric_limits<float>::quiet_NaN())});
  expectError(good, {Degrees(40), -1.0f});
  expectError(good, {Degrees(40), 1.0f, 0.0f});
  CameraFrame frame = good;
  frame.width = 0;
  expectError(frame, {});
  frame = good;
  frame.screenMax = frame.screenMin;
  expectError(frame, {});
  frame = good;
  frame.cameraToRender = Transform(glm::dmat4(0.0));
  expectError(frame, {});
  EXPECT_THROW(MakeSphericalCamera(frame, SphericalMapping::EqualArea), Error);
  EXPECT_THROW(MakeOrthographicCamera(good, {-1.0f}), Error);
}

}  // namespace
}  // namespace lampyr
