// Quadrics against a reference in long double that knows no tricks.
#include <gtest/gtest.h>

#include "geometry/quadric.h"
#include "helpers.h"

namespace lampyr {
namespace {

using testing::Place;
using testing::Random;
using testing::SceneOf;
using testing::Sphere;

Quadric PartialSphere() {
  Quadric q = Sphere(2);
  q.zMin = -1.2f;
  q.zMax = 0.7f;
  q.phiMax = 4.1f;
  return q;
}

Quadric PartialDisk() {
  Quadric q;
  q.kind = Quadric::Kind::Disk;
  q.radius = 2;
  q.innerRadius = 0.6f;
  q.zMin = q.zMax = 0.5f;
  q.phiMax = 2.5f;
  return q;
}

Quadric PartialCylinder() {
  Quadric q;
  q.kind = Quadric::Kind::Cylinder;
  q.radius = 1.5f;
  q.zMin = -1;
  q.zMax = 2;
  q.phiMax = 5;
  return q;
}

using Real = long double;

// The nearest root in (0, ∞) that lies on the part of the quadric, or -1; NaN when a limit is too close to call.
Real Reference(const Quadric& q, const Ray& ray) {
  const Real o[3] = {ray.origin.x, ray.origin.y, ray.origin.z},
             d[3] = {ray.direction.x, ray.direction.y, ray.direction.z};
  const Real r = q.radius, zMin = q.zMin, zMax = q.zMax, inner = q.innerRadius, phiMax = q.phiMax;
  Real roots[2] = {-1, -1};
  if (q.kind == Quadric::Kind::Disk) {
    roots[0] = (zMin - o[2]) / d[2];
  } else {
    const int n = q.kind == Quadric::Kind::Sphere ? 3 : 2;
    Real a = 0, b = 0, c = -r * r;
    for (int i = 0; i < n; ++i) a += d[i] * d[i], b += 2 * o[i] * d[i], c += o[i] * o[i];
    const Real discriminant = b * b - 4 * a * c;
    if (std::abs(discriminant) < 1e-4L * b * b + 1e-9L) return std::nan("");
    if (discriminant < 0) return -1;
    roots[0] = (-b - std::sqrt(discriminant)) / (2 * a);
    roots[1] = (-b + std::sqrt(discriminant)) / (2 * a);
  }
  for (const Real t : roots) {
    if (!(t > 0)) continue;
    const Real x = o[0] + t * d[0], y = o[1] + t * d[1], z = o[2] + t * d[2];
    Real phi = std::atan2(y, x);
    if (phi < 0) phi += 2 * 3.14159265358979323846L;
    const Real rho = std::hypot(x, y);
    std::vector<Real> margins;  // all positive: on the shape
    if (phiMax < 6.28L) margins.insert(margins.end(), {phiMax - phi, phi});
    if (q.kind == Quadric::Kind::Disk) {
      margins.insert(margins.end(), {r - rho, rho - inner});
    } else if (!q.IsFullSphere()) {
      margins.insert(margins.end(), {z - zMin, zMax - z});
    }
    bool inside = true;
    for (const Real m : margins) {
      if (std::abs(m) < 1e-5L) return std::nan("");
      inside &= m > 0;
    }
    if (inside) return t;
  }
  return -1;
}

TEST(Quadric, HitsWhatTheReferenceHits) {
  Random random(1);
  int hits = 0, cases = 0;
  for (const Quadric& q : {Sphere(1.3f), PartialSphere(), PartialDisk(), PartialCylinder()}) {
    const GeometryScene scene(SceneOf(q));
    for (int i = 0; i < 40000; ++i) {
      const Ray ray{random.InBox(3), random.Direction()};
      const Real expected = Reference(q, ray);
      if (std::isnan(expected)) continue;
      ++cases;
      RayHit hit;
      ASSERT_EQ(scene.Intersect(ray, visibility::kAll, hit), expected > 0) << i;
      ASSERT_EQ(scene.Occluded(ray, visibility::kAll), expected > 0);
      if (expected <= 0) continue;
      ++hits;
      ASSERT_NEAR(hit.t, static_cast<double>(expected), 2e-6 * (1 + static_cast<double>(expected)));
      const SurfacePoint point = scene.GetSurfacePoint(ray, hit);
      const Point3 at = ray.origin + ray.direction * hit.t;
      ASSERT_LT(glm::length(at - point.position), 1e-5f);
    }
  }
  EXPECT_GT(cases, 150000);
  EXPECT_GT(hits, 15000);
}

// Where the nearest hit is enough, it is the same as the first of both.
TEST(Quadric, TheFirstHitAlone) {
  Random random(6);
  int both = 0;
  for (const Quadric& q : {Sphere(1.3f), PartialSphere(), PartialDisk(), PartialCylinder()}) {
    const PreparedQuadric prepared(q);
    for (int i = 0; i < 20000; ++i) {
      const Ray ray{random.InBox(3), random.Direction()};
      const RayDouble precise{Point3d(ray.origin), Vector3d(ray.direction), 0, 1e30};
      QuadricHit hits[2], first[2];
      const int count = prepared.Intersect(precise, hits);
      both += count == 2;
      ASSERT_EQ(std::min(count, 1), prepared.Intersect(precise, first, 1));
      if (count == 0) continue;
      ASSERT_EQ(hits[0].t, first[0].t);
      ASSERT_EQ(hits[0].coordinates, first[0].coordinates);
    }
  }
  EXPECT_GT(both, 500);
}

TEST(Quadric, ParametersAndTangentsAreConsistent) {
  Random random(2);
  for (const Quadric& q : {Sphere(1.3f), PartialSphere(), PartialDisk(), PartialCylinder()}) {
    const PreparedQuadric prepared(q);
    int found = 0;
    for (int i = 0; i < 40000 && found < 1000; ++i) {
      const Ray ray{random.InBox(3), random.Direction()};
      QuadricHit hits[2];
      if (prepared.Intersect({Point3d(ray.origin), Vector3d(ray.direction), 0, 1e30}, hits) == 0) continue;
      ++found;
      SurfacePoint point;
      prepared.Evaluate(hits[0].coordinates, true, point);
      ASSERT_GE(point.uv.x, 0);
      ASSERT_LE(point.uv.x, 1);
      ASSERT_GE(point.uv.y, 0);
      ASSERT_LE(point.uv.y, 1);
      ASSERT_NEAR(glm::length(point.Ng), 1, 1e-5);
      ASSERT_NEAR(point.uv.x * q.phiMax, std::fmod(std::atan2(point.position.y, point.position.x) + 2 * kPi, 2 * kPi),
                  1e-5);
      if (std::hypot(point.position.x, point.position.y) < 0.05f) continue;
      const Vector3 n = glm::normalize(glm::cross(point.dpdu, point.dpdv));
      ASSERT_GT(glm::dot(n, point.Ng), 0.9999f);
    }
    EXPECT_GE(found, 300);
  }
}

TEST(Quadric, FollowsPbrtParametrisation) {
  // Bottom of the sphere is v = 0, top v = 1; the disk's rim is v = 0; the cylinder's bottom v = 0.
  const auto uvAt = [](const Quadric& q, const Point3& origin, const Vector3& direction) {
    const GeometryScene scene(SceneOf(q));
    RayHit hit;
    const Ray ray{origin, direction};
    EXPECT_TRUE(scene.Intersect(ray, visibility::kAll, hit));
    return scene.GetSurfacePoint(ray, hit).uv;
  };
  EXPECT_NEAR(uvAt(Sphere(1), {0.01f, 0, 5}, {0, 0, -1}).y, 1, 0.01);
  EXPECT_NEAR(uvAt(Sphere(1), {0.01f, 0, -5}, {0, 0, 1}).y, 0, 0.01);
  EXPECT_NEAR(uvAt(Sphere(1), {0, 5, 0}, {0, -1, 0}).x, 0.25, 1e-5);
  Quadric disk = PartialDisk();
  disk.phiMax = 2 * kPi;
  EXPECT_NEAR(uvAt(disk, {1.99f, 0.001f, 5}, {0, 0, -1}).y, 0.01 / 1.4, 1e-3);
  EXPECT_NEAR(uvAt(disk, {-1.3f, 0, 5}, {0, 0, -1}).x, 0.5, 1e-5);
  EXPECT_NEAR(uvAt(PartialCylinder(), {5, 0.1f, -0.4f}, {-1, 0, 0}).y, 0.2, 1e-5);
}

TEST(Quadric, OutsideIsOutsideUnderMirroring) {
  const Transform placements[] = {Transform::Scale({1, 1, 1}), Transform::Scale({-1, 1, 1}),
                                  Transform::Scale({2, -3, 1}),
                                  Transform::Rotate(40, {1, 2, 3}) * Transform::Scale({-1, -2, -1})};
  for (const Transform& placement : placements) {
    for (const bool reverse : {false, true}) {
      const GeometryScene scene(SceneOf(Place(Sphere(1), placement, reverse)));
      Random random(3);
      for (int i = 0; i < 200; ++i) {
        const Ray ray{Point3(0.0f), random.Direction()};
        RayHit hit;
        ASSERT_TRUE(scene.Intersect(ray, visibility::kAll, hit));
        ASSERT_EQ(glm::dot(scene.GetSurfacePoint(ray, hit).Ng, ray.direction) > 0, !reverse);
      }
    }
  }
}

TEST(Quadric, TinyAndFar) {
  // Radius 1e-6 seen from 1e6: aimed at its middle it is hit, and twice its radius beside it is missed.
  const Quadric q = Sphere(1e-6f);
  const PreparedQuadric prepared(q);
  Random random(4);
  for (int i = 0; i < 1000; ++i) {
    const Vector3d direction = glm::normalize(Vector3d(random.Direction()));
    const Vector3d side = glm::normalize(glm::cross(direction, Vector3d(random.Direction())));
    QuadricHit hits[2];
    EXPECT_EQ(prepared.Intersect({direction * -1e6 + side * 0.9e-6, direction, 0, 1e30}, hits), 2);
    EXPECT_EQ(prepared.Intersect({direction * -1e6 + side * 1.1e-6, direction, 0, 1e30}, hits), 0);
  }
  const GeometryScene scene(SceneOf(q));
  RayHit hit;
  const Ray ray{{0, 0, 1e6f}, {0, 0, -1}};
  ASSERT_TRUE(scene.Intersect(ray, visibility::kAll, hit));
  const SurfacePoint point = scene.GetSurfacePoint(ray, hit);
  EXPECT_NEAR(glm::length(point.position) / 1e-6f, 1, 1e-5);
  EXPECT_GT(point.Ng.z, 0.999f);
}

TEST(Quadric, GrazingAndDegenerateRaysGiveNoNaN) {
  Random random(5);
  for (const float size : {1e-6f, 1.0f, 1e6f}) {
    Quadric q = Sphere(size);
    const GeometryScene scene(SceneOf(q));
    for (int i = 0; i < 5000; ++i) {
      // Tangent to the sphere, give or take an ulp.
      const Vector3 n = random.Direction(), d = glm::normalize(glm::cross(n, random.Direction()));
      const Ray ray{n * size - d * size * random.Uniform(0, 10), d};
      RayHit hit;
      if (!scene.Intersect(ray, visibility::kAll, hit)) continue;
      const SurfacePoint p = scene.GetSurfacePoint(ray, hit);
      ASSERT_TRUE(IsFinite(p.position) && IsFinite(p.Ng) && IsFinite(p.dpdu) && IsFinite(p.dpdv));
      ASSERT_NEAR(glm::length(p.position) / size, 1, 1e-5);
    }
  }
}

TEST(Quadric, Areas) {
  const double pi = 3.14159265358979323846;
  EXPECT_NEAR(GetArea(Sphere(2)) / (16 * pi), 1, 1e-6);
  EXPECT_NEAR(GetArea(Place(Sphere(1), Transform::Scale({2, 2, 2}))) / (16 * pi), 1, 1e-6);
  EXPECT_NEAR(GetArea(PartialSphere()) / (2 * 4.1 * 1.9), 1, 1e-6);
  EXPECT_NEAR(GetArea(PartialDisk()) / (0.5 * 2.5 * (4 - 0.36)), 1, 1e-6);
  EXPECT_NEAR(GetArea(PartialCylinder()) / (1.5 * 5 * 3), 1, 1e-6);
  // Prolate spheroid a = 1, c = 3: 2πa² (1 + c/(ae) asin e); oblate a = 3, c = 1: 2πa² (1 + (1-e²)/e atanh e).
  const double e = std::sqrt(1 - 1.0 / 9);
  EXPECT_NEAR(GetArea(Place(Sphere(1), Transform::Scale({1, 1, 3}))) / (2 * pi * (1 + 3 / e * std::asin(e))), 1, 1e-5);
  EXPECT_NEAR(
      GetArea(Place(Sphere(1), Transform::Scale({3, -3, 1}))) / (18 * pi * (1 + (1 - e * e) / e * std::atanh(e))), 1,
      1e-5);
  // The same spheroid along other axes.
  EXPECT_NEAR(GetArea(Place(Sphere(1), Transform::Rotate(30, {1, 1, 0}) * Transform::Scale({3, 1, 1}))) /
                  (2 * pi * (1 + 3 / e * std::asin(e))),
              1, 1e-5);
  // Flattened a hundredfold it is two disks, almost.
  EXPECT_NEAR(GetArea(Place(Sphere(1), Transform::Scale({1, 0.001, 1}))) / (2 * pi), 1, 1e-4);
}

TEST(Quadric, BoundsHoldEveryHit) {
  Random random(6);
  const Transform placement =
      Transform::Translate({10, -20, 5}) * Transform::Rotate(33, {1, 2, 3}) * Transform::Scale({1, 2, 0.3});
  for (const Quadric& q : {Sphere(1.3f), PartialSphere(), PartialDisk(), PartialCylinder()}) {
    const Quadric placed = Place(q, placement);
    const Bounds3 bounds = GetBounds(placed);
    const GeometryScene scene(SceneOf(placed));
    int hits = 0;
    for (int i = 0; i < 20000; ++i) {
      const Point3 target = Point3(10, -20, 5) + random.InBox(3);
      const Ray ray{target - random.Direction() * 10.0f, random.Direction()};
      RayHit hit;
      const Ray aimed{ray.origin, glm::normalize(target - ray.origin)};
      if (!scene.Intersect(aimed, visibility::kAll, hit)) continue;
      ++hits;
      const Point3 p = scene.GetSurfacePoint(aimed, hit).position;
      for (int k = 0; k < 3; ++k) {
        ASSERT_GE(p[k], bounds.min[k]);
        ASSERT_LE(p[k], bounds.max[k]);
      }
    }
    EXPECT_GT(hits, 500);
  }
}

}  // namespace
}  // namespace lampyr
