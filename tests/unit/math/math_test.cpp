#include <gtest/gtest.h>

#include <random>

#include "math/angle.h"
#include "math/bounds.h"
#include "math/density.h"
#include "math/frame.h"
#include "math/transform.h"

namespace lampyr {
namespace {

Vector3 RandomDirection(std::mt19937& generator) {
  std::normal_distribution<float> normal;
  return glm::normalize(Vector3(normal(generator), normal(generator), normal(generator)));
}

TEST(Frame, IsOrthonormalAndRightHanded) {
  std::mt19937 generator(1);
  for (int i = 0; i < 1000; ++i) {
    Normal3 n = RandomDirection(generator);
    if (i == 0) n = {0, 0, 1};
    if (i == 1) n = {0, 0, -1};
    for (const Frame& frame : {Frame::FromNormal(n), Frame::FromNormalAndTangent(n, RandomDirection(generator)),
                               Frame::FromNormalAndTangent(n, n), Frame::FromNormalAndTangent(n, Vector3(0.0f))}) {
      EXPECT_NEAR(glm::length(frame.x), 1, 1e-5);
      EXPECT_NEAR(glm::dot(frame.x, frame.y), 0, 1e-5);
      EXPECT_NEAR(glm::dot(glm::cross(frame.x, frame.y), frame.z), 1, 1e-5);
      const Vector3 v = RandomDirection(generator);
      EXPECT_NEAR(glm::distance(frame.ToWorld(frame.ToLocal(v)), v), 0, 1e-5);
    }
  }
}

TEST(Transform, InverseUndoes) {
  const Transform t =
      Transform::Translate({1, 2, 3}) * Transform::Rotate(40, {1, 2, -1}) * Transform::Scale({2, -3, 0.5});
  const Point3d p(0.3, -4, 7);
  EXPECT_NEAR(glm::distance(t.Inverse().Point(t.Point(p)), p), 0, 1e-12);
  EXPECT_TRUE(t.SwapsHandedness());
  EXPECT_TRUE(t.IsAffine());
  EXPECT_FALSE(t.IsSingular());
  EXPECT_TRUE(Transform::Scale({1, 0, 1}).IsSingular());
  EXPECT_NEAR(glm::distance(Point3d(t.ToAffine().Point(Point3(p))), t.Point(p)), 0, 1e-5);
}

// An affine map has an affine inverse, to the last bit: of matrices that are inverted by elimination too.
TEST(Transform, InversesOfAffineMapsAreAffine) {
  for (int i = 0; i < 200; ++i) {
    const Transform look = Transform::LookAt({0.1 * i, 0.9, 0.97 - i}, {3.3, 0.7 * i, -1}, {0.1, 1, 0.01 * i});
    EXPECT_TRUE(look.IsAffine() && look.Inverse().IsAffine()) << i;
    EXPECT_NEAR(glm::distance(look.Inverse().Point(look.Point({1, 2, 3})), Point3d(1, 2, 3)), 0, 1e-9);
  }
}

TEST(Transform, NormalsStayPerpendicular) {
  const Transform t = Transform::Rotate(40, {1, 2, -1}) * Transform::Scale({2, -3, 0.5});
  const Vector3d tangent(1, 2, 3), normal = glm::cross(tangent, Vector3d(0, 1, 1));
  EXPECT_NEAR(glm::dot(t.Vector(tangent), t.Normal(normal)), 0, 1e-12);
  const Vector3 floatNormal = t.Inverse().ToAffine().NormalByInverse(Normal3(normal));
  EXPECT_NEAR(glm::distance(Vector3d(floatNormal), t.Normal(normal)), 0, 1e-5);
}

TEST(Transform, RotateIsRightHanded) {
  EXPECT_NEAR(glm::distance(Transform::Rotate(90, {0, 0, 1}).Vector({1, 0, 0}), Vector3d(0, 1, 0)), 0, 1e-15);
}

TEST(Transform, LookAtLooksAlongPositiveZ) {
  const Transform t = Transform::LookAt({1, 2, 3}, {1, 2, -5}, {0, 1, 0});
  EXPECT_NEAR(glm::distance(t.Point({1, 2, -5}), Point3d(0, 0, 8)), 0, 1e-12);
  EXPECT_NEAR(t.Point({1, 3, 0}).y, 1, 1e-12);
}

TEST(Affine, PointErrorBoundsTheError) {
  std::mt19937 generator(2);
  std::uniform_real_distribution<double> coordinate(-100, 100);
  const Transform t =
      Transform::Translate({50, -20, 3}) * Transform::Rotate(33, {3, 1, 2}) * Transform::Scale({5, 1, 0.1});
  const Affine affine = t.ToAffine();
  for (int i = 0; i < 10000; ++i) {
    const Point3 p(coordinate(generator), coordinate(generator), coordinate(generator));
    const Point3d error = glm::abs(Point3d(affine.Point(p)) - t.Point(Point3d(p)));
    const Vector3 bound = affine.PointError(p, Vector3(0.0f));
    for (int c = 0; c < 3; ++c) EXPECT_LE(error[c], double(bound[c]));
  }
}

TEST(Density, ConvertsBetweenMeasures) {
  const PdfSolidAngle solidAngle = ToSolidAngle(PdfArea(2), 9, 0.5f);
  EXPECT_FLOAT_EQ(solidAngle.value, 36);
  EXPECT_FLOAT_EQ(ToArea(solidAngle, SolidAngleToArea(9, 0.5f)).value, 2);
  EXPECT_TRUE(ToSolidAngle(PdfArea(2), 9, 0).IsZero());
  EXPECT_FLOAT_EQ((PdfDiscrete(0.25f) * PdfSolidAngle(8)).value, 2);
}

TEST(Bounds, EmptyUntilSomethingIsAdded) {
  Bounds3 bounds;
  EXPECT_TRUE(bounds.IsEmpty());
  bounds.Add(Bounds3());
  EXPECT_TRUE(bounds.IsEmpty());
  bounds.Add(Point3(1, 2, 3));
  EXPECT_FALSE(bounds.IsEmpty());
  bounds.Add(Point3(-1, 4, 3));
  EXPECT_EQ(bounds.Center(), Point3(0, 3, 3));
}

TEST(Angle, DegreesConvertToRadians) {
  EXPECT_FLOAT_EQ(Cos(Degrees(60)), 0.5f);
}

}  // namespace
}  // namespace lampyr
