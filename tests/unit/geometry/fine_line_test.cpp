// Lines in double beside rays in float: boundaries and surfaces nearer than the rounding of positions.
#include <gtest/gtest.h>

#include <cmath>

#include "geometry/geometry_scene.h"
#include "unit/geometry/helpers.h"

namespace lampyr {
namespace {

using testing::Entry;
using testing::MeshShape;
using testing::Random;
using testing::Sphere;

constexpr int32_t kInside = 3, kOutside = 5;  // media

GeometryEntry Boundary(Shape shape) {
  GeometryEntry entry = Entry(std::move(shape));
  entry.attributes.isBoundary = true;
  entry.attributes.insideMedium = kInside;
  entry.attributes.outsideMedium = kOutside;
  return entry;
}

// A square of half side 9 at the height z, whose outside is up.
Shape Square(float z) {
  TriangleMesh mesh;
  mesh.positions = {{-9, -9, z}, {9, -9, z}, {9, 9, z}, {-9, 9, z}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return MeshShape(mesh);
}

Shape PatchAt(float z) {
  BilinearMesh mesh;
  mesh.positions = {{-9, -9, z}, {9, -9, z}, {9, 9, z}, {-9, 9, z}};
  mesh.patches = {{0, 1, 3, 2}};
  return std::make_shared<const BilinearMesh>(mesh);
}

// The height 0.7 has no float.
constexpr float kHeight = 0.7f;

struct Subject {
  const char* name;
  GeometryDescription description;
};

std::vector<Subject> PlanesAtHeight(bool isBoundary) {
  const auto entry = [&](Shape shape) { return isBoundary ? Boundary(std::move(shape)) : Entry(std::move(shape)); };
  std::vector<Subject> subjects(3);
  subjects[0].name = "triangles";
  subjects[0].description.entries.push_back(entry(Square(kHeight)));
  subjects[1].name = "patch";
  subjects[1].description.entries.push_back(entry(PatchAt(kHeight)));
  subjects[2].name = "instance";
  subjects[2].description.objects.push_back({{entry(Square(kHeight))}});
  const Transform moved = Transform::Translate({3, 0, 0});
  subjects[2].description.instances.push_back({0, moved.ToAffine(), moved.Inverse().ToAffine()});
  return subjects;
}

// A random line from `above` over a point of the plane.
FineLine LineFrom(Random& random, double above) {
  FineLine line;
  line.start = Point3d(random.Uniform(-2, 2), random.Uniform(-2, 2), static_cast<double>(kHeight) + above);
  line.direction = glm::normalize(Vector3d(random.Direction()));
  line.isFineAtStart = true;
  return line;
}
Ray RayAlong(const FineLine& line) {
  return {Point3(line.start), Vector3(line.direction), static_cast<float>(line.length)};
}

TEST(FineLine, CrossesBoundariesNearerThanRounding) {
  for (Subject& subject : PlanesAtHeight(true)) {
    const GeometryScene scene(std::move(subject.description));
    Random random(1);
    int crossed = 0;
    for (int i = 0; i < 20000; ++i) {
      const double above = (i % 2 ? 1 : -1) * std::pow(10.0, static_cast<double>(random.Uniform(-11, -5)));
      const FineLine line = LineFrom(random, above);
      // More grazing ones may miss the plane in float.
      if (std::abs(line.direction.z) < 0.02) continue;
      const double expected = -above / line.direction.z;
      RayHit hit;
      std::vector<Crossing> found;
      const LineHit end = scene.Trace(RayAlong(line), line, visibility::kIndirect, hit, found);
      ASSERT_FALSE(end.isHit || end.isRejected);
      ASSERT_EQ(found.size(), expected > 0 ? 1u : 0u) << subject.name << ", " << above << ", " << expected;
      if (expected < 0) continue;
      ++crossed;
      ASSERT_NEAR(found[0].t, expected, 1e-12);
      ASSERT_EQ(found[0].medium, above > 0 ? kInside : kOutside);
    }
    EXPECT_GT(crossed, 9000) << subject.name;
  }
}

TEST(FineLine, HitsOnlyWhatIsBeforeIt) {
  for (Subject& subject : PlanesAtHeight(false)) {
    const GeometryScene scene(std::move(subject.description));
    Random random(2);
    for (int i = 0; i < 20000; ++i) {
      const double above = (i % 2 ? 1 : -1) * std::pow(10.0, static_cast<double>(random.Uniform(-11, -5)));
      const FineLine line = LineFrom(random, above);
      if (std::abs(line.direction.z) < 0.02) continue;
      const double expected = -above / line.direction.z;
      RayHit hit;
      std::vector<Crossing> found;
      const LineHit end = scene.Trace(RayAlong(line), line, visibility::kIndirect, hit, found);
      ASSERT_EQ(end.isHit, expected > 0) << subject.name;
      if (end.isHit) {
        ASSERT_NEAR(end.t, expected, 1e-12);
        ASSERT_EQ(hit.t, static_cast<float>(end.t));
      }
    }
  }
}

// Between two points on either side of a boundary, or on the same one.
TEST(FineLine, CrossesBetweenItsEnds) {
  for (Subject& subject : PlanesAtHeight(true)) {
    const GeometryScene scene(std::move(subject.description));
    Random random(3);
    int crossed = 0;
    for (int i = 0; i < 20000; ++i) {
      const auto aside = [&](int side) { return side * std::pow(10.0, static_cast<double>(random.Uniform(-10, 0))); };
      const double from = aside(i % 2 ? 1 : -1), to = aside(i % 4 < 2 ? 1 : -1);
      FineLine line = LineFrom(random, from);
      const Point3d end(random.Uniform(-2, 2), random.Uniform(-2, 2), static_cast<double>(kHeight) + to);
      line.length = glm::length(end - line.start);
      line.direction = (end - line.start) / line.length;
      line.isFineAtEnd = true;
      if (std::abs(line.direction.z) < 0.02) continue;
      std::vector<Crossing> found;
      ASSERT_EQ(scene.Transmittance(RayAlong(line), line, visibility::kShadow, found), Color(1.0f));
      ASSERT_EQ(found.size(), from * to < 0 ? 1u : 0u) << subject.name << ", " << from << " to " << to;
      if (found.empty()) continue;
      ++crossed;
      ASSERT_NEAR(found[0].t, -from / line.direction.z, 1e-12);
    }
    EXPECT_GT(crossed, 2500) << subject.name;
  }
}

// A floor just behind the start does not hide it, one just before it does.
TEST(FineLine, IsNotStoppedBehindItsEnds) {
  GeometryDescription description;
  description.entries.push_back(Entry(Square(kHeight)));
  description.entries.push_back(Boundary(Square(2)));
  const GeometryScene scene(std::move(description));
  Random random(4);
  for (int i = 0; i < 2000; ++i) {
    FineLine line = LineFrom(random, i % 2 ? 5e-6 : 1e-10);
    const Point3d end(random.Uniform(-2, 2), random.Uniform(-2, 2), 3.0);
    line.length = glm::length(end - line.start);
    line.direction = (end - line.start) / line.length;
    std::vector<Crossing> found;
    ASSERT_EQ(scene.Transmittance(RayAlong(line), line, visibility::kShadow, found), Color(1.0f));
    ASSERT_EQ(found.size(), 1u);
    line.start.z = static_cast<double>(kHeight) - 1e-10;
    ASSERT_TRUE(scene.Transmittance(RayAlong(line), line, visibility::kShadow, found).IsBlack());
  }
}

TEST(FineLine, MeetsASphereOnItsRim) {
  GeometryDescription description;
  description.entries.push_back(Boundary(Sphere(0.7f)));
  const GeometryScene scene(std::move(description));
  const double radius = static_cast<double>(0.7f);
  Random random(5);
  for (int i = 0; i < 20000; ++i) {
    const double outside = (i % 2 ? 1 : -1) * std::pow(10.0, static_cast<double>(random.Uniform(-11, -6)));
    const Vector3d normal = glm::normalize(Vector3d(random.Direction()));
    FineLine line{(radius + outside) * normal, glm::normalize(Vector3d(random.Direction()))};
    line.isFineAtStart = true;
    const double cosine = glm::dot(normal, line.direction);
    if (std::abs(cosine) < 0.05) continue;
    RayHit hit;
    std::vector<Crossing> found;
    scene.Trace(RayAlong(line), line, visibility::kIndirect, hit, found);
    ASSERT_EQ(found.size(), outside < 0 ? 1u : cosine < 0 ? 2u : 0u) << outside << " " << cosine;
    if (!found.empty()) {
      ASSERT_EQ(found.back().medium, kOutside);
    }
    for (const Crossing& crossing : found)
      ASSERT_NEAR(glm::length(line.start + crossing.t * line.direction), radius, 1e-13);
  }
}

TEST(FineLine, IsRejectedLikeItsRay) {
  GeometryDescription description;
  description.entries.push_back(Boundary(Sphere(1)));
  const GeometryScene scene(std::move(description));
  RayHit hit;
  std::vector<Crossing> found;
  EXPECT_TRUE(scene.Trace({{0, 0, 0}, {0, 0, 0}}, FineLine(), visibility::kIndirect, hit, found).isRejected);
  EXPECT_TRUE(scene.Transmittance({{0, 0, 0}, {0, 0, 0}}, FineLine(), visibility::kIndirect, found).IsBlack());
  EXPECT_EQ(scene.RejectedRays(), 2u);
}

}  // namespace
}  // namespace lampyr
