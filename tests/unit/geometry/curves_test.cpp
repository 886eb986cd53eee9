// Curves: conversion to Bézier segments, hits on straight ones where the answer is known, and wrong parameters.
#include <gtest/gtest.h>

#include "base/error.h"
#include "geometry/curves.h"
#include "helpers.h"

namespace lampyr {
namespace {

using testing::Random;
using testing::SceneOf;

CurveParameters Straight(CurveSet::Kind kind) {
  CurveParameters p;
  p.points = {{0, 0, 0}, {0, 0, 1}, {0, 0, 2}, {0, 0, 3}};
  p.width0 = p.width1 = 0.4f;
  p.kind = kind;
  if (kind == CurveSet::Kind::Ribbon) p.normals.assign(2, Normal3(1, 0, 0));
  return p;
}

Shape ToShape(CurveSet curves) {
  return std::make_shared<const CurveSet>(std::move(curves));
}

TEST(Curves, SegmentsOfEveryBasisAndDegree) {
  CurveParameters p;
  p.degree = 2;
  p.points = {{0, 0, 0}, {1, 2, 0}, {2, 0, 0}, {3, -2, 0}, {4, 0, 0}};
  EXPECT_EQ(MakeCurves(p).segments.size(), 2u);
  // The quadratic's value in the middle of the first segment: 1/4, 1/2, 1/4.
  EXPECT_NEAR(glm::length(CurveAxis(MakeCurves(p), 0, 0.5f) - Point3(1, 1, 0)), 0, 1e-6);
  p.basis = CurveParameters::Basis::BSpline;
  EXPECT_EQ(MakeCurves(p).segments.size(), 3u);
  EXPECT_NEAR(glm::length(CurveAxis(MakeCurves(p), 1, 0) - Point3(1.5f, 1, 0)), 0, 1e-6);
  p.degree = 3;
  const CurveSet cubic = MakeCurves(p);
  ASSERT_EQ(cubic.segments.size(), 2u);
  // Knots of a uniform cubic B-spline: 1/6, 4/6, 1/6; and the pieces join.
  EXPECT_NEAR(glm::length(CurveAxis(cubic, 0, 0) - (p.points[0] + p.points[1] * 4.0f + p.points[2]) / 6.0f), 0, 1e-6);
  EXPECT_NEAR(glm::length(CurveAxis(cubic, 0, 1) - CurveAxis(cubic, 1, 0)), 0, 1e-6);
  EXPECT_NEAR(glm::length(CurveTangent(cubic, 0, 1) - CurveTangent(cubic, 1, 0)), 0, 1e-5);
}

TEST(Curves, WidthsInterpolateAndScale) {
  CurveParameters p = Straight(CurveSet::Kind::Flat);
  p.width1 = 0.8f;
  p.toRender = Transform::Scale({10, 10, 10});
  const CurveSet curves = MakeCurves(p);
  EXPECT_NEAR(CurveRadius(curves, 0, 0), 2, 1e-5);
  EXPECT_NEAR(CurveRadius(curves, 0, 0.5f), 3, 1e-5);
  EXPECT_NEAR(CurveRadius(curves, 0, 1), 4, 1e-5);
  EXPECT_NEAR(GetArea(ToShape(MakeCurves(Straight(CurveSet::Kind::Flat)))), 3 * 0.4, 1e-5);
}

TEST(Curves, DividedSegmentsAreCountedAsTheyAreMade) {
  CurveParameters p;
  p.points = {{0, 0, 0}, {0, 0.3f, 0.4f}, {0, -0.3f, 0.8f}, {0, 0.1f, 1.3f}, {0, 0, 2}, {0, 0, 2.5f}, {0, 0, 3}};
  p.width1 = 0;
  for (const float width : {1.0f, 0.1f, 0.001f}) {
    p.width0 = width;
    for (const float stretch : {1.0f, 10.0f}) {
      p.toRender = Transform::Scale({1, stretch, 1});  // a bend that grows more than the width
      for (const CurveSet::Kind kind : {CurveSet::Kind::Flat, CurveSet::Kind::Cylinder}) {
        p.kind = kind;
        EXPECT_EQ(CountDividedSegments(p), MakeCurves(p).segments.size()) << width << " " << stretch;
      }
    }
  }
  p.kind = CurveSet::Kind::Flat;
  p.width0 = 1e-7f;
  EXPECT_EQ(CountDividedSegments(p), 2 * 256u);
  p.points.pop_back();
  EXPECT_THROW(CountDividedSegments(p), Error);
}

// Flat curves are drawn as straight lines: a bent one is hit across its whole width, at the offset that the axis gives.
TEST(Curves, BentFlatOnesKeepTheirWidth) {
  CurveParameters p;
  p.points = {{0, 0, 0}, {0, 0.3f, 0.4f}, {0, -0.3f, 0.8f}, {0, 0.1f, 1.3f}};
  p.width0 = 0.004f;
  p.width1 = 0.008f;
  const CurveSet whole = [&] {
    CurveParameters tube = p;
    tube.kind = CurveSet::Kind::Cylinder;
    return MakeCurves(tube);
  }();
  ASSERT_EQ(whole.segments.size(), 1u);
  const GeometryScene scene(SceneOf(ToShape(MakeCurves(p))));
  Random random(62);
  for (int i = 0; i < 5000; ++i) {
    const float u = random.Uniform(0.001f, 0.999f), side = random.Uniform(-0.95f, 0.95f);
    const Vector3 along = glm::normalize(CurveTangent(whole, 0, u));
    const Vector3 across = glm::cross(Vector3(-1, 0, 0), along);
    const Point3 target = CurveAxis(whole, 0, u) + across * (side * CurveRadius(whole, 0, u));
    const Ray ray{target + Vector3(3, 0, 0), {-1, 0, 0}};
    RayHit hit;
    ASSERT_TRUE(scene.Intersect(ray, visibility::kAll, hit)) << "u " << u << ", side " << side;
    const SurfacePoint point = scene.GetSurfacePoint(ray, hit);
    ASSERT_NEAR(2 * point.uv.y - 1, side, 0.03f) << "u " << u;
    ASSERT_NEAR(point.uv.x, u, 0.01f) << "u " << u;
  }
}

// Rays along z at four fifths of the half width beside the axis, and one and a half half widths beside it.
void ExpectFullWidth(const CurveSet& curves) {
  const GeometryScene scene(SceneOf(ToShape(CurveSet(curves))));
  for (uint32_t segment = 0; segment < curves.segments.size(); ++segment) {
    for (int i = 0; i < 8; ++i) {
      const float u = (static_cast<float>(i) + 0.5f) / 8;
      const Vector3 tangent = glm::normalize(CurveTangent(curves, segment, u));
      const Vector3 across = glm::normalize(glm::cross(Vector3(0, 0, 1), tangent)) * CurveRadius(curves, segment, u);
      for (const float side : {-1.5f, -0.8f, 0.8f, 1.5f}) {
        RayHit hit;
        const Ray ray{CurveAxis(curves, segment, u) + side * across - Vector3(0, 0, 4), {0, 0, 1}};
        EXPECT_EQ(scene.Intersect(ray, visibility::kAll, hit), std::abs(side) < 1)
            << segment << " " << u << " " << side;
      }
    }
  }
}

TEST(Curves, BentRibbonsAreOfFullWidth) {
  CurveParameters p;
  p.kind = CurveSet::Kind::Ribbon;
  p.normals = {Normal3(0, 0, 1), Normal3(0, 0, 1)};
  p.width0 = p.width1 = 0.1f;
  p.points = {{-0.9f, -0.7f, 0}, {-0.3f, 1, 0}, {0.3f, -1, 0}, {0.9f, 0.7f, 0}};
  ExpectFullWidth(MakeCurves(p));
  p.points = {{0, -1, 0}, {0, -0.2f, 0}, {0.1f, 0.6f, 0}, {0.8f, 0.9f, 0}};
  ExpectFullWidth(MakeCurves(p));
  // Normals that differ little as given, and much as placed.
  p.points = {{0, 0, 0}, {0.3f, 0, 0}, {0.6f, 0, 0}, {1, 0, 0}};
  p.normals = {Normal3(0, 0.1f, 1), Normal3(0, -0.1f, 1)};
  p.toRender = Transform::Scale(Vector3d(1, 1, 10));
  EXPECT_GT(MakeCurves(p).segments.size(), 4u);
}

// A normal along the curve says nothing about where a ribbon faces. This one rises to z at its end, where its normal is
// along it.
TEST(Curves, RibbonsWithANormalAlongThem) {
  CurveParameters p;
  p.kind = CurveSet::Kind::Ribbon;
  p.points = {{0, -1, -0.3f}, {0, 0.25f, -0.3f}, {0, 0.875f, -0.15f}, {0, 0.875f, 0}};
  p.width0 = p.width1 = 0.8f;
  for (const Normal3& end : {Normal3(0, 0, 1), Normal3(0, 0.001f, 1)}) {
    p.normals = {Normal3(0, 0, 1), end};
    const CurveSet curves = MakeCurves(p);
    const GeometryScene scene(SceneOf(ToShape(MakeCurves(p))));
    for (uint32_t segment = 0; segment < curves.segments.size(); ++segment) {
      for (const float u : {0.2f, 0.8f}) {
        const Vector3 tangent = glm::normalize(CurveTangent(curves, segment, u));
        const Vector3 normal = glm::cross(tangent, Vector3(1, 0, 0));  // of a ribbon that is not twisted
        for (const float side : {-0.35f, 0.35f}) {
          const Ray ray{CurveAxis(curves, segment, u) + Vector3(side, 0, 0) + 0.05f * normal, -normal};
          RayHit hit;
          ASSERT_TRUE(scene.Intersect(ray, visibility::kAll, hit)) << segment << " " << u << " " << side;
          EXPECT_LT(hit.t, 0.1f);
        }
      }
    }
  }
}

// A quarter turn whose normals are along it at both ends is hit over one width, wherever that is.
TEST(Curves, RibbonsWithoutUsableNormals) {
  CurveParameters p;
  p.kind = CurveSet::Kind::Ribbon;
  p.points = {{0, -1, 0}, {0, -0.45f, 0}, {0, 0, 0.45f}, {0, 0, 1}};
  p.width0 = p.width1 = 0.2f;
  p.normals = {Normal3(0, 1, 0), Normal3(0, 0, 1)};
  const CurveSet curves = MakeCurves(p);
  const GeometryScene scene(SceneOf(ToShape(MakeCurves(p))));
  for (uint32_t segment = 0; segment < curves.segments.size(); ++segment) {
    const Vector3 along = glm::normalize(CurveTangent(curves, segment, 0.5f));
    const Vector3 normal(glm::normalize(curves.segmentNormals[segment][0] + curves.segmentNormals[segment][1]));
    EXPECT_LT(std::abs(glm::dot(along, normal)), 0.2f);
    for (const float side : {-0.08f, 0.08f}) {
      const Vector3 across = glm::normalize(glm::cross(normal, along)) * side;
      const Ray ray{CurveAxis(curves, segment, 0.5f) + across + 0.05f * normal, -normal};
      RayHit hit;
      EXPECT_TRUE(scene.Intersect(ray, visibility::kAll, hit)) << segment << " " << side;
    }
  }
}

TEST(Curves, StraightOnesAreHitWhereTheyAre) {
  for (const auto kind : {CurveSet::Kind::Flat, CurveSet::Kind::Cylinder, CurveSet::Kind::Ribbon}) {
    const GeometryScene scene(SceneOf(ToShape(MakeCurves(Straight(kind)))));
    Random random(61);
    for (int i = 0; i < 5000; ++i) {
      const float y = random.Uniform(-0.5f, 0.5f), z = random.Uniform(0.1f, 2.9f);
      if (std::abs(std::abs(y) - 0.2f) < 0.005f) continue;
      const Ray ray{{5, y, z}, {-1, 0, 0}};
      RayHit hit;
      ASSERT_EQ(scene.Intersect(ray, visibility::kAll, hit), std::abs(y) < 0.2f) << y << " " << static_cast<int>(kind);
      if (std::abs(y) > 0.2f) continue;
      const SurfacePoint p = scene.GetSurfacePoint(ray, hit);
      const float x = kind == CurveSet::Kind::Cylinder ? std::sqrt(0.04f - y * y) : 0.0f;
      ASSERT_NEAR(p.position.x, x, 2e-3f);
      ASSERT_NEAR(p.uv.x, z / 3, 2e-3f);
      ASSERT_GT(p.Ng.x, 0);
      ASSERT_NEAR(p.Ng.z, 0, 1e-3f);
      ASSERT_LT(glm::dot(glm::normalize(glm::cross(p.dpdu, p.dpdv)), p.Ng), x < 0.05f && x != 0 ? 1 : -0.05f);
      ASSERT_NEAR(p.uv.y - 0.5f, y / 0.4f, 1e-2f);  // towards direction × tangent, which is +y
      ASSERT_TRUE(kind == CurveSet::Kind::Cylinder ? std::abs(p.Ng.y - y / 0.2f) < 2e-2f : p.Ng.x > 0.999f);
    }
  }
}

// Rays that leave a tube outwards do not find it again; the same for flat curves towards where they were seen from.
TEST(Curves, NoSelfIntersection) {
  for (const float scale : {1e-3f, 1.0f, 1e3f}) {
    for (const auto kind : {CurveSet::Kind::Flat, CurveSet::Kind::Cylinder, CurveSet::Kind::Ribbon}) {
      CurveParameters parameters = Straight(kind);
      parameters.toRender = Transform::Scale(Vector3d(static_cast<double>(scale)));
      const GeometryScene scene(SceneOf(ToShape(MakeCurves(parameters))));
      Random random(62);
      int hits = 0, again = 0;
      for (int i = 0; i < 5000; ++i) {
        const Point3 target = Point3(0, 0, random.Uniform(0.5f, 2.5f)) * scale;
        const Vector3 side =
            glm::normalize(Vector3(random.Uniform(0.3f, 1), random.Uniform(-1, 1), random.Uniform(-0.5f, 0.5f)));
        const Ray ray{target + side * scale, -side};
        RayHit hit;
        if (!scene.Intersect(ray, visibility::kAll, hit)) continue;
        ++hits;
        const SurfacePoint p = scene.GetSurfacePoint(ray, hit);
        again += scene.Occluded(SpawnRay(p, glm::normalize(side + p.Ng), 0), visibility::kAll);
      }
      EXPECT_GT(hits, 4500);
      EXPECT_EQ(again, 0) << static_cast<int>(kind) << " " << scale;
    }
  }
}

// Fibrous round curves are met from outside alone: what leaves one through its other side does not meet it.
TEST(Curves, FibresAreNotMetFromInside) {
  for (const bool isFibrous : {false, true}) {
    GeometryDescription description = SceneOf(ToShape(MakeCurves(Straight(CurveSet::Kind::Cylinder))));
    description.entries[0].attributes.isFibrous = isFibrous;
    const GeometryScene scene(std::move(description));
    Random random(63);
    for (int i = 0; i < 2000; ++i) {
      const Ray ray{{5, random.Uniform(-0.19f, 0.19f), random.Uniform(0.5f, 2.5f)}, {-1, 0, 0}};
      RayHit hit;
      ASSERT_TRUE(scene.Intersect(ray, visibility::kAll, hit));
      const SurfacePoint p = scene.GetSurfacePoint(ray, hit);
      ASSERT_GT(p.Ng.x, 0);
      ASSERT_EQ(p.strand, Strand::Fibre);
      ASSERT_EQ(scene.Occluded(SpawnRay(p, ray.direction, 0), visibility::kAll), !isFibrous) << ray.origin.y;
    }
  }
}

TEST(Curves, BadParametersAreErrors) {
  CurveParameters p = Straight(CurveSet::Kind::Flat);
  p.points.pop_back();
  EXPECT_THROW(MakeCurves(p), Error);
  p = Straight(CurveSet::Kind::Flat);
  p.degree = 4;
  EXPECT_THROW(MakeCurves(p), Error);
  p = Straight(CurveSet::Kind::Flat);
  p.width0 = -1;
  EXPECT_THROW(MakeCurves(p), Error);
  p = Straight(CurveSet::Kind::Ribbon);
  p.normals.pop_back();
  EXPECT_THROW(MakeCurves(p), Error);
  p = Straight(CurveSet::Kind::Flat);
  p.points[1].x = kInfinity;
  EXPECT_THROW(MakeCurves(p), Error);
}

}  // namespace
}  // namespace lampyr
