// The lights rect, disk, sphere and cylinder against closed forms and against quadratures written here: irradiance from
// near, from 1e4 sizes away and grazing, at sizes of 1e-6 and 1e6; UsdLux's parameters by hand; placements that the
// light was not built with.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "light_fixture.h"
#include "sampling/rng.h"

namespace lampyr {
namespace {

using test::Build;
constexpr double kPiDouble = 3.14159265358979323846;

// W/m² at P on a surface with normal n, green channel, by light sampling over jittered strata.
double Irradiance(const test::BuiltLight& built, const Point3& P, const Vector3d& n, int side = 256) {
  Rng rng(11);
  double sum = 0;
  for (int i = 0; i < side * side; ++i) {
    LightContext context = built.context;
    context.u = (Point2(static_cast<float>(i % side), static_cast<float>(i / side)) + rng.NextPoint2()) /
                static_cast<float>(side);
    context.u = glm::min(context.u, Point2(kOneMinusEpsilon));
    const auto sample = built.light->GenerateSamples(context, P);
    if (!sample) continue;
    sum += static_cast<double>(sample->diffuse.g) * std::max(glm::dot(n, Vector3d(sample->direction)), 0.0) /
           static_cast<double>(sample->pdfDirect.value);
  }
  return sum / (side * side);
}

// Irradiance by a polygon of radiance 1 that is all above the horizon, by Lambert's formula; small edges by their
// sines.
double LambertPolygon(const std::vector<Point3d>& corners, const Point3d& P, const Vector3d& n) {
  double sum = 0;
  for (size_t i = 0; i < corners.size(); ++i) {
    const Vector3d a = glm::normalize(corners[i] - P), b = glm::normalize(corners[(i + 1) % corners.size()] - P);
    const Vector3d c = glm::cross(a, b);
    const double sine = glm::length(c);
    if (sine > 0) sum += std::atan2(sine, glm::dot(a, b)) * glm::dot(n, c / sine);
  }
  return 0.5 * std::abs(sum);
}

// Integral of f(s, t) over the unit square by midpoints.
double Integrate(int n, const std::function<double(double, double)>& f) {
  double sum = 0;
  for (int i = 0; i < n * n; ++i) sum += f((i % n + 0.5) / n, (i / n + 0.5) / n);
  return sum / (static_cast<double>(n) * n);
}

double Element(const Point3d& x, const Vector3d& normal, const Point3d& P, const Vector3d& n) {
  const Vector3d way = x - P;
  const double squared = glm::dot(way, way), length = std::sqrt(squared);
  return std::max(glm::dot(n, way) / length, 0.0) * std::max(-glm::dot(normal, way) / length, 0.0) / squared;
}

TEST(AreaLights, RectIsLambertsPolygon) {
  for (const double size : {1.0, 1e6}) {
    const double w = 2 * size, h = 0.7 * size;
    const auto rect = Build("rect", "\"float width\" " + std::to_string(w) + " \"float height\" " + std::to_string(h) +
                                        " \"float intensity\" 3");
    const std::vector<Point3d> corners = {
        {-w / 2, -h / 2, 0}, {w / 2, -h / 2, 0}, {w / 2, h / 2, 0}, {-w / 2, h / 2, 0}};
    for (const Vector3d& p : {Vector3d(0.1, 0.2, -0.05), Vector3d(0.3, -2, -1), Vector3d(7, 4, -0.8),
                              Vector3d(3e3, 4e3, -9e3), Vector3d(9e3, 100, -300)}) {
      const Point3 P(p * size);
      const Vector3d n(0, 0, 1);  // parallel: all of the light is above the horizon
      const double expected = 3 * LambertPolygon(corners, Point3d(P), n);
      EXPECT_NEAR(Irradiance(*rect, P, n, 64), expected, 2e-3 * expected) << size << " " << p.x;
    }
    EXPECT_EQ(Irradiance(*rect, Point3(0.1f, 0.1f, 1), {0, 0, -1}, 16), 0) << "nothing from behind";
    EXPECT_EQ(Irradiance(*rect, Point3(static_cast<float>(3 * size), 0, 0), {-1, 0, 0}, 16), 0) << "nor on its plane";
  }
}

// A parallelogram, a tiny one and a huge one, by the transform; far from the origin too.
TEST(AreaLights, RectUnderAnyTransform) {
  glm::dmat4 shear(1.0);
  shear[1][0] = 0.6;
  for (const Transform& base : {Transform(), Transform(shear), Transform::Scale({-1, 1, 1}),
                                Transform::Scale({3, 0.2, 1}) * Transform::Rotate(35, {1, 1, 0})}) {
    for (const double size : {1e-6, 1.0, 1e6}) {
      const Transform placement = Transform::Rotate(70, {1, 2, 3}) * Transform::Scale(Vector3d(size)) * base;
      const auto rect = Build("rect", "", placement);
      const auto moved = Build("rect", "", Transform::Scale({1, 2, 3}));
      moved->context.transform = &rect->build.transform;
      std::vector<Point3d> corners;
      for (const Point3d& c :
           {Point3d(-0.5, -0.5, 0), Point3d(0.5, -0.5, 0), Point3d(0.5, 0.5, 0), Point3d(-0.5, 0.5, 0)}) {
        corners.push_back(placement.Point(c));
      }
      const Vector3d down = glm::normalize(placement.Normal({0, 0, -1}));
      for (const double away : {0.3, 40.0, 1e4}) {
        const int side = away < 1 ? 256 : 64;  // a parallelogram from near is sampled by area
        const Point3 P(down * (size * away));
        const double expected = LambertPolygon(corners, Point3d(P), -down);
        EXPECT_NEAR(Irradiance(*rect, P, -down, side), expected, 2e-3 * expected) << size << " " << away;
        EXPECT_NEAR(Irradiance(*moved, P, -down, side), expected, 2e-3 * expected) << size << " " << away << " moved";
      }
      const double area = glm::length(glm::cross(corners[1] - corners[0], corners[3] - corners[0]));
      const auto power = static_cast<double>(moved->light->GetPowerEstimate(moved->context).g);
      EXPECT_NEAR(power, kPiDouble * area, 1e-4 * kPiDouble * area);
    }
  }
}

// Mean and density run through the change of technique without a step.
TEST(AreaLights, RectIsContinuousInTheDistance) {
  const auto rect = Build("rect", "");
  double lastDensity = 0;
  for (double z = 1e3; z < 1e6; z *= 1.05) {
    const Point3 P(static_cast<float>(0.3 * z), 0, static_cast<float>(-z));
    auto context = rect->context;
    context.u = {0.4f, 0.7f};
    const auto sample = rect->light->GenerateSamples(context, P);
    ASSERT_TRUE(sample);
    const auto density = static_cast<double>(sample->pdfDirect.value);
    if (lastDensity > 0) {
      EXPECT_NEAR(density / lastDensity, 1.05 * 1.05, 1e-3) << z;
    }
    lastDensity = density;
    const Vector3d way = Vector3d(0, 0, 0) - Vector3d(P);
    const double expected = Element({0, 0, 0}, {0, 0, -1}, Point3d(P), {0, 0, 1});
    EXPECT_NEAR(Irradiance(*rect, P, {0, 0, 1}, 8), expected, 1e-3 * expected) << z;
    EXPECT_NEAR(static_cast<double>(sample->distance), glm::length(way), 0.75 + 1e-6 * z);
  }
}

TEST(AreaLights, DiskInClosedForm) {
  for (const double r : {0.8, 800.0}) {
    const auto disk = Build("disk", "\"float radius\" " + std::to_string(r));
    for (const auto& [d, h] :
         {std::pair(0.0, 0.1), {0.0, 2.0}, {0.5, 0.7}, {3.0, 1.0}, {9.0, 0.3}, {0.0, 1e4}, {6e3, 8e3}}) {
      // Parallel to the disk, d beside its axis at height h ([Howell] configuration factor B-13).
      const double D = d * r, H = h * r, sum = r * r + D * D + H * H;
      const double root = std::sqrt((sum - 2 * r * D) * (sum + 2 * r * D));
      const double expected = kPiDouble * 0.5 * (root - (D * D + H * H - r * r)) / root;
      const Point3 P(static_cast<float>(D), 0, static_cast<float>(-H));
      // The difference in the closed form keeps less than 1e-3 from afar.
      const double tolerance = 2e-3;
      const double far = kPiDouble * r * r * H * H / ((D * D + H * H) * (D * D + H * H));
      EXPECT_NEAR(Irradiance(*disk, P, {0, 0, 1}), h > 100 ? far : expected, tolerance * (h > 100 ? far : expected))
          << r << " " << d << " " << h;
    }
  }
}

// Partly below the receiver's horizon too ([Howell] configuration factor B-44).
double SphereFactor(double H, double theta) {
  const double s = std::sqrt(H * H - 1), c = std::cos(theta);
  if (theta + std::asin(1 / H) <= kPiDouble / 2) return c / (H * H);
  if (theta - std::asin(1 / H) >= kPiDouble / 2) return 0;
  return 0.5 - std::asin(s / (H * std::sin(theta))) / kPiDouble +
         (c * std::acos(-s * c / std::sin(theta)) - s * std::sqrt(1 - H * H * c * c)) / (kPiDouble * H * H);
}

TEST(AreaLights, SphereInClosedForm) {
  const auto sphere = Build("sphere", "", Transform::Translate({5, -3, 2}) * Transform::Rotate(20, {1, 0, 1}));
  for (const double H : {1.01, 1.5, 4.0, 100.0, 1e4}) {
    for (const double degrees : {0.0, 40.0, 75.0, 89.0, 90.0, 95.0, 120.0}) {
      const double theta = degrees * kPiDouble / 180, expected = kPiDouble * SphereFactor(H, theta);
      const Point3 P(5, -3, static_cast<float>(2 - 0.5 * H));
      const double atSphere = Irradiance(*sphere, P, {std::sin(theta), 0, std::cos(theta)});
      EXPECT_NEAR(atSphere, expected, 2e-3 * expected + 2e-4 * kPiDouble / (H * H)) << H << " " << degrees;
    }
  }
}

TEST(AreaLights, CylinderByQuadrature) {
  const auto cylinder = Build("cylinder", "\"float length\" 2 \"float radius\" 0.3");
  for (const Point3& P : {Point3(0.2f, 0.31f, 0.1f), Point3(0.5f, 2, -1), Point3(3, 0.4f, 0), Point3(1.2f, 0.1f, 0.1f),
                          Point3(-1e3f, 2e3f, 3e3f)}) {
    const Vector3d toMiddle = -Vector3d(P);
    for (const Vector3d& n : {glm::normalize(toMiddle), Vector3d(0, -1, 0), Vector3d(-1, 0, 0)}) {
      const double expected = Integrate(1500, [&](double s, double t) {
        const double phi = 2 * kPiDouble * s;
        const Vector3d normal(0, std::cos(phi), std::sin(phi));
        return Element(Point3d(2 * t - 1, 0.3 * normal.y, 0.3 * normal.z), normal, Point3d(P), n) * 2 * kPiDouble *
               0.3 * 2;
      });
      EXPECT_NEAR(Irradiance(*cylinder, P, n), expected, 2e-3 * expected + 1e-9) << P.x << " " << n.x;
    }
  }
}

// Seen from inside: dark, or all around where both sides emit.
TEST(AreaLights, SidesOfClosedLights) {
  const auto one = Build("sphere", ""), two = Build("sphere", "\"bool twoSided\" true");
  const Point3 inside(0.1f, 0.2f, 0.05f);
  EXPECT_EQ(Irradiance(*one, inside, {0, 0, 1}, 32), 0);
  EXPECT_NEAR(Irradiance(*two, inside, {0, 0, 1}), kPiDouble, 2e-3 * kPiDouble);
  EXPECT_NEAR(Irradiance(*two, {0, 0, -2}, {0, 0, 1}), kPiDouble / 16, 2e-3 * kPiDouble / 16);
  const auto tube = Build("cylinder", "\"bool twoSided\" true");
  // From the middle all but the open ends, which are disks 0.5 away.
  EXPECT_NEAR(Irradiance(*tube, {0, 0, 0}, {1, 0, 0}), kPiDouble * (1 - 0.5), 4e-3);
  EXPECT_EQ(Irradiance(*Build("cylinder", ""), {0, 0, 0}, {1, 0, 0}, 32), 0);
}

LightHit HitAt(const Point3& position, const Normal3& normal, const Vector3& direction,
               const Point2& uv = {0.5f, 0.5f}) {
  LightHit hit;
  hit.position = position;
  hit.normal = normal;
  hit.direction = glm::normalize(direction);
  hit.distance = 1;
  hit.uv = uv;
  return hit;
}

TEST(AreaLights, TheTintOfEveryLight) {
  // intensity · 2^exposure · color / area; the camera sees neither multiplier.
  const auto rect = Build("rect",
                          "\"float width\" 2 \"float height\" 4 \"float intensity\" 3 \"float exposure\" 2 "
                          "\"rgb color\" [ 1 0.5 0.25 ] \"bool normalize\" true \"float diffuse\" 0.5 "
                          "\"float specular\" 4",
                          Transform::Scale({2, 1, 1}));
  const LightHit hit = HitAt(Point3(0.0f), {0, 0, -1}, {0, 0, 1});
  const double radiance = 3.0 * 4 / 16;
  EXPECT_NEAR(rect->light->EvaluateEmissionForCamera(rect->context, hit).g, 0.5 * radiance, 1e-6);
  const auto e = rect->light->EvaluateSamples(rect->context, hit, {0, 0, -1});
  ASSERT_TRUE(e);
  EXPECT_NEAR(e->diffuse.r, 0.5 * radiance, 1e-6);
  EXPECT_NEAR(e->specular.b, 4 * 0.25 * radiance, 1e-6);
  EXPECT_NEAR(rect->light->GetPowerEstimate(rect->context).r, kPiDouble * 12, 1e-4);
  // The power stays when the light is scaled later, evenly or not.
  for (const Transform& later : {Transform::Scale({6, 3, 3}), Transform::Scale({0.1, 5, 1})}) {
    const LightTransform transform{later.ToAffine(), later.Inverse().ToAffine()};
    rect->context.transform = &transform;
    EXPECT_NEAR(rect->light->GetPowerEstimate(rect->context).r, kPiDouble * 12, 1e-4);
  }
  const auto ball = Build("sphere", "\"bool normalize\" true", Transform::Scale(Vector3d(2)));
  EXPECT_NEAR(ball->light->GetPowerEstimate(ball->context).g, kPiDouble, 1e-4);
  const Shape square = test::AsShape(test::Square(2));
  const auto mesh = Build("mesh", "\"bool normalize\" true \"bool twoSided\" true", Transform(), &square);
  EXPECT_NEAR(mesh->light->GetPowerEstimate(mesh->context).g, 2 * kPiDouble, 1e-4);
}

TEST(AreaLights, ConeIsASmoothstepInTheAngleAroundMinusZ) {
  const auto rect = Build("rect",
                          "\"float shaping:cone:angle\" 60 \"float shaping:cone:softness\" 0.5 "
                          "\"bool twoSided\" true");
  const auto at = [&](double degrees) {
    const double a = degrees * kPiDouble / 180;
    const Vector3 outgoing(Vector3d(std::sin(a), 0, -std::cos(a)));
    return static_cast<double>(
        rect->light->EvaluateEmissionForCamera(rect->context, HitAt(Point3(0.0f), {0, 0, -1}, -outgoing)).g);
  };
  EXPECT_NEAR(at(0), 1, 1e-6);
  EXPECT_NEAR(at(29.9), 1, 1e-4);
  const double t = (40.0 - 30) / 30;
  EXPECT_NEAR(at(40), 1 - t * t * (3 - 2 * t), 1e-4);
  EXPECT_EQ(at(60.1), 0);
  EXPECT_EQ(at(170), 0) << "the far side is beyond the cone";
  const auto bounds = rect->light->GetEmissionBounds(rect->context);
  EXPECT_FALSE(bounds->twoSided);
  EXPECT_NEAR(bounds->cosThetaE, 0.5, 2e-3);
  EXPECT_LT(bounds->cosThetaE, 0.5);
}

TEST(AreaLights, FocusIsAPowerOfTheCosine) {
  const auto disk = Build("disk", "\"float shaping:focus\" 3 \"rgb shaping:focusTint\" [ 0 0.5 1 ]");
  const double c = std::cos(0.5);
  const Vector3 outgoing(static_cast<float>(std::sin(0.5)), 0, static_cast<float>(-c));
  const Color seen = disk->light->EvaluateEmissionForCamera(disk->context, HitAt(Point3(0.0f), {0, 0, -1}, -outgoing));
  EXPECT_NEAR(seen.r, c * c * c, 1e-5);
  EXPECT_NEAR(seen.g, 0.5 + 0.5 * c * c * c, 1e-5);
  EXPECT_NEAR(seen.b, 1, 1e-5);
  // ∫ cosθ^(focus + 1) dω = 2π / (focus + 2), times the area.
  EXPECT_NEAR(disk->light->GetPowerEstimate(disk->context).r, 2 * kPiDouble / 5 * kPiDouble / 4, 2e-3);
}

// Rays hit the surface that is sampled, with the same position, normal and uv, and the other way round.
TEST(AreaLights, SurfacesAreTheSampledOnes) {
  for (const char* type : {"rect", "disk", "sphere", "cylinder"}) {
    const auto built = Build(type, "");
    const IntersectableLight* surface = built->light->Surface();
    ASSERT_TRUE(surface) << type;
    EXPECT_FALSE(surface->GetBounds().empty());
    Rng rng(4);
    int found = 0;
    for (int i = 0; i < 500; ++i) {
      built->context.u = rng.NextPoint2();
      const Point3 P(0.9f, -0.8f, -1.5f);
      const auto sample = built->light->GenerateSamples(built->context, P);
      if (!sample) continue;
      LocalRay ray;
      ray.origin = Point3d(P);
      ray.direction = 2.5 * Vector3d(sample->direction);
      ray.tMax = 1e9;
      const auto hit = surface->Intersect(ray);
      if (!hit || std::abs(glm::dot(sample->normal, sample->direction)) < 0.01f) continue;
      ++found;
      EXPECT_NEAR(hit->t * 2.5, static_cast<double>(sample->distance), 1e-4) << type;
      EXPECT_LT(glm::length(hit->position - Point3d(sample->position)), 1e-5) << type;
      EXPECT_LT(glm::length(hit->normal - Vector3d(sample->normal)), 1e-4) << type;
    }
    EXPECT_GT(found, 400) << type;
    LocalRay away;
    away.origin = {0, 0, -3};
    away.direction = {0, 0, -1};
    away.tMax = 1e9;
    EXPECT_FALSE(surface->Intersect(away)) << type;
    away.direction = {0, 0, 1};
    away.tMax = 1;
    EXPECT_FALSE(surface->Intersect(away)) << type << ": beyond the end of the ray";
  }
}

}  // namespace
}  // namespace lampyr
