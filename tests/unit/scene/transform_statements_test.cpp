// The current transformation matrix against matrices worked out by hand.
#include <cmath>

#include "unit/scene/scene_support.h"

namespace lampyr {
namespace {

using Rows = std::array<std::array<double, 4>, 4>;

void ExpectMatrix(const Transform& transform, const Rows& rows) {
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) {
      EXPECT_NEAR(transform.Matrix()[column][row], rows[row][column], 1e-12) << "row " << row << ", column " << column;
    }
  }
  const glm::dmat4 product = transform.Matrix() * transform.InverseMatrix();
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) EXPECT_NEAR(product[column][row], row == column ? 1 : 0, 1e-10);
  }
}

Placement PlacementAfter(const std::string& statements) {
  const SceneDescription scene = Parse(InWorld(statements + " Shape \"sphere\""));
  return scene.shapes.at(0).placement;
}

TEST(TransformStatements, LastWrittenIsFirstApplied) {
  ExpectMatrix(PlacementAfter("Translate 1 2 3 Scale 2 3 4").start,
               {{{2, 0, 0, 1}, {0, 3, 0, 2}, {0, 0, 4, 3}, {0, 0, 0, 1}}});
  ExpectMatrix(PlacementAfter("Scale 2 3 4 Translate 1 2 3").start,
               {{{2, 0, 0, 2}, {0, 3, 0, 6}, {0, 0, 4, 12}, {0, 0, 0, 1}}});
}

TEST(TransformStatements, Rotate) {
  ExpectMatrix(PlacementAfter("Rotate 90 0 0 5").start, {{{0, -1, 0, 0}, {1, 0, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}});
  ExpectMatrix(PlacementAfter("Rotate -90 1e-30 0 0").start,
               {{{1, 0, 0, 0}, {0, 0, 1, 0}, {0, -1, 0, 0}, {0, 0, 0, 1}}});
  ExpectMatrix(PlacementAfter("Rotate 120 1 1 1").start, {{{0, 0, 1, 0}, {1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 0, 1}}});
}

TEST(TransformStatements, MatricesComeColumnByColumn) {
  ExpectMatrix(PlacementAfter("Scale 9 9 9 Transform [ 1 0 0 0  0 2 0 0  0 0 3 0  4 5 6 1 ]").start,
               {{{1, 0, 0, 4}, {0, 2, 0, 5}, {0, 0, 3, 6}, {0, 0, 0, 1}}});
  ExpectMatrix(PlacementAfter("Scale 2 2 2 ConcatTransform [ 1 0 0 0  0 2 0 0  0 0 3 0  4 5 6 1 ]").start,
               {{{2, 0, 0, 8}, {0, 4, 0, 10}, {0, 0, 6, 12}, {0, 0, 0, 1}}});
  ExpectMatrix(PlacementAfter("Transform [ 2 0 0 0  0 2 0 0  0 0 2 0  4 6 8 2 ]").start,
               {{{1, 0, 0, 2}, {0, 1, 0, 3}, {0, 0, 1, 4}, {0, 0, 0, 1}}});
  // A last row that is (0, 0, 0, 1) but for rounding.
  ExpectMatrix(PlacementAfter("Transform [ 1 0 0 3e-9  0 1 0 -2e-8  0 0 1 1e-7  4 5 6 1 ]").start,
               {{{1, 0, 0, 4}, {0, 1, 0, 5}, {0, 0, 1, 6}, {0, 0, 0, 1}}});
  EXPECT_TRUE(PlacementAfter("Translate 1 2 3 Identity").start.IsIdentity());
}

TEST(TransformStatements, CameraLooksAlongItsZAxis) {
  const SceneDescription scene = Parse("LookAt 1 2 3  1 2 13  0 1 0  Camera \"perspective\" WorldBegin");
  ExpectMatrix(scene.cameraToWorld.start, {{{1, 0, 0, 1}, {0, 1, 0, 2}, {0, 0, 1, 3}, {0, 0, 0, 1}}});
  const SceneDescription turned = Parse("LookAt 0 0 0  5 0 0  0 0 2  Camera \"perspective\" WorldBegin");
  // right = up × forward = z × x = y
  ExpectMatrix(turned.cameraToWorld.start, {{{0, 0, 1, 0}, {1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 0, 1}}});
}

TEST(TransformStatements, WorldBeginResetsAndNamesCoordinateSystems) {
  const SceneDescription scene = Parse(
      "Translate 0 0 5 Camera \"perspective\" ActiveTransform EndTime WorldBegin Shape \"sphere\"\n"
      "Translate 1 0 0 CoordinateSystem \"here\" Identity CoordSysTransform \"camera\" Shape \"disk\"\n"
      "CoordSysTransform \"here\" Shape \"cylinder\" CoordSysTransform \"world\" Shape \"curve\"");
  ASSERT_EQ(scene.shapes.size(), 4u);
  EXPECT_TRUE(scene.shapes[0].placement.start.IsIdentity());
  EXPECT_EQ(scene.shapes[1].placement.start.Point({0, 0, 0}), Point3d(0, 0, -5));
  EXPECT_EQ(scene.shapes[2].placement.start.Point({0, 0, 0}), Point3d(1, 0, 0));
  EXPECT_EQ(scene.shapes[2].placement.end.Point({0, 0, 0}), Point3d(1, 0, 0));
  EXPECT_TRUE(scene.shapes[3].placement.start.IsIdentity());
}

// A CTM that is singular at one time remains so until that time has another transform.
TEST(TransformStatements, SingularAtOneTimeIsSingular) {
  const std::string start =
      "ActiveTransform StartTime Scale 0 1 1 ActiveTransform EndTime Identity ActiveTransform All ";
  EXPECT_THROW(PlacementAfter(start), Error);  // a warning, which is an error here
  EXPECT_NO_THROW(PlacementAfter(start + "ActiveTransform StartTime Identity "));
}

TEST(TransformStatements, ActiveTransformMovesOneEnd) {
  const Placement moving =
      PlacementAfter("Translate 1 0 0 ActiveTransform EndTime Translate 0 2 0 ActiveTransform All Scale 2 2 2");
  EXPECT_TRUE(moving.IsAnimated());
  EXPECT_EQ(moving.start.Point({1, 1, 1}), Point3d(3, 2, 2));
  EXPECT_EQ(moving.end.Point({1, 1, 1}), Point3d(3, 4, 2));
  EXPECT_EQ(PlacementAfter("ActiveTransform StartTime Translate 1 0 0").end.Point({0, 0, 0}), Point3d(0, 0, 0));
  const SceneDescription scene = Parse("TransformTimes 0.25 0.75 WorldBegin");
  EXPECT_EQ(scene.shutterOpen, 0.25);
  EXPECT_EQ(scene.shutterClose, 0.75);
}

TEST(TransformStatements, MirrorsAndTinyScalesAreFine) {
  EXPECT_TRUE(PlacementAfter("Scale -1 1 1").start.SwapsHandedness());
  EXPECT_FALSE(PlacementAfter("Scale 1e-20 1e20 1e-20").start.IsSingular());
}

}  // namespace
}  // namespace lampyr
