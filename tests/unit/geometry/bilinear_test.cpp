// Bilinear patches: hits lie on the patch and on the ray, planar ones equal triangles, neighbours do not leak.
#include <gtest/gtest.h>

#include "geometry/bilinear.h"
#include "helpers.h"

namespace lampyr {
namespace {

using testing::Random;
using testing::SceneOf;

BilinearMesh Patch(const std::vector<Point3>& corners) {
  BilinearMesh mesh;
  mesh.positions = corners;
  mesh.patches = {{0, 1, 2, 3}};
  return mesh;
}

Shape ToShape(BilinearMesh mesh) {
  return std::make_shared<const BilinearMesh>(std::move(mesh));
}

Vector3d PointOn(const BilinearMesh& m, double u, double v) {
  return (Vector3d(m.positions[0]) * (1 - u) + Vector3d(m.positions[1]) * u) * (1 - v) +
         (Vector3d(m.positions[2]) * (1 - u) + Vector3d(m.positions[3]) * u) * v;
}

TEST(Bilinear, FindsEveryPointItIsAimedAt) {
  Random random(51);
  for (int i = 0; i < 200; ++i) {
    const BilinearMesh mesh = Patch({random.InBox(1), random.InBox(1), random.InBox(1), random.InBox(1)});
    for (int k = 0; k < 100; ++k) {
      const double u = static_cast<double>(random.Uniform()), v = static_cast<double>(random.Uniform());
      const Vector3d target = PointOn(mesh, u, v), direction(random.Direction());
      PatchHit hits[2];
      const int count = IntersectPatch(mesh, 0, {target - direction * 3.0, direction, 0, 3.0001}, hits);
      ASSERT_GE(count, 1);
      bool found = false;
      for (int j = 0; j < count; ++j) {
        found |= std::abs(hits[j].t - 3) < 1e-4;
        const Vector3d at = target + direction * (hits[j].t - 3);
        const auto uv = hits[j].uv;
        ASSERT_LT(glm::length(at - PointOn(mesh, static_cast<double>(uv.x), static_cast<double>(uv.y))), 1e-5);
      }
      ASSERT_TRUE(found);
      ASSERT_TRUE(count < 2 || hits[0].t <= hits[1].t);
    }
  }
}

TEST(Bilinear, PlanarOnesEqualTwoTriangles) {
  Random random(52);
  const BilinearMesh mesh = Patch({{0, 0, 0}, {2, 0, 0}, {0.3f, 1, 0}, {1.5f, 1.4f, 0}});
  TriangleMesh triangles;
  triangles.positions = mesh.positions;
  triangles.triangles = {{0, 1, 3}, {0, 3, 2}};
  const GeometryScene a(SceneOf(ToShape(mesh))), b(SceneOf(testing::MeshShape(triangles)));
  int hits = 0, different = 0;
  for (int i = 0; i < 20000; ++i) {
    const Ray ray{random.InBox(2), random.Direction()};
    RayHit hitA, hitB;
    const bool x = a.Intersect(ray, visibility::kAll, hitA), y = b.Intersect(ray, visibility::kAll, hitB);
    if (x != y) ++different;
    if (!x || !y) continue;
    ++hits;
    ASSERT_NEAR(hitA.t, hitB.t, 1e-5f * (1 + hitA.t));
    ASSERT_GT(a.GetSurfacePoint(ray, hitA).Ng.z, 0.999999f);
  }
  EXPECT_GT(hits, 500);
  EXPECT_LE(different, 2);
}

TEST(Bilinear, UvAndTangents) {
  BilinearMesh mesh = Patch({{0, 0, 0}, {2, 0, 0}, {0, 3, 0}, {2, 3, 0}});
  const Ray ray{{0.5f, 0.75f, 1}, {0, 0, -1}};
  const auto at = [&ray](const BilinearMesh& m) {
    const GeometryScene scene(SceneOf(ToShape(m)));
    RayHit hit;
    EXPECT_TRUE(scene.Intersect(ray, visibility::kAll, hit));
    return scene.GetSurfacePoint(ray, hit);
  };
  SurfacePoint p = at(mesh);
  EXPECT_NEAR(glm::length(p.uv - Point2(0.25f, 0.25f)), 0, 1e-6);
  EXPECT_NEAR(glm::length(p.dpdu - Vector3(2, 0, 0)), 0, 1e-6);
  EXPECT_NEAR(glm::length(p.dpdv - Vector3(0, 3, 0)), 0, 1e-6);
  mesh.uvs = {{1, 0}, {0, 0}, {1, 0.5f}, {0, 0.5f}};
  mesh.flipNormals = true;
  p = at(mesh);
  EXPECT_NEAR(glm::length(p.uv - Point2(0.75f, 0.125f)), 0, 1e-6);
  EXPECT_NEAR(glm::length(p.dpdu - Vector3(-2, 0, 0)), 0, 1e-6);
  EXPECT_NEAR(glm::length(p.dpdv - Vector3(0, 6, 0)), 0, 1e-6);
  EXPECT_EQ(p.Ng.z, -1);
  mesh.normals.assign(4, Normal3(0, 0, 1));
  EXPECT_EQ(at(mesh).Ng.z, 1);
  mesh.uvs.assign(4, Point2(0.5f));
  EXPECT_EQ(at(mesh).dpdu, Vector3(0.0f));
}

TEST(Bilinear, AreaAndDegenerateOnes) {
  EXPECT_NEAR(GetArea(ToShape(Patch({{0, 0, 0}, {2, 0, 0}, {0, 3, 0}, {2, 3, 0}}))), 6, 1e-6);
  // A hyperbolic paraboloid z = uv over the unit square: ∫∫ √(1 + u² + v²) = 1.28078898…
  EXPECT_NEAR(GetArea(ToShape(Patch({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 1}}))), 1.2807892, 2e-6);
  Random random(53);
  for (const BilinearMesh& mesh :
       {Patch(std::vector<Point3>(4, Point3(0.0f))), Patch({{0, 0, 0}, {1, 0, 0}, {0, 0, 0}, {1, 0, 0}}),
        Patch({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1, 1, 0}})}) {
    const GeometryScene scene(SceneOf(ToShape(mesh)));
    for (int i = 0; i < 2000; ++i) {
      const Ray ray{random.InBox(1), random.Direction()};
      RayHit hit{1, 0, 0, kNoIndex, random.Uniform(), 1};
      scene.Intersect(ray, visibility::kAll, hit);
      const SurfacePoint p = scene.GetSurfacePoint(ray, hit);
      ASSERT_TRUE(IsFinite(p.position) && IsFinite(p.Ng) && IsFinite(p.dpdu));
      ASSERT_NEAR(glm::length(p.Ng), 1, 1e-5);
    }
  }
}

// A closed box of six curved faces: nothing leaks, and rays leaving it outwards from its surface hit nothing for planar
// faces.
TEST(Bilinear, ClosedBoxDoesNotLeak) {
  for (const float scale : {1e-3f, 1.0f, 1e3f}) {
    Random random(54);
    BilinearMesh mesh;
    for (int i = 0; i < 8; ++i) {
      mesh.positions.push_back((Vector3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1) + random.InBox(0.2f)) * scale);
    }
    mesh.patches = {{0, 2, 1, 3}, {4, 5, 6, 7}, {0, 1, 4, 5}, {2, 6, 3, 7}, {0, 4, 2, 6}, {1, 3, 5, 7}};
    const GeometryScene scene(SceneOf(ToShape(mesh)));
    int leaks = 0, stuck = 0;
    for (int i = 0; i < 50000; ++i) {
      const Ray ray{random.InBox(0.3f) * scale, random.Direction()};
      RayHit hit;
      if (!scene.Intersect(ray, visibility::kAll, hit)) {
        ++leaks;
        continue;
      }
      const SurfacePoint p = scene.GetSurfacePoint(ray, hit);
      ASSERT_GT(glm::dot(p.Ng, ray.direction), -0.1f);
      // Along the normal away from the box, and back inside.
      stuck += scene.Occluded(SpawnRay(p, p.Ng, 0), visibility::kAll);
      stuck += !scene.Occluded(SpawnRay(p, -p.Ng, 0), visibility::kAll);
    }
    EXPECT_EQ(leaks, 0) << scale;
    EXPECT_EQ(stuck, 0) << scale;
  }
}

}  // namespace
}  // namespace lampyr
