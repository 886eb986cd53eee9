// Scenes of few surfaces, which are tested one by one: the same hits, crossings and transmittances as Embree's, and no
// ray between triangles that share an edge.
#include <gtest/gtest.h>

#include <cmath>

#include "geometry/few_surfaces.h"
#include "geometry/scene_tables.h"
#include "unit/geometry/helpers.h"

namespace lampyr {
namespace {

using testing::Entry;
using testing::MeshShape;
using testing::NoisySphere;
using testing::Place;
using testing::Random;
using testing::Sphere;

class HalfOpaque : public AlphaSource {
 public:
  float Alpha(const Point2&, const Point3&, const Normal3&) const override { return 0.5f; }
};

class TintedPane : public ThinSurface {
 public:
  float TransmittedFraction(float cosTheta) const override { return 0.5f + 0.5f * cosTheta; }
  Color Tint(const Point2&, const Point3&, const Normal3&) const override { return Color(0.9f, 0.5f, 0.7f); }
  bool IsClear() const override { return false; }
};

class FloorAt : public CustomSurface {
 public:
  explicit FloorAt(double height) : height_(height) {}
  bool Moves() const override { return false; }
  Bounds3 GetBounds(float, float) const override {
    const auto z = static_cast<float>(height_);
    return {{-9, -9, z}, {9, 9, z}};
  }
  std::optional<double> Intersect(const RayDouble& ray, float, SurfacePoint*) const override {
    const double t = (height_ - ray.origin.z) / ray.direction.z;
    if (!(t > ray.tMin && t <= ray.tMax)) return std::nullopt;
    const Point3d p = ray.origin + t * ray.direction;
    return std::abs(p.x) < 9 && std::abs(p.y) < 9 ? std::optional(t) : std::nullopt;
  }

 private:
  double height_;
};

TriangleMesh Loose(int count, float size, Random& random) {
  TriangleMesh mesh;
  for (int i = 0; i < count; ++i) {
    const Point3 center = random.InBox(4);
    for (int k = 0; k < 3; ++k) mesh.positions.push_back(center + random.InBox(size));
    const auto first = static_cast<uint32_t>(3 * i);
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

// Every other one is a parallelogram.
BilinearMesh LoosePatches(int count, Random& random) {
  BilinearMesh mesh;
  for (int i = 0; i < count; ++i) {
    const auto first = static_cast<uint32_t>(4 * i);
    const Point3 center = random.InBox(4);
    for (int k = 0; k < 4; ++k) mesh.positions.push_back(center + random.InBox(2));
    if (i % 2 == 0)
      mesh.positions[first + 3] = mesh.positions[first + 1] + mesh.positions[first + 2] - mesh.positions[first];
    mesh.patches.push_back({first, first + 1, first + 2, first + 3});
  }
  return mesh;
}

// Triangles of all sizes, patches, quadrics whole and partial and a custom surface. Kinds of
// rays that see them, and with `passes` what becomes of a ray there, differ from shape to shape.
GeometryDescription Mixture(int triangles, bool passes, uint32_t seed) {
  Random random(seed);
  GeometryDescription description;
  const auto add = [&](Shape shape) {
    GeometryEntry entry = Entry(std::move(shape));
    const size_t index = description.entries.size();
    if (index % 3 == 1) entry.attributes.visibility = visibility::kCamera | visibility::kShadow;
    const bool mayPass = passes && !std::holds_alternative<std::shared_ptr<const CustomSurface>>(entry.shape);
    if (mayPass && index % 4 == 1) entry.attributes.alpha = std::make_shared<HalfOpaque>();
    if (mayPass && index % 4 == 2) entry.attributes.thin = std::make_shared<TintedPane>();
    if (mayPass && index % 4 == 3) {
      entry.attributes.isBoundary = true;
      entry.attributes.insideMedium = static_cast<int32_t>(index);
      entry.attributes.outsideMedium = kVacuum;
    }
    description.entries.push_back(std::move(entry));
  };
  for (int left = triangles, k = 0; left > 0; ++k) {
    const int count = std::min(left, 3 + 5 * (k % 3));
    add(MeshShape(Loose(count, k % 2 ? 0.3f : 3.0f, random)));
    left -= count;
  }
  for (int i = 0; i < 4; ++i) add(std::make_shared<const BilinearMesh>(LoosePatches(1 + i, random)));
  for (int i = 0; i < 12; ++i) {
    Quadric quadric = Sphere(random.Uniform(0.2f, 1.5f));
    quadric.kind = static_cast<Quadric::Kind>(i % 3);
    if (i % 2) quadric.phiMax = random.Uniform(1, 6);
    if (quadric.kind == Quadric::Kind::Disk) quadric.zMin = 0.1f;
    add(Place(quadric, Transform::Translate(Vector3d(random.InBox(4)))));
  }
  add(std::make_shared<const FloorAt>(-4.5));
  // An object without an instance: no ray meets it.
  description.objects.push_back({{Entry(Sphere(1)), Entry(MeshShape(Loose(9, 1, random)))}});
  return description;
}

std::pair<std::unique_ptr<GeometryScene>, std::unique_ptr<GeometryScene>> Both(GeometryDescription description) {
  auto few = std::make_unique<GeometryScene>(description);
  description.tracer = Tracer::Embree;
  return {std::move(few), std::make_unique<GeometryScene>(std::move(description))};
}

constexpr uint32_t kKinds[] = {visibility::kCamera, visibility::kIndirect, visibility::kShadow, visibility::kMedia};

bool AreSame(const std::vector<Crossing>& a, const std::vector<Crossing>& b) {
  if (a.size() != b.size()) return false;
  for (size_t i = 0; i < a.size(); ++i) {
    if (a[i].primitive != b[i].primitive || a[i].patch != b[i].patch || a[i].medium != b[i].medium ||
        std::abs(a[i].t - b[i].t) > 1e-5 * (1 + b[i].t) ||
        MaxComponent(Abs(Vector3(a[i].transmittance.r - b[i].transmittance.r,
                                 a[i].transmittance.g - b[i].transmittance.g, 0))) > 1e-4f)
      return false;
  }
  return true;
}

struct Differences {
  int hits = 0, places = 0, crossings = 0, transmittances = 0;
};

// Over random rays from within and from outside, of all kinds and lengths. At an edge the tracers may differ by a
// rounding.
Differences Compare(const GeometryScene& few, const GeometryScene& embree, int count, int& found) {
  Differences differences;
  Random random(77);
  std::vector<Crossing> a, b;
  for (int i = 0; i < count; ++i) {
    Ray ray{random.InBox(i % 2 ? 4.0f : 9.0f), random.Direction()};
    if (i % 5 == 0) ray.direction[i % 3] = i % 2 ? 0.0f : -0.0f;  // parallel to a side of every box
    ray.direction = glm::normalize(ray.direction);
    if (i % 3 == 0) ray.tMax = random.Uniform(0.1f, 8);
    const uint32_t kinds = kKinds[i % 4];
    RayHit hitA, hitB;
    const bool isHit = few.Trace(ray, kinds, hitA, a), isHitB = embree.Trace(ray, kinds, hitB, b);
    found += isHit;
    differences.hits += isHit != isHitB || hitA.primitive != hitB.primitive || hitA.patch != hitB.patch ||
                        hitA.instance != hitB.instance;
    differences.crossings += !AreSame(a, b);
    if (isHit && isHitB && hitA.primitive == hitB.primitive && hitA.patch == hitB.patch) {
      const Point3 p = few.GetSurfacePoint(ray, hitA).position, q = embree.GetSurfacePoint(ray, hitB).position;
      differences.places += std::abs(hitA.t - hitB.t) > 2e-5f * (1 + hitB.t) || MaxAbsComponent(p - q) > 1e-4f;
    }
    const Color left = few.Transmittance(ray, kinds, a), leftB = embree.Transmittance(ray, kinds, b);
    differences.transmittances += std::abs(left.r - leftB.r) > 1e-4f || std::abs(left.g - leftB.g) > 1e-4f;
    differences.transmittances += few.Occluded(ray, kinds) != embree.Occluded(ray, kinds);
    differences.crossings += !AreSame(a, b);
  }
  return differences;
}

TEST(FewSurfaces, MeetWhatEmbreeMeets) {
  for (const int triangles : {0, 1, 8, 20, 50}) {
    for (const bool passes : {false, true}) {
      SCOPED_TRACE(triangles * 10 + passes);
      const auto [few, embree] = Both(Mixture(triangles, passes, static_cast<uint32_t>(triangles)));
      constexpr int kRays = 20000;
      int found = 0;
      const Differences differences = Compare(*few, *embree, kRays, found);
      EXPECT_GT(found, kRays / 10);
      EXPECT_LE(differences.hits, 4);
      EXPECT_LE(differences.places, 4);
      EXPECT_LE(differences.crossings, 8);
      EXPECT_LE(differences.transmittances, 8);
    }
  }
}

// Sizes and places at which floats still tell a mesh's corners apart.
struct Setting {
  float radius;
  Point3 center;
};

// Scenes that are tested one by one: up to 64 triangles, two of which are a parallelogram, and 32 other surfaces.
TEST(FewSurfaces, AreThoseOfSmallScenes) {
  const auto areFew = [](auto shape, bool hasInstance = false) {
    SceneTables tables;
    PrimitiveRecord record;
    record.shape = shape;
    record.SetLetsPass();
    record.tables = &tables;
    tables.primitives.push_back(record);
    tables.attributes.emplace_back();
    tables.firstInstanceId = 1;
    if (hasInstance) tables.instances.emplace_back();
    return FewSurfaces::Of(tables) != nullptr;
  };
  Random random(3);
  const TriangleMesh few = Loose(64, 1, random), many = Loose(65, 1, random);
  EXPECT_TRUE(areFew(&few));
  EXPECT_FALSE(areFew(&many));
  EXPECT_FALSE(areFew(&few, true));
  const BilinearMesh mixed = LoosePatches(64, random), tooMany = LoosePatches(66, random);
  EXPECT_TRUE(areFew(&mixed));
  EXPECT_FALSE(areFew(&tooMany));
  const CurveSet curves;
  EXPECT_FALSE(areFew(&curves));
}

// From inside, towards corners and points of edges.
TEST(FewSurfaces, LetNoRayThroughEdges) {
  for (const Setting& setting : {Setting{1, Point3(0.0f)}, Setting{1e-6f, Point3(0.0f)}, Setting{1e6f, Point3(0.0f)},
                                 Setting{1, {1e4f, -3e4f, 2e4f}}, Setting{1e12f, Point3(0.0f)}}) {
    SCOPED_TRACE(setting.radius);
    for (const uint32_t rings : {2u, 3u, 4u}) {  // 8, 24 and 48 triangles: with bounds of blocks and without
      const TriangleMesh mesh = NoisySphere(rings, setting.radius, setting.center, 0.3f, rings);
      const GeometryScene scene(testing::SceneOf(MeshShape(mesh)));
      Random random(rings);
      int escaped = 0;
      for (int i = 0; i < 60000; ++i) {
        const auto& t = mesh.triangles[static_cast<size_t>(i) % mesh.triangles.size()];
        const float along = i % 4 ? random.Uniform() : 0.0f;
        const size_t k = static_cast<size_t>(i) % 3;
        const Point3 target = mesh.positions[t[k]] * (1 - along) + mesh.positions[t[(k + 1) % 3]] * along;
        Ray ray{setting.center + random.InBox(0.2f * setting.radius), {}};
        ray.direction = glm::normalize(target - ray.origin);
        RayHit hit;
        escaped += !scene.Intersect(ray, visibility::kCamera, hit);
        escaped += !scene.Occluded(ray, visibility::kShadow);
      }
      EXPECT_EQ(escaped, 0);
    }
  }
}

TEST(FewSurfaces, NothingIsHitInAnEmptyScene) {
  const GeometryScene scene{GeometryDescription()};
  RayHit hit;
  EXPECT_FALSE(scene.Intersect({{0, 0, 0}, {0, 0, 1}}, visibility::kCamera, hit));
  EXPECT_FALSE(scene.Occluded({{0, 0, 0}, {0, 0, 1}}, visibility::kShadow));
}

// Triangles without area stop nothing, and one that is seen edge-on is not met.
TEST(FewSurfaces, TrianglesWithoutArea) {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 1}, {1, 0, 1}, {2, 0, 1}, {0, 0, 1}, {0, 1, 1}, {0, 0, 2}};
  mesh.triangles = {{0, 1, 2}, {0, 0, 1}, {0, 0, 0}, {3, 4, 5}};
  const GeometryScene scene(testing::SceneOf(MeshShape(mesh)));
  RayHit hit;
  for (const float x : {0.0f, 0.5f, 1.0f}) {
    EXPECT_FALSE(scene.Intersect({{x, 0, 0}, {0, 0, 1}}, visibility::kCamera, hit)) << x;
    EXPECT_FALSE(scene.Occluded({{x, 0, 0}, {0, 0, 1}}, visibility::kShadow)) << x;
  }
  ASSERT_TRUE(scene.Intersect({{-1, 0.25f, 1.25f}, {1, 0, 0}}, visibility::kCamera, hit));
  EXPECT_EQ(hit.patch, 3u);
  EXPECT_FLOAT_EQ(hit.t, 1);
}

}  // namespace
}  // namespace lampyr
