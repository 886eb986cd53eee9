// Things that move: a ray at a shutter time finds what it finds in a scene where everything stays as it is at that
// time.
#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "helpers.h"
#include "math/motion.h"

namespace lampyr {
namespace {

using testing::Entry;
using testing::MeshShape;
using testing::NoisySphere;
using testing::Random;
using testing::Sphere;

MotionChain TurnAndMove() {
  const Transform start = Transform::Translate({-0.5, 0, 0.2}) * Transform::Scale({1, 1.3, 0.8});
  const Transform end = Transform::Translate({0.6, 0.3, -0.2}) * Transform::Rotate(70, {1, 0.4, 0.2});
  return MotionChain() * AnimatedTransform(start, end, "a shape", {});
}

GeometryObject AllShapes() {
  GeometryObject object;
  object.entries.push_back(Entry(MeshShape(NoisySphere(8, 0.3f, {0.4f, 0, 0}, 0.1f, 3))));
  BilinearMesh patch;
  patch.positions = {{-1, -1, 0}, {-0.2f, -0.8f, 0.2f}, {-0.7f, 0, 0.3f}, {-0.1f, 0.1f, -0.2f}};
  patch.patches = {{0, 1, 2, 3}};
  object.entries.push_back(Entry(std::make_shared<const BilinearMesh>(patch)));
  object.entries.push_back(Entry(testing::Place(Sphere(0.25f), Transform::Translate({0, 0.7, 0}))));
  CurveSet curves;
  curves.kind = CurveSet::Kind::Cylinder;
  curves.segments = {{Point3(-1, 0.5f, 0), Point3(-0.8f, 0.9f, 0.2f), Point3(-0.6f, 0.4f, 0), Point3(-0.4f, 0.8f, 0)}};
  curves.radii = {{0.08f, 0.08f, 0.08f, 0.08f}};
  curves.uRange = {{0, 1}};
  object.entries.push_back(Entry(std::make_shared<const CurveSet>(curves)));
  return object;
}

struct Counts {
  int hits = 0, differences = 0;
};

// Rays at `time` in `moving` against the same rays where the object is placed at `chain`'s fraction.
Counts Compare(const GeometryScene& moving, const MotionChain& chain, const MotionTimes& times, float time,
               uint32_t seed) {
  const Transform place = chain.At(times.FractionAt(static_cast<double>(time)));
  GeometryDescription description;
  description.objects.push_back(AllShapes());
  description.instances.push_back({0, place.ToAffine(), place.Inverse().ToAffine(), 0, nullptr});
  const GeometryScene still(description);
  Random random(seed);
  Counts counts;
  for (int i = 0; i < 3000; ++i) {
    const Point3 origin = random.InBox(2);
    const Ray ray{origin, glm::normalize(place.Point(random.InBox(0.8f)) - Point3d(origin)), kInfinity, time};
    RayHit a, b;
    const bool hitA = moving.Intersect(ray, visibility::kAll, a), hitB = still.Intersect(ray, visibility::kAll, b);
    EXPECT_EQ(moving.Occluded(ray, visibility::kAll), hitA);
    counts.hits += hitB;
    if (hitA != hitB || (hitA && a.primitive != b.primitive)) {
      ++counts.differences;
      continue;
    }
    if (!hitA) continue;
    const SurfacePoint p = moving.GetSurfacePoint(ray, a), q = still.GetSurfacePoint(ray, b);
    if (glm::distance(p.position, q.position) > 1e-3f || glm::dot(p.Ng, q.Ng) < 0.998f) ++counts.differences;
    EXPECT_NEAR(glm::length(p.Ng), 1, 1e-5);
    EXPECT_LT(glm::length(glm::cross(p.position - ray.origin, ray.direction)), 2e-4f);
  }
  return counts;
}

TEST(Motion, EveryShapeIsWhereItShouldBe) {
  const MotionChain chain = TurnAndMove();
  for (const MotionTimes& times :
       {MotionTimes{0, 1}, MotionTimes{0.3, 0.6}, MotionTimes{-0.4, 0.7}, MotionTimes{0.2, 3}}) {
    GeometryDescription description;
    description.objects.push_back(AllShapes());
    GeometryInstance instance;
    instance.motion = MakeMotion(chain, times, {}, "a shape", {});
    ASSERT_TRUE(instance.motion);
    description.instances.push_back(instance);
    const GeometryScene moving(description);
    for (const float time : {0.0f, 0.1f, 0.3f, 0.35f, 0.5f, 0.6f, 0.77f, 1.0f}) {
      const Counts counts = Compare(moving, chain, times, time, 1 + static_cast<uint32_t>(1000 * time));
      EXPECT_GT(counts.hits, 200);
      EXPECT_LE(counts.differences, 4) << times.begin << " " << time;  // silhouettes
    }
  }
}

TEST(Motion, JumpsAreThereOnce) {
  const MotionChain chain(MotionChain() * AnimatedTransform(Transform::Translate({-2, 0, 0}),
                                                            Transform::Translate({2, 0, 0}), "a shape", {}));
  GeometryDescription description;
  description.objects.push_back({{Entry(Sphere(1))}});
  GeometryInstance instance;
  instance.motion = MakeMotion(chain, {0.5, 0.5}, {}, "a shape", {});
  description.instances.push_back(instance);
  const GeometryScene scene(description);
  for (const float time : {0.0f, 0.25f, 0.49f, 0.51f, 1.0f}) {
    for (const float x : {-2.0f, 2.0f}) {
      const Ray ray{{x, 0, 5}, {0, 0, -1}, kInfinity, time};
      EXPECT_EQ(scene.Occluded(ray, visibility::kAll), (x > 0) == (time > 0.5f)) << x << " " << time;
    }
  }
}

TEST(Motion, LightsOfPiecesAreThoseOfTheInstance) {
  GeometryDescription description;
  GeometryEntry entry = Entry(Sphere(1));
  entry.attributes.light = 0;
  description.objects.push_back({{entry}});
  GeometryInstance still;
  still.toRender.translation = {-3, 0, 0};
  still.toObject.translation = {3, 0, 0};
  still.firstLight = 5;
  GeometryInstance moves;
  moves.firstLight = 7;
  moves.motion = MakeMotion(TurnAndMove(), {0.3, 0.6}, {}, "a shape", {});
  description.instances = {moves, still};
  const GeometryScene scene(description);
  for (const float time : {0.1f, 0.4f, 0.9f}) {
    for (const auto& [x, light] : {std::pair(0.0f, 7), std::pair(-3.0f, 5)}) {
      const Ray ray{{x, 0, 9}, {0, 0, -1}, kInfinity, time};
      RayHit hit;
      ASSERT_TRUE(scene.Intersect(ray, visibility::kAll, hit));
      EXPECT_EQ(scene.LightAt(hit.primitive, hit.instance), light);
    }
  }
}

TEST(Motion, BoundsHoldTheWholeShutter) {
  GeometryDescription description;
  description.objects.push_back(AllShapes());
  GeometryInstance instance;
  instance.motion = MakeMotion(TurnAndMove(), {0, 1}, {}, "a shape", {});
  description.instances.push_back(instance);
  const GeometryScene scene(description);
  const Bounds3& bounds = scene.GetBounds();
  Random random(5);
  int hits = 0;
  for (int i = 0; i < 200000; ++i) {
    const Ray ray{random.InBox(3), random.Direction(), kInfinity, random.Uniform()};
    RayHit hit;
    if (!scene.Intersect(ray, visibility::kAll, hit)) continue;
    ++hits;
    const Point3 p = scene.GetSurfacePoint(ray, hit).position;
    for (int k = 0; k < 3; ++k) {
      EXPECT_GE(p[k], bounds.min[k] - 1e-5f);
      EXPECT_LE(p[k], bounds.max[k] + 1e-5f);
    }
  }
  EXPECT_GT(hits, 1000);
}

// A shadow ray that leaves a moving surface outwards never finds it again.
TEST(Motion, ConvexShapesDoNotShadeThemselves) {
  for (const double distance : {1.0, 50.0, 400.0}) {
    const MotionChain chain(
        MotionChain() * AnimatedTransform(Transform::Translate({-distance, 0, 0.2}),
                                          Transform::Translate({distance, 0.3, 0}) * Transform::Rotate(80, {1, 1, 0}),
                                          "a shape", {}));
    GeometryDescription description;
    description.objects.push_back({{Entry(Sphere(0.5f)), Entry(MeshShape(NoisySphere(12, 0.5f, {1.5f, 0, 0}, 0, 3)))}});
    GeometryInstance instance;
    instance.motion = MakeMotion(chain, {0, 1}, GetBounds(Shape(Sphere(0.5f))), "a shape", {});
    description.instances.push_back(instance);
    const GeometryScene scene(description);
    Random random(6);
    int hits = 0, shaded = 0;
    for (int i = 0; i < 40000; ++i) {
      const float time = random.Uniform();
      const Point3 target =
          instance.motion->At(time).Point(random.InBox(0.5f) + Vector3(random.Uniform(0, 1.5f), 0, 0));
      const Vector3 direction = random.Direction();
      const Ray ray{target - 3.0f * direction, direction, kInfinity, time};
      RayHit hit;
      if (!scene.Intersect(ray, visibility::kAll, hit)) continue;
      const SurfacePoint point = scene.GetSurfacePoint(ray, hit);
      Vector3 out = random.Direction();
      if (glm::dot(out, point.Ng) < 0) out = -out;
      ++hits;
      RayHit again;
      if (!scene.Intersect(SpawnRay(point, out, time), visibility::kAll, again)) continue;
      shaded += again.primitive == hit.primitive;
    }
    EXPECT_GT(hits, 5000);
    EXPECT_EQ(shaded, 0) << distance;
  }
}

// A unit square at z = 0 that moves along x, without Embree's help.
class MovingSquare final : public CustomSurface {
 public:
  explicit MovingSquare(bool moves) : moves_(moves) {}
  bool Moves() const override { return moves_; }
  Bounds3 GetBounds(float begin, float end) const override {
    Bounds3 bounds;
    bounds.Add(Point3(Place(begin) - 0.501, -0.501f, -1e-6f));
    bounds.Add(Point3(Place(end) + 0.501, 0.501f, 1e-6f));
    return bounds;
  }
  std::optional<double> Intersect(const RayDouble& ray, float time, SurfacePoint* point) const override {
    const double t = -ray.origin.z / ray.direction.z;
    if (!(t > ray.tMin && t <= ray.tMax)) return std::nullopt;
    const Point3d p = ray.origin + t * ray.direction - Vector3d(Place(time), 0, 0);
    if (std::abs(p.x) > 0.5 || std::abs(p.y) > 0.5) return std::nullopt;
    if (point) {
      point->position = Point3(ray.origin + t * ray.direction);
      point->uv = Point2(p.x + 0.5, p.y + 0.5);
      point->Ng = point->Ns = Normal3(0, 0, -1);
    }
    return t;
  }

 private:
  double Place(float time) const { return moves_ ? 10.0 * static_cast<double>(time) - 5 : 0.0; }
  bool moves_;
};

TEST(CustomSurface, IsTracedWhereItIs) {
  for (const bool moves : {false, true}) {
    GeometryDescription description;
    description.entries.push_back(Entry(testing::Place(Sphere(0.2f), Transform::Translate({0, 0, 3}))));
    description.entries.push_back(Entry(std::shared_ptr<const CustomSurface>(std::make_shared<MovingSquare>(moves))));
    description.entries.back().attributes.visibility = visibility::kShadow;
    const GeometryScene scene(description);
    Random random(7);
    int hits = 0;
    for (int i = 0; i < 20000; ++i) {
      const float time = random.Uniform(), place = moves ? 10 * time - 5 : 0.0f;
      const Point3 target(place + random.Uniform(-1, 1), random.Uniform(-1, 1), 0);
      const Vector3 direction = glm::normalize(Vector3(random.Uniform(-1, 1), random.Uniform(-1, 1), -1));
      const Ray ray{target - direction, direction, kInfinity, time};
      const bool meets = std::abs(target.x - place) < 0.4999f && std::abs(target.y) < 0.4999f;
      const bool misses = std::abs(target.x - place) > 0.5001f || std::abs(target.y) > 0.5001f;
      RayHit hit;
      EXPECT_FALSE(scene.Intersect(ray, visibility::kCamera, hit) && hit.primitive == 1);
      const bool found = scene.Intersect(ray, visibility::kShadow, hit) && hit.primitive == 1;
      EXPECT_EQ(scene.Occluded(ray, visibility::kShadow), found);
      EXPECT_TRUE(found || !meets);
      EXPECT_FALSE(found && misses);
      if (!found) continue;
      ++hits;
      const SurfacePoint point = scene.GetSurfacePoint(ray, hit);
      EXPECT_NEAR(point.position.x, target.x, 1e-5);
      EXPECT_NEAR(point.uv.x, target.x - place + 0.5f, 1e-5);
      EXPECT_NEAR(point.uv.y, target.y + 0.5f, 1e-5);
      EXPECT_EQ(point.Ng, Normal3(0, 0, -1));
      EXPECT_EQ(point.primitive, 1u);
    }
    EXPECT_GT(hits, 4000);
    EXPECT_LT(scene.GetBounds().min.x, moves ? -5.4f : -0.4f);
  }
}

TEST(CustomSurface, IsNoPartOfAnObject) {
  GeometryDescription description;
  description.objects.push_back({{Entry(std::shared_ptr<const CustomSurface>(std::make_shared<MovingSquare>(false)))}});
  EXPECT_THROW(GeometryScene{description}, Error);
}

}  // namespace
}  // namespace lampyr
