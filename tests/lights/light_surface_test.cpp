// Lights that are their own surface, as the ray tracer takes them: a test light placed by every kind of transform,
// still and moving; hits, sides, uv and error bounds against a computation in double.
#include <gtest/gtest.h>

#include <cmath>

#include "geometry/geometry_scene.h"
#include "geometry/robust.h"
#include "lights/services/light_surface.h"
#include "sampling/rng.h"
#include "sampling/warp.h"

namespace lampyr {
namespace {

// The square [-1,1]² at z = 0; its outer side is -z. Only its surface is looked at.
class SquareLight final : public Light, public IntersectableLight {
 public:
  LightKind Kind() const override { return LightKind::Area; }
  const LightSettings& Settings() const override { return settings_; }
  const IntersectableLight* Surface() const override { return hasSurface_ ? this : nullptr; }
  explicit SquareLight(bool hasSurface = true) : hasSurface_(hasSurface) {}

  std::vector<Point3> GetBounds() const override { return {{-1, -1, 0}, {1, -1, 0}, {-1, 1, 0}, {1, 1, 0}}; }
  std::optional<LocalHit> Intersect(const LocalRay& ray) const override {
    const double t = -ray.origin.z / ray.direction.z;
    if (!(t > ray.tMin && t <= ray.tMax)) return std::nullopt;
    const Point3d p = ray.origin + t * ray.direction;
    if (std::abs(p.x) > 1 || std::abs(p.y) > 1) return std::nullopt;
    return LocalHit{t, {p.x, p.y, 0}, {0, 0, -1}, Point2(0.5 * p.x + 0.5, 0.5 * p.y + 0.5)};
  }

  float GetIncidentRadianceEstimate(const LightContext&, const Point3&) const override { return 1; }
  std::optional<SegmentEstimate> GetIncidentRadianceEstimate(const LightContext&, const Point3&, const Vector3&,
                                                             float) const override {
    return std::nullopt;
  }
  Color GetPowerEstimate(const LightContext&) const override { return Color(1.0f); }
  std::optional<EmissionBounds> GetEmissionBounds(const LightContext&) const override { return std::nullopt; }
  std::optional<LightSample> GenerateSamples(const LightContext&, const Point3&) const override { return std::nullopt; }
  std::optional<LightEvaluation> EvaluateSamples(const LightContext&, const LightHit&, const Point3&) const override {
    return std::nullopt;
  }
  std::optional<EmissionSample> GenerateEmission(const LightContext&) const override { return std::nullopt; }
  Color EvaluateEmissionForCamera(const LightContext&, const LightHit&) const override { return Color(0.0f); }
  std::unique_ptr<Light> Edit(const ParameterList&, const LightBuildContext&) const override { return nullptr; }

 private:
  LightSettings settings_;
  bool hasSurface_;
};

std::vector<Transform> Places() {
  const Transform turn = Transform::Rotate(50, {1, 2, 0.5});
  glm::dmat4 shear(1.0);
  shear[1][0] = 0.7;
  shear[2][1] = -0.4;
  return {Transform(),
          Transform::Translate({3, -2, 5}) * turn,
          turn * Transform::Scale({1, 3, 0.2}),
          Transform::Translate({0, 1, 0}) * Transform::Scale({-1, 1, 1}) * turn,
          Transform(shear) * turn,
          Transform::Translate({1e3, 1e3, -1e3}) * turn * Transform::Scale({1e-3, 1e-3, 1e-3}),
          Transform::Scale({1e4, 1e4, 1e4})};
}

GeometryScene SceneOf(const PlacedLight& placed) {
  GeometryDescription description;
  GeometryEntry entry;
  entry.shape = MakeLightSurface(placed);
  entry.attributes.light = 3;
  description.entries.push_back(entry);
  return GeometryScene(std::move(description));
}

// Rays towards points of the square's plane, placed by `toRender`; `scale` is the size of the square.
void ExpectTracedWhereItIs(const GeometryScene& scene, const Affine& toRender, float time) {
  Rng rng(1);
  const glm::dmat3 linear(toRender.linear);
  const float size = std::max(glm::length(toRender.linear[0]), glm::length(toRender.linear[1]));
  int hits = 0, misses = 0;
  for (int i = 0; i < 4000; ++i) {
    const Point2 u = rng.NextPoint2();
    const Point3 target = toRender.Point({3 * u.x - 1.5f, 3 * u.y - 1.5f, 0});
    const Vector3 direction = SampleUniformSphere(rng.NextPoint2());
    const Ray ray{target - (2 * size) * direction, direction, kInfinity, time};
    const Vector3d outer = glm::normalize(Vector3d(0, 0, -1) * glm::inverse(linear));
    const double cosine = glm::dot(outer, Vector3d(direction));
    // Where this very ray, rounded as it is, meets the plane.
    const Vector3d toPlane = Vector3d(toRender.translation) - Point3d(ray.origin);
    const Point3d met = Point3d(ray.origin) + Vector3d(direction) * (glm::dot(outer, toPlane) / cosine);
    const Point3d local = glm::inverse(linear) * (met - Vector3d(toRender.translation));
    RayHit hit;
    const bool found = scene.Intersect(ray, visibility::kIndirect, hit);
    EXPECT_EQ(scene.Occluded(ray, visibility::kShadow), found);
    const double border = std::max(std::abs(local.x), std::abs(local.y)) - 1;
    if (std::abs(border) < 1e-2 || std::abs(cosine) < 1e-2) continue;
    ASSERT_EQ(found, border < 0);
    ++(found ? hits : misses);
    if (!found) continue;
    EXPECT_EQ(scene.LightAt(hit.primitive, hit.instance), 3);
    const SurfacePoint point = scene.GetSurfacePoint(ray, hit);
    EXPECT_GT(glm::dot(Vector3d(point.Ng), outer), 1 - 1e-6);
    EXPECT_NEAR(point.uv.x, 0.5 * local.x + 0.5, 1e-6);
    EXPECT_NEAR(point.uv.y, 0.5 * local.y + 0.5, 1e-6);
    // The bound holds: the plane goes through the box of the error.
    const double offPlane = glm::dot(outer, Point3d(point.position) - Vector3d(toRender.translation));
    EXPECT_LE(std::abs(offPlane), glm::dot(glm::abs(outer), Vector3d(point.positionError)));
    // And no ray that leaves the surface finds it again.
    RayHit again;
    const Vector3 away = SampleUniformSphere(rng.NextPoint2());
    EXPECT_FALSE(scene.Intersect(SpawnRay(point, away, time), visibility::kIndirect, again));
    if (std::abs(glm::dot(away, point.Ng)) < 0.1f) continue;  // the target is rounded, too: to the other side
    EXPECT_FALSE(scene.Occluded(SpawnRayTo(point, point.position + size * away, Vector3(0.0f), Normal3(0.0f), time),
                                visibility::kShadow));
  }
  EXPECT_GT(hits, 1000);
  EXPECT_GT(misses, 1000);
}

TEST(LightSurface, StillAndPlacedByAnyTransform) {
  int cases = 0;
  for (const Transform& place : Places()) {
    PlacedLight placed{std::make_shared<SquareLight>(), {place.ToAffine(), place.Inverse().ToAffine()}};
    ExpectTracedWhereItIs(SceneOf(placed), placed.transform.toRender, 0);
    ++cases;
  }
  EXPECT_EQ(cases, 7);
}

TEST(LightSurface, MovesWithItsLight) {
  const Transform start = Transform::Translate({-4, 0, 1}), end = Transform::Translate({5, 2, 0}) *
                                                                  Transform::Rotate(80, {1, 0, 1}) *
                                                                  Transform::Scale({2, 0.5, 1});
  const MotionChain chain(MotionChain() * AnimatedTransform(start, end, "a light", {}));
  for (const MotionTimes& times : {MotionTimes{0, 1}, MotionTimes{0.3, 0.6}, MotionTimes{-1, 0.5}}) {
    PlacedLight placed{std::make_shared<SquareLight>(), {}};
    placed.motion = MakeMotion(chain, times, {}, "a light", {});
    ASSERT_TRUE(placed.motion);
    const GeometryScene scene = SceneOf(placed);
    for (const float time : {0.0f, 0.2f, 0.31f, 0.55f, 0.9f, 1.0f}) {
      ExpectTracedWhereItIs(scene, placed.At(time).toRender, time);
    }
  }
}

TEST(LightSurface, ATinyLightFarAwayIsMet) {
  const Transform place = Transform::Scale({1e-3, 1e-3, 1e-3});
  const PlacedLight placed{std::make_shared<SquareLight>(), {place.ToAffine(), place.Inverse().ToAffine()}};
  const GeometryScene scene = SceneOf(placed);
  Rng rng(2);
  for (int i = 0; i < 1000; ++i) {
    const Vector3 direction = SampleUniformSphere(rng.NextPoint2());
    if (std::abs(direction.z) < 0.1f) continue;
    const Ray ray{-1e3f * direction, direction, kInfinity, 0};
    RayHit hit;
    // The direction's own rounding moves the ray by 1e-4 there: well inside.
    ASSERT_TRUE(scene.Intersect(ray, visibility::kIndirect, hit));
    const SurfacePoint point = scene.GetSurfacePoint(ray, hit);
    EXPECT_LE(std::abs(point.position.z), point.positionError.z);
    EXPECT_LT(point.positionError.z, 1e-9f);
  }
}

TEST(LightSurface, OnlyOfLightsThatHaveOne) {
  const PlacedLight placed{std::make_shared<SquareLight>(false), {}};
  EXPECT_FALSE(MakeLightSurface(placed));
}

}  // namespace
}  // namespace lampyr
