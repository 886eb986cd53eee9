// Rays that start on a surface do not find it again where they cannot, closed meshes do not leak, shadow rays reach
// their light: at every scale and place.
#include <gtest/gtest.h>

#include "helpers.h"

namespace lampyr {
namespace {

using testing::MeshShape;
using testing::NoisySphere;
using testing::Place;
using testing::Random;
using testing::SceneOf;
using testing::Sphere;

struct Setting {
  float scale;
  float shift;  // in sizes of the scene
};
constexpr Setting kSettings[] = {{1, 0}, {1e-3f, 0}, {1e3f, 0}, {1, 100}, {1e-3f, 1e4f}, {1, 1e4f}, {1e3f, 1e4f}};

TEST(Leaks, NoneFromInsideAClosedMesh) {
  for (const Setting& s : kSettings) {
    const Point3 center = Vector3(1, 0.7f, -0.4f) * (s.shift * s.scale);
    const GeometryScene scene(SceneOf(MeshShape(NoisySphere(60, s.scale, center, 0.02f, 7))));
    Random random(8);
    int leaks = 0;
    for (int i = 0; i < 100000; ++i) {
      RayHit hit;
      const Ray ray{center + random.InBox(0.4f) * s.scale, random.Direction()};
      if (!scene.Intersect(ray, visibility::kAll, hit)) ++leaks;
    }
    EXPECT_EQ(leaks, 0) << s.scale << " " << s.shift;
  }
}

// From points on a convex shape: outwards nothing is hit, inwards something is.
void CheckConvex(const GeometryScene& scene, const Point3& center, float size, int count, const char* what,
                 const Setting& s) {
  // A position 1e4 sizes away is known to a thousandth of the size: so near an edge, inside may be outside.
  const float allowedInwardsMisses = s.shift >= 1e4f ? 2e-3f : 0;
  Random random(9);
  int outwards = 0, inwards = 0, tried = 0;
  for (int i = 0; i < count; ++i) {
    const Ray ray{center + random.InBox(0.3f) * size, random.Direction()};
    RayHit hit;
    if (!scene.Intersect(ray, visibility::kAll, hit)) continue;
    ++tried;
    const SurfacePoint p = scene.GetSurfacePoint(ray, hit);
    ASSERT_GT(glm::dot(p.Ng, ray.direction), 0);  // the normal is outside
    Vector3 d = random.Direction();
    if (i % 2) d = glm::normalize(d - p.Ng * glm::dot(d, p.Ng) + p.Ng * 1e-3f);  // grazing
    if (glm::dot(d, p.Ng) < 0) d = -d;
    outwards += scene.Occluded(SpawnRay(p, d, 0), visibility::kAll);
    if (glm::dot(d, p.Ng) > 0.05f) inwards += !scene.Occluded(SpawnRay(p, -d, 0), visibility::kAll);
  }
  EXPECT_GT(tried, count * 9 / 10);
  EXPECT_EQ(outwards, 0) << what << " scale " << s.scale << " shift " << s.shift;
  EXPECT_LE(inwards, allowedInwardsMisses * static_cast<float>(tried))
      << what << " scale " << s.scale << " shift " << s.shift;
}

TriangleMesh Box(float half, const Point3& center) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.positions.push_back(center + Vector3(i & 1 ? half : -half, i & 2 ? half : -half, i & 4 ? half : -half));
  }
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

TEST(SelfIntersection, NoneOnMeshesAndQuadrics) {
  for (const Setting& s : kSettings) {
    const Point3 center = Vector3(1, 0.7f, -0.4f) * (s.shift * s.scale);
    const Transform there = Transform::Translate(Vector3d(center)) * Transform::Rotate(25, {1, 2, 3}) *
                            Transform::Scale(Vector3d(static_cast<double>(s.scale)));
    CheckConvex(GeometryScene(SceneOf(MeshShape(Box(s.scale, center)))), center, s.scale, 20000, "box", s);
    CheckConvex(GeometryScene(SceneOf(Place(Sphere(1), there))), center, s.scale, 20000, "sphere", s);
    const Transform flat = there * Transform::Scale({1, -0.5, 1.5});
    CheckConvex(GeometryScene(SceneOf(Place(Sphere(1), flat))), center, s.scale, 20000, "ellipsoid", s);
  }
}

TEST(SelfIntersection, NoneOnInstances) {
  for (const Setting& s : kSettings) {
    const Point3 center = Vector3(1, 0.7f, -0.4f) * (s.shift * s.scale);
    const Transform there = Transform::Translate(Vector3d(center)) * Transform::Rotate(25, {1, 2, 3}) *
                            Transform::Scale(Vector3d(static_cast<double>(s.scale)) * Vector3d(1, 0.6, -1));
    for (const bool sphere : {false, true}) {
      GeometryDescription description;
      description.objects.resize(1);
      if (sphere) {
        description.objects[0].entries.push_back(testing::Entry(Sphere(1)));
      } else {
        description.objects[0].entries.push_back(testing::Entry(MeshShape(Box(1, Point3(0.0f)))));
      }
      description.instances.push_back({0, there.ToAffine(), there.Inverse().ToAffine(), 0});
      const GeometryScene scene(std::move(description));
      CheckConvex(scene, center, s.scale, 20000, sphere ? "instanced sphere" : "instanced box", s);
    }
  }
}

TEST(SpawnRayTo, ReachesALightAndIsStoppedByAWall) {
  // Between the floor and a sphere above it: never occluded where the two see each other; always with a wall between.
  for (const Setting& s : kSettings) {
    const Point3 center = Vector3(1, 0.7f, -0.4f) * (s.shift * s.scale);
    const auto plane = [&](float z, float half) {
      TriangleMesh mesh;
      for (int i = 0; i < 4; ++i) {
        mesh.positions.push_back(center + Vector3(i & 1 ? half : -half, i & 2 ? half : -half, z) * s.scale);
      }
      mesh.triangles = {{0, 1, 3}, {0, 3, 2}};
      return mesh;
    };
    const Transform there = Transform::Translate(Vector3d(center) + Vector3d(0, 0, static_cast<double>(s.scale))) *
                            Transform::Scale(Vector3d(static_cast<double>(s.scale)));
    GeometryDescription description;
    description.entries.push_back(testing::Entry(MeshShape(plane(0, 2))));
    description.entries.push_back(testing::Entry(Place(Sphere(0.1f), there)));
    const GeometryScene open(description);
    description.entries.push_back(testing::Entry(MeshShape(plane(0.5f, 4))));
    const GeometryScene closed(std::move(description));

    Random random(11);
    int blocked = 0, seen = 0, cases = 0;
    for (int i = 0; i < 20000; ++i) {
      const Ray down{center + Vector3(random.Uniform(-1.9f, 1.9f), random.Uniform(-1.9f, 1.9f), 0.4f) * s.scale,
                     {0, 0, -1}};
      const Vector3 direction = random.Direction();
      const Ray in{center + Vector3(0, 0, s.scale) + direction * (2 * s.scale), -direction};
      RayHit floorHit, lightHit;
      if (!open.Intersect(down, visibility::kAll, floorHit) || !open.Intersect(in, visibility::kAll, lightHit))
        continue;
      const SurfacePoint floor = open.GetSurfacePoint(down, floorHit), light = open.GetSurfacePoint(in, lightHit);
      // Facing, but for angles that the rounding of a scene 1e4 sizes away cannot tell from grazing.
      if (lightHit.primitive != 1 || glm::dot(glm::normalize(floor.position - light.position), light.Ng) < 0.03f)
        continue;
      ++cases;
      blocked += open.Occluded(SpawnRayTo(floor, light.position, light.positionError, light.Ng, 0), visibility::kAll);
      seen += !closed.Occluded(SpawnRayTo(floor, light.position, light.positionError, light.Ng, 0), visibility::kAll);
    }
    EXPECT_GT(cases, 4000);
    EXPECT_EQ(blocked, 0) << s.scale << " " << s.shift;
    EXPECT_EQ(seen, 0) << s.scale << " " << s.shift;
  }
}

TEST(SpawnRayTo, CoincidentPointsGiveAnEmptyRay) {
  SurfacePoint p;
  p.position = {1, 2, 3};
  const Ray ray = SpawnRayTo(p, p.position, Vector3(0.0f), Normal3(0.0f), 0);
  EXPECT_EQ(ray.tMax, 0);
  EXPECT_NEAR(glm::length(ray.direction), 1, 1e-6);
}

TEST(OffsetRayOrigin, LeavesTheErrorBoxToTheSideOfTheDirection) {
  Random random(12);
  for (int i = 0; i < 10000; ++i) {
    const Normal3 n = random.Direction();
    const Vector3 error(random.Uniform(0, 1e-4f), random.Uniform(0, 1e-4f), random.Uniform(0, 1e-4f));
    const Point3 p = random.InBox(10);
    const Vector3 d = random.Direction();
    const Vector3d moved = Vector3d(OffsetRayOrigin(p, error, n, d)) - Vector3d(p);
    const double side = glm::dot(d, n) < 0 ? -1 : 1;
    ASSERT_GE(side * glm::dot(moved, Vector3d(n)),
              glm::dot(Vector3d(glm::abs(n)), Vector3d(error)) * (1 - 1e-5) - 1e-12);
  }
}

}  // namespace
}  // namespace lampyr
