// The medium at a point, by rays to the surfaces around it.
#include "geometry/medium_at.h"

#include <gtest/gtest.h>

#include <array>

#include "helpers.h"

namespace lampyr {
namespace {

using testing::Entry;
using testing::MeshShape;
using testing::NoisySphere;
using testing::Place;
using testing::Random;
using testing::Sphere;

GeometryEntry Separating(Shape shape, int32_t inside, int32_t outside, bool isBoundary = true) {
  GeometryEntry entry = Entry(std::move(shape));
  entry.attributes.isBoundary = isBoundary;
  entry.attributes.insideMedium = inside;
  entry.attributes.outsideMedium = outside;
  return entry;
}

Quadric SphereAt(const Vector3d& center, float radius) {
  return Place(Sphere(radius), Transform::Translate(center));
}

Shape Square(float z) {
  TriangleMesh mesh;
  mesh.positions = {{-9, -9, z}, {9, -9, z}, {9, 9, z}, {-9, 9, z}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return MeshShape(mesh);
}

// A ball of glass with a medium in a boundary in a sealed room of opaque walls, and an instance: the medium is found
// everywhere, through everything opaque.
TEST(MediumAt, IsTheMediumOfThePoint) {
  GeometryDescription description;
  description.entries.push_back(Separating(Sphere(2), 1, 0));
  description.entries.push_back(Separating(SphereAt({0.5, 0, 0}, 1), 2, 1, false));
  description.entries.push_back(Separating(Sphere(5), 0, kVacuum));
  for (const float radius : {0.3f, 1.2f, 3.0f}) description.entries.push_back(Entry(SphereAt({-0.2, 0.1, 0}, radius)));
  description.entries.push_back(Entry(MeshShape(NoisySphere(12, 1.5f, {0.1f, 0, 0.1f}, 0.1f, 3))));
  description.objects.push_back({{Separating(Sphere(0.25f), 3, 2)}});
  const Transform mirrored = Transform::Translate({0.6, 0, 0.1}) * Transform::Scale({1, -2, 0.5});
  description.instances.push_back({0, mirrored.ToAffine(), mirrored.Inverse().ToAffine()});
  const GeometryScene scene(std::move(description));
  Random random(3);
  std::array<int, 5> counts{};
  for (int i = 0; i < 10000; ++i) {
    const Point3 p = i % 2 ? random.InBox(5) : Point3(0.6f, 0, 0) + random.InBox(0.6f);
    int32_t expected = glm::length(p) < 5 ? 0 : kVacuum;
    if (glm::length(p) < 2) expected = 1;
    if (glm::length(p - Point3(0.5f, 0, 0)) < 1) expected = 2;
    if (glm::length(mirrored.Inverse().Point(Point3d(p))) < 0.25) expected = 3;
    ++counts[static_cast<size_t>(expected + 1)];
    ASSERT_EQ(MediumAt(scene, p, 0, kVacuum), expected);
    const FoundMedium found = FindMedium(scene, p, 0);
    EXPECT_EQ(found.disputed, kNoIndex);
    EXPECT_EQ(found.medium.value_or(kVacuum), expected);
    EXPECT_EQ(found.exterior.value_or(kVacuum), kVacuum);
    if (expected != kVacuum) {
      EXPECT_TRUE(found.isUnanimous);
    }
  }
  for (const int count : counts) EXPECT_GT(count, 100);
}

TEST(MediumAt, IsUnknownWithoutBoundaries) {
  GeometryDescription description;
  description.entries.push_back(Entry(Sphere(1)));
  const GeometryScene plain(std::move(description));
  EXPECT_EQ(MediumAt(plain, Point3(0.0f), 0, 7), 7);
  EXPECT_FALSE(FindMedium(plain, Point3(0.0f), 0).medium);
  EXPECT_FALSE(FindMedium(plain, Point3(0.0f), 0).exterior);
}

// A sheet of water: open, but nothing contradicts it. Rays that miss it end where they start, so that there is no one
// medium that all of them end in.
TEST(MediumAt, OfAnOpenSheet) {
  GeometryDescription description;
  TriangleMesh sheet;
  sheet.positions = {{-1e4f, -1e4f, 0}, {1e4f, -1e4f, 0}, {1e4f, 1e4f, 0}, {-1e4f, 1e4f, 0}};
  sheet.triangles = {{0, 1, 2}, {0, 2, 3}};
  description.entries.push_back(Separating(MeshShape(sheet), 4, kVacuum));
  const GeometryScene scene(std::move(description));
  for (const float z : {-3.0f, 3.0f}) {
    const FoundMedium found = FindMedium(scene, {1, 2, z}, 0);
    EXPECT_EQ(found.medium, z < 0 ? 4 : kVacuum);
    EXPECT_FALSE(found.exterior);
    EXPECT_EQ(found.disputed, kNoIndex);
  }
}

// Surfaces that stop light are hit from both sides, whatever medium they declare on the other one: a boundary decides,
// wherever it is.
TEST(MediumAt, OfASideOfWhatStopsLight) {
  const auto sceneWith = [](bool hasBall) {
    GeometryDescription description;
    TriangleMesh floor;
    floor.positions = {{-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0}};
    floor.triangles = {{0, 1, 2}, {0, 2, 3}};
    GeometryEntry opaque = Separating(MeshShape(floor), kVacuum, 4, false);
    description.entries.push_back(opaque);
    if (hasBall) description.entries.push_back(Separating(SphereAt({4, -3, 5}, 2), 3, 5));
    return GeometryScene(std::move(description));
  };
  const Point3 below(1, 2, -3);
  const FoundMedium byBall = FindMediumAround(sceneWith(true), {1, 2, 3}, 0);
  EXPECT_EQ(byBall.medium, 5);
  EXPECT_TRUE(byBall.isOfBoundary);
  const FoundMedium byFloor = FindMediumAround(sceneWith(false), below, 0);
  EXPECT_EQ(byFloor.medium, kVacuum);
  EXPECT_FALSE(byFloor.isOfBoundary);
}

// A small ball aside of all fixed directions is found by rays towards the scene.
TEST(MediumAt, OfACameraAsideOfAllBoundaries) {
  GeometryDescription description;
  description.entries.push_back(Separating(Sphere(0.4), 3, 5));
  const GeometryScene scene(std::move(description));
  for (const Point3& eye : {Point3(0, 0.2f, 5), Point3(30, 1, -2), Point3(-2, 2, 200)}) {
    const FoundMedium found = FindMediumAround(scene, eye, 0);
    EXPECT_EQ(found.medium, 5);
    EXPECT_EQ(found.exterior, 5);
  }
}

// From a surface all rays leave to the side of its normal.
TEST(MediumAt, OfASideOfASurface) {
  GeometryDescription description;
  description.entries.push_back(Separating(Square(0), 1, 2));
  description.entries.push_back(Separating(Sphere(20), 1, kVacuum));
  const GeometryScene scene(std::move(description));
  for (const float z : {-1.0f, 1.0f}) {
    const FoundMedium found = FindMedium(scene, {0.3f, 0.2f, z * 1e-3f}, 0, {0, 0, z});
    EXPECT_TRUE(found.isUnanimous);
    EXPECT_EQ(found.medium, 1);
  }
}

// One of several boundaries that overlap, or are turned the wrong way, is named.
TEST(MediumAt, NamesWhatIsDisputed) {
  const auto find = [](std::vector<GeometryEntry> entries, const Point3& p) {
    GeometryDescription description;
    description.entries = std::move(entries);
    return FindMedium(GeometryScene(std::move(description)), p, 0);
  };
  const auto overlap = [](const Vector3d& center) {
    return std::vector<GeometryEntry>{Separating(Sphere(1), 1, kVacuum), Separating(SphereAt(center, 1), 2, kVacuum)};
  };
  EXPECT_NE(find(overlap({0.9, 0, 0}), {0.45f, 0, 0}).disputed, kNoIndex);
  EXPECT_EQ(find(overlap({2.5, 0, 0}), {0.45f, 0, 0}).disputed, kNoIndex);
  // The inner one says that vacuum is around it, where medium 1 is.
  const FoundMedium turned = find({Separating(Sphere(3), 1, kVacuum), Separating(Sphere(1), 2, kVacuum)}, Point3(0.0f));
  EXPECT_EQ(turned.medium, 2);
  EXPECT_EQ(turned.disputed, 0u);
  // Surfaces behind one that stops rays contradict nothing.
  const FoundMedium behind = find({Separating(Sphere(3), 1, kVacuum), Separating(Sphere(1), kVacuum, 1, false),
                                   Separating(SphereAt({0.9, 0, 0}, 1), kVacuum, 1, false)},
                                  {-2, 0, 0});
  EXPECT_EQ(behind.medium, 1);
  EXPECT_EQ(behind.disputed, kNoIndex);
}

TEST(MediumAt, FollowsMotion) {
  const MotionChain chain(MotionChain() * AnimatedTransform(Transform::Translate({-2, 0, 0}),
                                                            Transform::Translate({2, 0, 0}), "a shape", {}));
  GeometryDescription description;
  description.objects.push_back({{Separating(Sphere(1), 1, kVacuum)}});
  GeometryInstance instance;
  instance.motion = MakeMotion(chain, {0, 1}, {}, "a shape", {});
  description.instances.push_back(instance);
  const GeometryScene scene(std::move(description));
  for (const float time : {0.0f, 0.5f, 1.0f}) {
    for (const float x : {-2.0f, 0.0f, 2.0f}) {
      EXPECT_EQ(MediumAt(scene, {x, 0.1f, 0}, time, kVacuum), x == 4 * time - 2 ? 1 : kVacuum) << time << " " << x;
    }
  }
}

}  // namespace
}  // namespace lampyr
