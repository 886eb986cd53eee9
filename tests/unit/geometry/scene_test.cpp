// GeometryScene: hits and surface points on meshes, instances against their baked copies, cut-outs, visibility, the
// gate.
#include <gtest/gtest.h>

#include <gmock/gmock.h>

#include "base/error.h"
#include "helpers.h"

namespace lampyr {
namespace {

using testing::Entry;
using testing::MeshShape;
using testing::NoisySphere;
using testing::Place;
using testing::Random;
using testing::SceneOf;
using testing::Sphere;

TriangleMesh UnitTriangle() {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}};
  return mesh;
}

SurfacePoint HitFromAbove(const GeometryScene& scene, float x, float y) {
  const Ray ray{{x, y, 1}, {0, 0, -1}};
  RayHit hit;
  EXPECT_TRUE(scene.Intersect(ray, visibility::kAll, hit));
  return scene.GetSurfacePoint(ray, hit);
}

TEST(Scene, EmptySceneHitsNothing) {
  const GeometryScene scene{GeometryDescription{}};
  RayHit hit;
  EXPECT_FALSE(scene.Intersect({Point3(0.0f), {0, 0, 1}}, visibility::kAll, hit));
  EXPECT_FALSE(scene.Occluded({Point3(0.0f), {0, 0, 1}}, visibility::kAll));
  EXPECT_TRUE(scene.GetBounds().IsEmpty());
  EXPECT_EQ(scene.GetBoundingSphere().radius, 1);
  EXPECT_EQ(scene.PrimitiveCount(), 0u);
  const GeometryScene emptyMesh(SceneOf(MeshShape(TriangleMesh{})));
  EXPECT_FALSE(emptyMesh.Intersect({Point3(0.0f), {0, 0, 1}}, visibility::kAll, hit));
  EXPECT_EQ(emptyMesh.GetBoundingSphere().radius, 1);
}

TEST(Triangle, MatchesTheReference) {
  Random random(21);
  int hits = 0;
  for (int i = 0; i < 300; ++i) {
    TriangleMesh mesh;
    mesh.positions = {random.InBox(1), random.InBox(1), random.InBox(1)};
    mesh.triangles = {{0, 1, 2}};
    const GeometryScene scene(SceneOf(MeshShape(mesh)));
    const Vector3d a(mesh.positions[0]), b(mesh.positions[1]), c(mesh.positions[2]);
    for (int k = 0; k < 100; ++k) {
      const Ray ray{random.InBox(2), random.Direction()};
      const Vector3d o(ray.origin), d(ray.direction), p = glm::cross(d, c - a);
      const double det = glm::dot(b - a, p);
      const double u = glm::dot(o - a, p) / det;
      const Vector3d q = glm::cross(o - a, b - a);
      const double v = glm::dot(d, q) / det, t = glm::dot(c - a, q) / det;
      const double margin = std::min({u, v, 1 - u - v, t});
      if (std::abs(margin) < 1e-4) continue;
      RayHit hit;
      ASSERT_EQ(scene.Intersect(ray, visibility::kAll, hit), margin > 0);
      if (margin < 0) continue;
      ++hits;
      ASSERT_NEAR(hit.t, t, 1e-4 * t);
      const SurfacePoint point = scene.GetSurfacePoint(ray, hit);
      // The bound is about the plane that the point is on, not about where the ray met it.
      const Vector3d n = glm::normalize(glm::cross(b - a, c - a));
      ASSERT_LE(std::abs(glm::dot(Vector3d(point.position) - a, n)),
                glm::dot(glm::abs(n), Vector3d(point.positionError)));
      ASSERT_GT(glm::dot(n, Vector3d(point.Ng)), 0.9999);
    }
  }
  EXPECT_GT(hits, 300);
}

TEST(Triangle, TextureCoordinatesAndTangents) {
  TriangleMesh mesh = UnitTriangle();
  SurfacePoint p = HitFromAbove(GeometryScene(SceneOf(MeshShape(mesh))), 0.25f, 0.5f);
  // Without uv the corners are (0,0), (1,0), (1,1).
  EXPECT_NEAR(p.uv.x, 0.75, 1e-6);
  EXPECT_NEAR(p.uv.y, 0.5, 1e-6);
  EXPECT_NEAR(glm::length(p.dpdu - Vector3(1, 0, 0)), 0, 1e-6);
  EXPECT_NEAR(glm::length(p.dpdv - Vector3(-1, 1, 0)), 0, 1e-6);

  // Tiny texture coordinates are as good as any: p = (u, v) · 1e5.
  mesh.uvs = {{0, 0}, {1e-5f, 0}, {0, 1e-5f}};
  p = HitFromAbove(GeometryScene(SceneOf(MeshShape(mesh))), 0.25f, 0.5f);
  EXPECT_NEAR(glm::length(p.dpdu * 1e-5f - Vector3(1, 0, 0)), 0, 1e-5);
  EXPECT_NEAR(glm::length(p.dpdv * 1e-5f - Vector3(0, 1, 0)), 0, 1e-5);

  mesh.uvs = {{0, 0}, {1, 1}, {2, 2}};
  p = HitFromAbove(GeometryScene(SceneOf(MeshShape(mesh))), 0.25f, 0.5f);
  EXPECT_EQ(p.dpdu, Vector3(0.0f));
  EXPECT_EQ(p.dpdv, Vector3(0.0f));
}

TEST(Triangle, SidesFollowWindingFlipAndVertexNormals) {
  TriangleMesh mesh = UnitTriangle();
  EXPECT_EQ(HitFromAbove(GeometryScene(SceneOf(MeshShape(mesh))), 0.2f, 0.2f).Ng.z, 1);
  mesh.flipNormals = true;
  EXPECT_EQ(HitFromAbove(GeometryScene(SceneOf(MeshShape(mesh))), 0.2f, 0.2f).Ng.z, -1);
  mesh.normals.assign(3, glm::normalize(Vector3(0.5f, 0, 1)));
  const SurfacePoint p = HitFromAbove(GeometryScene(SceneOf(MeshShape(mesh))), 0.2f, 0.2f);
  EXPECT_EQ(p.Ng.z, 1);
  EXPECT_NEAR(glm::length(p.Ns - mesh.normals[0]), 0, 1e-6);
  mesh.normals.assign(3, Normal3(0.0f));  // nothing to interpolate: the geometric normal
  EXPECT_EQ(HitFromAbove(GeometryScene(SceneOf(MeshShape(mesh))), 0.2f, 0.2f).Ns.z, -1);
}

TEST(Triangle, WithoutAreaNeverGivesNaN) {
  Random random(22);
  for (const float width : {0.0f, 1e-44f, 1e-30f, 1e-20f, 1e-10f, 1e-7f}) {
    TriangleMesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0.5f, width, 0}, {0, 0, 0}};
    mesh.triangles = {{0, 1, 2}, {0, 0, 0}, {1, 1, 2}, {0, 3, 0}};
    const GeometryScene scene(SceneOf(MeshShape(mesh)));
    for (int i = 0; i < 2000; ++i) {
      const Point3 target(random.Uniform(), 0, 0);
      const Vector3 d = random.Direction();
      const Ray ray{target - d, d};
      RayHit hit;
      if (!scene.Intersect(ray, visibility::kAll, hit))
        hit = {1, 0, static_cast<uint32_t>(i % 4), kNoIndex, 0.3f, 0.3f};
      const SurfacePoint p = scene.GetSurfacePoint(ray, hit);
      ASSERT_TRUE(IsFinite(p.position) && IsFinite(p.Ng) && IsFinite(p.Ns) && IsFinite(p.dpdu) && IsFinite(p.dpdv));
      ASSERT_NEAR(glm::length(p.Ng), 1, 1e-5);
    }
  }
}

TEST(Triangle, NormalsOfTinyAndHugeOnes) {
  for (const float size : {1e-18f, 1e-12f, 1e-6f, 1e6f, 1e12f}) {
    TriangleMesh mesh = UnitTriangle();
    for (Point3& p : mesh.positions) p *= size;
    const GeometryScene scene(SceneOf(MeshShape(mesh)));
    EXPECT_EQ(scene.GetSurfacePoint({{0, 0, size}, {0, 0, -1}}, {size, 0, 0, kNoIndex, 0.3f, 0.3f}).Ng.z, 1) << size;
  }
}

TEST(Gate, RejectsWhatEmbreeDoesNotSurvive) {
  const GeometryScene scene(SceneOf(Sphere(1)));
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const Ray bad[] = {{{nan, 0, 0}, {0, 0, 1}},         {{0, kInfinity, 0}, {0, 0, 1}},    {{0, 0, 1e20f}, {0, 0, 1}},
                     {{0, 0, 0}, {0, nan, 1}},         {{0, 0, 0}, {0, kInfinity, 1}},    {{0, 0, 0}, {0, 0, 0}},
                     {{0, 0, 0}, {0, 0, 1e20f}},       {{0, 0, 0}, {0, 0, 1}, nan},       {{0, 0, 0}, {0, 0, 1}, -1},
                     {{-3e38f, 0, 0}, {0, 0, -3e38f}}, {{0, 0, 0}, {0, 0, 1}, -kInfinity}};
  uint64_t count = 0;
  for (const Ray& ray : bad) {
    RayHit hit;
    hit.patch = 77;
    Color passed(1.0f);
    EXPECT_FALSE(scene.Intersect(ray, visibility::kAll, hit, passed));
    EXPECT_TRUE(passed.IsBlack());
    EXPECT_TRUE(scene.Occluded(ray, visibility::kAll));
    EXPECT_EQ(hit.patch, 77u);
    count += 2;
    EXPECT_EQ(scene.RejectedRays(), count);
  }
  RayHit hit;
  EXPECT_TRUE(scene.Intersect({{0, 0, 0}, {0, 0, 1}, kInfinity}, visibility::kAll, hit));
  EXPECT_TRUE(scene.Intersect({{0, 0, 1e17f}, {0, 0, -1}}, visibility::kAll, hit));
  EXPECT_FALSE(scene.Intersect({{0, 0, 0}, {0, 0, 1}, 0}, visibility::kAll, hit));
  EXPECT_EQ(scene.RejectedRays(), count);
}

TEST(Gate, HoldsInsideScalingInstances) {
  GeometryDescription description;
  description.objects.resize(1);
  description.objects[0].entries.push_back(Entry(Sphere(1)));
  const Transform tiny = Transform::Scale(Vector3d(1e-6));
  description.instances.push_back({0, tiny.ToAffine(), tiny.Inverse().ToAffine(), 0});
  const GeometryScene scene(std::move(description));
  RayHit hit;
  EXPECT_FALSE(scene.Intersect({{0, 0, 9e17f}, {0, 0, -1}}, visibility::kAll, hit));
  EXPECT_EQ(scene.RejectedRays(), 1u);
  EXPECT_TRUE(scene.Intersect({{0, 0, 1}, {0, 0, -1}}, visibility::kAll, hit));
}

TEST(Scene, IntervalAndVisibility) {
  GeometryDescription description;
  description.entries.push_back(Entry(MeshShape(UnitTriangle())));
  description.entries.back().attributes.visibility = visibility::kShadow | visibility::kIndirect;
  description.entries.push_back(Entry(Sphere(0.5f)));
  description.entries.back().attributes.visibility = visibility::kCamera;
  const GeometryScene scene(std::move(description));
  const Ray down{{0.1f, 0.1f, 2}, {0, 0, -1}};
  RayHit hit;
  ASSERT_TRUE(scene.Intersect(down, visibility::kCamera, hit));
  EXPECT_EQ(hit.primitive, 1u);
  ASSERT_TRUE(scene.Intersect(down, visibility::kIndirect, hit));
  EXPECT_EQ(hit.primitive, 0u);
  // Embree divides by an approximate reciprocal, and by another one on other processors.
  const float t = hit.t;
  EXPECT_NEAR(t, 2, 5e-7);
  EXPECT_TRUE(scene.Occluded(down, visibility::kShadow));
  EXPECT_FALSE(scene.Occluded({down.origin, down.direction, t}, visibility::kShadow));       // open above
  EXPECT_TRUE(scene.Intersect({down.origin, down.direction, t}, visibility::kShadow, hit));  // closed above
  EXPECT_TRUE(scene.Occluded({down.origin, down.direction, 2.001f}, visibility::kShadow));
  EXPECT_FALSE(scene.Occluded({{0.1f, 0.1f, 0}, {0, 0, 1}}, visibility::kShadow));  // open below
}

TEST(Scene, BadMeshesAreErrors) {
  TriangleMesh mesh = UnitTriangle();
  mesh.triangles.push_back({0, 1, 3});
  EXPECT_THROW(GeometryScene(SceneOf(MeshShape(mesh))), Error);
  mesh = UnitTriangle();
  mesh.positions[1].y = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(GeometryScene(SceneOf(MeshShape(mesh))), Error);
  mesh = UnitTriangle();
  mesh.normals.resize(2);
  EXPECT_THROW(GeometryScene(SceneOf(MeshShape(mesh))), Error);
  Quadric q = Sphere(1);
  q.toRender.linear = glm::mat3(0.0f);
  EXPECT_THROW(GeometryScene(SceneOf(q)), Error);
  GeometryDescription description;
  description.instances.push_back({});
  EXPECT_THROW(GeometryScene(std::move(description)), Error);
}

// An instanced mesh, sphere, cylinder and patch hit like their baked copies, under every kind of transform.
TEST(Instances, EqualTheBakedShapes) {
  const Transform placements[] = {
      Transform::Translate({1, 2, 3}) * Transform::Rotate(30, {1, 2, 3}), Transform::Scale({-1, 1, 1}),
      Transform::Translate({-3, 0, 1}) * Transform::Rotate(70, {0, 1, 1}) * Transform::Scale({0.5, -2, 1.5}),
      Transform(glm::dmat4(1, 0.3, 0, 0, -0.4, 1, 0.1, 0, 0.2, 0, -1, 0, 1, 1, 1, 1))};  // sheared and mirrored
  TriangleMesh mesh = NoisySphere(12, 1, Point3(0.0f), 0.005f, 5);
  for (const Point3& p : mesh.positions) {
    mesh.normals.push_back(glm::normalize(p));
    mesh.uvs.emplace_back(p.x, p.y + 0.5f * p.z);
  }
  BilinearMesh patch;
  patch.positions = {{-1, -1, 2}, {1, -1, 2.5f}, {-1, 1, 3}, {1, 1, 1.8f}};
  patch.patches = {{0, 1, 2, 3}};
  Quadric cylinder;
  cylinder.kind = Quadric::Kind::Cylinder;
  cylinder.radius = 0.5f;
  cylinder.zMin = -3;
  cylinder.zMax = -1.5f;
  Random random(31);
  for (const Transform& m : placements) {
    TriangleMesh bakedMesh = mesh;
    for (Point3& p : bakedMesh.positions) p = Point3(m.Point(Point3d(p)));
    for (Normal3& n : bakedMesh.normals) n = glm::normalize(Vector3(m.Normal(Vector3d(n))));
    bakedMesh.flipNormals = m.SwapsHandedness();
    BilinearMesh bakedPatch = patch;
    for (Point3& p : bakedPatch.positions) p = Point3(m.Point(Point3d(p)));
    bakedPatch.flipNormals = m.SwapsHandedness();
    GeometryDescription baked;
    baked.entries.push_back(Entry(MeshShape(bakedMesh)));
    baked.entries.push_back(Entry(std::make_shared<const BilinearMesh>(bakedPatch)));
    baked.entries.push_back(Entry(Place(cylinder, m)));
    GeometryDescription instanced;
    instanced.entries.push_back(Entry(MeshShape(TriangleMesh{})));
    instanced.objects.resize(2);
    instanced.objects[1].entries.push_back(Entry(MeshShape(mesh)));
    instanced.objects[1].entries.push_back(Entry(std::make_shared<const BilinearMesh>(patch)));
    instanced.objects[1].entries.push_back(Entry(cylinder));
    instanced.objects[1].entries[1].attributes.light = 2;
    instanced.instances.push_back({1, m.ToAffine(), m.Inverse().ToAffine(), 40});
    const GeometryScene bakedScene(std::move(baked)), instancedScene(std::move(instanced));
    EXPECT_EQ(instancedScene.PrimitiveCount(), 4u);
    EXPECT_EQ(instancedScene.LightAt(2, 0), 42);
    EXPECT_EQ(instancedScene.LightAt(1, 0), -1);

    const Point3 center = Point3(m.Point({0, 0, 0}));
    int hits = 0, differing = 0, seen[3] = {};
    for (int i = 0; i < 20000; ++i) {
      const Ray ray{center + random.InBox(8),
                    glm::normalize(random.InBox(2) + center - center + random.Direction() * 0.1f)};
      const Ray aimed{ray.origin, glm::normalize(Point3(m.Point(Point3d(random.InBox(2)))) - ray.origin)};
      RayHit a, b;
      const bool hitA = bakedScene.Intersect(aimed, visibility::kAll, a),
                 hitB = instancedScene.Intersect(aimed, visibility::kAll, b);
      if (hitA != hitB || (hitA && (a.primitive + 1 != b.primitive || a.patch != b.patch))) {
        ++differing;  // on an edge
        continue;
      }
      if (!hitA) continue;
      ++hits;
      ++seen[a.primitive];
      ASSERT_EQ(b.instance, 0u);
      const SurfacePoint p = bakedScene.GetSurfacePoint(aimed, a), q = instancedScene.GetSurfacePoint(aimed, b);
      ASSERT_LT(glm::length(p.position - q.position), 3e-4f);
      ASSERT_GT(glm::dot(p.Ng, q.Ng), 0.9999f);
      ASSERT_GT(glm::dot(p.Ns, q.Ns), 0.98f);  // interpolated before or after the transform
      ASSERT_LT(glm::length(p.uv - q.uv), 2e-3f);
      ASSERT_LT(glm::length(p.dpdu - q.dpdu), 2e-2f * (1 + glm::length(p.dpdu)));
      ASSERT_GE(glm::dot(q.Ng, q.Ns), 0);
    }
    EXPECT_GT(hits, 4000);
    EXPECT_LT(differing, 20);
    for (const int count : seen) EXPECT_GT(count, 200);
    const Bounds3 x = bakedScene.GetBounds(), y = instancedScene.GetBounds();
    for (int k = 0; k < 3; ++k) {
      EXPECT_LE(y.min[k], x.min[k] + 1e-3f);
      EXPECT_GE(y.max[k], x.max[k] - 1e-3f);
    }
  }
}

class ConstantAlpha : public AlphaSource {
 public:
  explicit ConstantAlpha(float alpha) : alpha_(alpha) {}
  float Alpha(const Point2&, const Point3&, const Normal3&) const override { return alpha_; }

 private:
  float alpha_;
};

// Opaque where x > 1 in render space, or where u > 0.5.
class HalfAlpha : public AlphaSource {
 public:
  explicit HalfAlpha(bool byPosition) : byPosition_(byPosition) {}
  float Alpha(const Point2& uv, const Point3& p, const Normal3&) const override {
    return (byPosition_ ? p.x > 1 : uv.x > 0.5f) ? 1.0f : 0.0f;
  }

 private:
  bool byPosition_;
};

// Frequencies within 5 standard errors (two-sided 6e-7 each): 4 shapes x 5 opacities.
TEST(CutOut, FrequencyIsTheOpacity) {
  BilinearMesh patch;
  patch.positions = {{-1, -1, 0}, {1, -1, 0}, {-1, 1, 0}, {1, 1, 0}};
  patch.patches = {{0, 1, 2, 3}};
  TriangleMesh square;
  square.positions = patch.positions;
  square.triangles = {{0, 1, 3}, {0, 3, 2}};
  Quadric disk;
  disk.kind = Quadric::Kind::Disk;
  disk.radius = 2;
  disk.zMin = disk.zMax = 0;
  const std::vector<Shape> shapes = {MeshShape(square), std::make_shared<const BilinearMesh>(patch), disk, Sphere(2)};
  for (const Shape& shape : shapes) {
    for (const float alpha : {0.0f, 0.1f, 0.5f, 0.9f, 1.0f}) {
      GeometryDescription description;
      description.entries.push_back(Entry(shape, std::make_shared<ConstantAlpha>(alpha)));
      const GeometryScene scene(std::move(description));
      Random random(41);
      constexpr int kCount = 20000;
      int stopped = 0;
      for (int i = 0; i < kCount; ++i) {
        const Ray ray{{random.Uniform(-0.9f, 0.9f), random.Uniform(-0.9f, 0.9f), 0.5f}, {0, 0, -1}};
        RayHit hit;
        const bool found = scene.Intersect(ray, visibility::kAll, hit);
        ASSERT_NEAR(scene.Transmittance(ray, visibility::kAll).g, 1 - alpha, 1e-6f);  // the mean
        ASSERT_EQ(found, scene.Intersect(ray, visibility::kAll, hit));                // the same ray, the same answer
        stopped += found;
      }
      const double expected = static_cast<double>(alpha), sigma = std::sqrt(expected * (1 - expected) / kCount);
      EXPECT_NEAR(static_cast<double>(stopped) / kCount, expected, 5 * sigma) << shape.index() << " " << alpha;
    }
  }
}

// Entering and leaving the same shape are two chances to be stopped: 1 - (1 - α)².
TEST(CutOut, BothSidesOfAShapeAreIndependent) {
  Quadric tube;
  tube.kind = Quadric::Kind::Cylinder;
  tube.radius = 2;
  tube.zMin = -2;
  tube.zMax = 2;
  const glm::mat3 zToX(Vector3(0, 0, 1), Vector3(0, 1, 0), Vector3(-1, 0, 0));
  tube.toRender.linear = zToX;
  tube.toObject.linear = glm::transpose(zToX);
  CurveSet curve;
  curve.kind = CurveSet::Kind::Cylinder;
  curve.segments = {{Point3(-3, 0, 0), Point3(-1, 0, 0), Point3(1, 0, 0), Point3(3, 0, 0)}};
  curve.radii = {{2, 2, 2, 2}};
  curve.uRange = {{0, 1}};
  for (const Shape& shape : {Shape(Sphere(2)), Shape(tube), Shape(std::make_shared<const CurveSet>(curve))}) {
    for (const float alpha : {0.1f, 0.5f, 0.8f}) {
      GeometryDescription description;
      description.entries.push_back(Entry(shape, std::make_shared<ConstantAlpha>(alpha)));
      const GeometryScene scene(std::move(description));
      Random random(43);
      constexpr int kCount = 20000;
      int stopped = 0;
      for (int i = 0; i < kCount; ++i) {
        const Ray ray{{random.Uniform(-0.9f, 0.9f), random.Uniform(-0.9f, 0.9f), 5}, {0, 0, -1}};
        RayHit hit;
        const bool found = scene.Intersect(ray, visibility::kAll, hit);
        ASSERT_NEAR(scene.Transmittance(ray, visibility::kAll).g, (1 - alpha) * (1 - alpha), 1e-6f);
        stopped += found;
      }
      const double expected = 1 - std::pow(1 - static_cast<double>(alpha), 2);
      const double sigma = std::sqrt(expected * (1 - expected) / kCount);
      EXPECT_NEAR(static_cast<double>(stopped) / kCount, expected, 5 * sigma) << shape.index() << " " << alpha;
    }
  }
}

TEST(CutOut, LayersAreIndependent) {
  GeometryDescription description;
  const auto half = std::make_shared<ConstantAlpha>(0.5f);
  for (int i = 0; i < 3; ++i) {
    TriangleMesh mesh = UnitTriangle();
    for (Point3& p : mesh.positions) p = Point3(p.x * 4 - 1, p.y * 4 - 1, static_cast<float>(-i));
    description.entries.push_back(Entry(MeshShape(mesh), half));
  }
  const GeometryScene scene(std::move(description));
  Random random(42);
  constexpr int kCount = 20000;
  int stopped = 0;
  for (int i = 0; i < kCount; ++i) {
    const Ray ray{{random.Uniform(0, 0.5f), random.Uniform(0, 0.5f), 1}, {0, 0, -1}};
    RayHit hit;
    stopped += scene.Intersect(ray, visibility::kAll, hit);
    ASSERT_EQ(scene.Transmittance(ray, visibility::kAll), Color(0.125f));
  }
  EXPECT_NEAR(static_cast<double>(stopped) / kCount, 0.875, 5 * std::sqrt(0.875 * 0.125 / kCount));
}

// Sheets by the angle, and in colours: those in front of what is hit, and only those, whatever order they are met in.
class Pane : public ThinSurface {
 public:
  Pane(float part, const Color& tint) : part_(part), tint_(tint) {}
  float TransmittedFraction(float cosTheta) const override { return part_ * cosTheta; }
  Color Tint(const Point2&, const Point3&, const Normal3&) const override { return tint_; }
  bool IsClear() const override { return tint_ == Color(1.0f); }

 private:
  float part_;
  Color tint_;
};

TEST(Sheets, PassInProportionAndColour) {
  GeometryDescription description;
  const auto add = [&](float z, std::shared_ptr<const ThinSurface> sheet) {
    TriangleMesh mesh = UnitTriangle();
    for (Point3& p : mesh.positions) p = Point3(p.x * 8 - 2, p.y * 8 - 2, z);
    description.entries.push_back(Entry(MeshShape(mesh), nullptr));
    description.entries.back().attributes.thin = std::move(sheet);
  };
  add(0, std::make_shared<Pane>(0.8f, Color(1, 0.5f, 0.25f)));
  add(-3, std::make_shared<Pane>(0.8f, Color(0.0f)));  // behind the wall
  add(-1, std::make_shared<Pane>(0.5f, Color(0.5f, 1, 1)));
  add(-2, nullptr);  // the wall
  const GeometryScene scene(std::move(description));
  Random random(44);
  const Vector3 way(0.6f, 0, -0.8f);
  constexpr int kCount = 20000;
  int reached = 0;
  for (int i = 0; i < kCount; ++i) {
    Ray ray{{random.Uniform(-1, -0.5f), random.Uniform(-1, 0), 1}, way};
    RayHit hit;
    Color passed;
    ASSERT_TRUE(scene.Intersect(ray, visibility::kAll, hit, passed));
    const bool isWall = hit.primitive == 3;
    reached += isWall;
    const Color expected = isWall ? Color(0.5f, 0.5f, 0.25f) : hit.primitive == 2 ? Color(1, 0.5f, 0.25f) : Color(1.0f);
    ASSERT_NEAR(passed.r, expected.r, 1e-6f) << hit.primitive;
    ASSERT_NEAR(passed.g, expected.g, 1e-6f) << hit.primitive;
    ASSERT_NEAR(passed.b, expected.b, 1e-6f) << hit.primitive;
    ASSERT_TRUE(scene.GetSurfacePoint(ray, hit).isThin == !isWall);
    EXPECT_TRUE(scene.Transmittance(ray, visibility::kAll).IsBlack());
    ray.tMax = 3.6f;  // in front of the wall
    const Color left = scene.Transmittance(ray, visibility::kAll);
    ASSERT_NEAR(left.r, 0.64f * 0.4f * 0.5f, 1e-6f);
    ASSERT_NEAR(left.b, 0.64f * 0.4f * 0.25f, 1e-6f);
  }
  const double expected = 0.64 * 0.4;
  EXPECT_NEAR(static_cast<double>(reached) / kCount, expected, 5 * std::sqrt(expected * (1 - expected) / kCount));
}

// Twenty tinted panes in random order, a tinted sphere, and panes of a mirrored instance: `Trace` reports those before
// the hit by increasing distance, with the side that each is met from.
TEST(Crossings, AreInOrderWithTheirSides) {
  GeometryDescription description;
  const auto tinted = std::make_shared<Pane>(1.0f, Color(0.9f, 0.8f, 0.7f));
  Random random(45);
  const auto pane = [](float z, bool facesUp) {
    TriangleMesh mesh = UnitTriangle();
    for (Point3& p : mesh.positions) p = Point3(p.x * 8 - 2, p.y * 8 - 2, z);
    if (!facesUp) std::swap(mesh.triangles[0][0], mesh.triangles[0][1]);
    return MeshShape(mesh);
  };
  std::vector<std::pair<float, bool>> expected;  // height and whether the pane faces up
  for (int i = 0; i < 20; ++i) {
    expected.push_back({random.Uniform(-9, 9), random.Uniform(0, 1) < 0.5f});
    description.entries.push_back(Entry(pane(expected.back().first, expected.back().second), nullptr));
    description.entries.back().attributes.thin = tinted;
  }
  description.entries.push_back(Entry(Sphere(0.5f), nullptr));
  description.entries.back().attributes.thin = tinted;
  expected.push_back({0.5f, true});
  expected.push_back({-0.5f, false});
  description.entries.push_back(Entry(pane(-10, true), nullptr));  // the wall
  const uint32_t wall = static_cast<uint32_t>(description.entries.size()) - 1;
  GeometryObject object;
  object.entries.push_back(Entry(pane(1, true), nullptr));
  object.entries.back().attributes.thin = tinted;
  description.objects.push_back(object);
  const Transform mirrored = Transform::Scale({1, 1, -2});  // at a height of -2, facing down
  description.instances.push_back({0, mirrored.ToAffine(), mirrored.Inverse().ToAffine()});
  expected.push_back({-2, false});
  std::sort(expected.begin(), expected.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  const GeometryScene scene(std::move(description));
  std::vector<Crossing> crossings;
  for (const bool fromAbove : {true, false}) {
    const Ray ray{{0, 0, fromAbove ? 10.0f : -9.9f}, {0, 0, fromAbove ? -1.0f : 1.0f}};
    RayHit hit;
    ASSERT_EQ(scene.Trace(ray, visibility::kAll, hit, crossings), fromAbove);
    if (fromAbove) {
      EXPECT_EQ(hit.primitive, wall);
    }
    ASSERT_EQ(crossings.size(), expected.size());
    Color product(1.0f);
    for (size_t i = 0; i < crossings.size(); ++i) {
      const auto& [height, facesUp] = expected[fromAbove ? i : expected.size() - 1 - i];
      EXPECT_NEAR(crossings[i].t, std::abs(height - ray.origin.z), 1e-5f) << i;
      EXPECT_EQ(crossings[i].entering, facesUp == fromAbove) << i;
      EXPECT_EQ(crossings[i].instance, height == -2 ? 0 : kNoIndex) << i;
      product *= crossings[i].transmittance;
    }
    Color tint;
    scene.Intersect(ray, visibility::kAll, hit, tint);
    EXPECT_EQ(tint, product);
  }
}

TEST(CutOut, SeesTextureCoordinatesAndRenderSpacePositions) {
  const Transform there = Transform::Translate({1, 0, 0}) * Transform::Scale({-1, 1, 1});
  TriangleMesh square;
  square.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  square.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  square.triangles = {{0, 1, 2}, {0, 2, 3}};
  Quadric disk;
  disk.kind = Quadric::Kind::Disk;
  disk.radius = 2;
  disk.zMin = disk.zMax = 0;
  for (const bool byPosition : {true, false}) {
    for (const bool useDisk : {false, true}) {
      GeometryDescription description;
      description.objects.resize(1);
      description.objects[0].entries.push_back(
          Entry(useDisk ? Shape(disk) : MeshShape(square), std::make_shared<HalfAlpha>(byPosition)));
      description.instances.push_back({0, there.ToAffine(), there.Inverse().ToAffine(), 0});
      const GeometryScene scene(std::move(description));
      for (const float x : {0.1f, 0.5f, 0.9f, 1.1f, 1.5f, 1.9f}) {
        for (const float y : {-0.5f, 0.5f}) {
          const float objectX = 1 - x;
          const bool byUv = useDisk ? y < 0 : objectX > 0;  // the disk's u is φ / 2π
          RayHit hit;
          EXPECT_EQ(scene.Intersect({{x, y, 1}, {0, 0, -1}}, visibility::kAll, hit), byPosition ? x > 1 : byUv)
              << x << " " << y << byPosition << useDisk;
        }
      }
    }
  }
}

TEST(Scene, BoundingSphereHoldsTheBox) {
  const GeometryScene scene(SceneOf(MeshShape(NoisySphere(8, 2, {1e4f, -3e3f, 7}, 0.3f, 3))));
  const BoundingSphere sphere = scene.GetBoundingSphere();
  for (int i = 0; i < 8; ++i) {
    EXPECT_LE(glm::length(Vector3d(scene.GetBounds().Corner(i)) - Vector3d(sphere.center)),
              static_cast<double>(sphere.radius));
  }
  TriangleMesh dot;
  dot.positions.assign(3, Point3(0.0f));
  dot.triangles = {{0, 1, 2}};
  EXPECT_GT(GeometryScene(SceneOf(MeshShape(dot))).GetBoundingSphere().radius, 0);
}

}  // namespace
}  // namespace lampyr
