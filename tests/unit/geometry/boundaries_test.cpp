// Boundaries between participating media: what rays cross, against analytic crossings in the shapes' own space.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <optional>

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

constexpr int32_t kInside = 3, kOutside = 5;  // media

GeometryEntry Boundary(Shape shape, int32_t inside = kInside, int32_t outside = kOutside) {
  GeometryEntry entry = Entry(std::move(shape));
  entry.attributes.isBoundary = true;
  entry.attributes.insideMedium = inside;
  entry.attributes.outsideMedium = outside;
  return entry;
}

TriangleMesh Box(const Point3& min, const Point3& max) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.positions.emplace_back(i & 1 ? max.x : min.x, i & 2 ? max.y : min.y, i & 4 ? max.z : min.z);
  const std::array<uint32_t, 4> faces[] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                           {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& f : faces) {
    mesh.triangles.push_back({f[0], f[1], f[2]});
    mesh.triangles.push_back({f[0], f[2], f[3]});
  }
  return mesh;
}

BilinearMesh PatchBox() {
  const TriangleMesh box = Box(Point3(-1), Point3(1));
  BilinearMesh mesh;
  mesh.positions = box.positions;
  for (size_t i = 0; i < box.triangles.size(); i += 2) {
    const auto &a = box.triangles[i], &b = box.triangles[i + 1];
    mesh.patches.push_back({a[0], a[1], b[2], a[2]});
  }
  return mesh;
}

struct Expected {
  double t;
  bool entering;
};

// Crossings along the whole line, by increasing t. `isSure`: false where rounding may decide what is crossed.
struct Line {
  std::vector<Expected> crossings;
  bool isSure = true;
};

using Analytic = Line (*)(const Point3d&, const Vector3d&);

constexpr double kDoubt = 1e-4;

Line CrossSphere(const Point3d& o, const Vector3d& d) {
  const double a = glm::dot(d, d), b = glm::dot(o, d), c = glm::dot(o, o) - 1;
  const double discriminant = b * b - a * c;
  Line line;
  line.isSure = std::abs(discriminant) > kDoubt * a;
  if (discriminant < 0) return line;
  const double root = std::sqrt(discriminant);
  line.crossings = {{(-b - root) / a, true}, {(-b + root) / a, false}};
  return line;
}

// The mantle of a cylinder of radius 1, z from -1 to 1.
Line CrossTube(const Point3d& o, const Vector3d& d) {
  const double a = d.x * d.x + d.y * d.y, b = o.x * d.x + o.y * d.y, c = o.x * o.x + o.y * o.y - 1;
  const double discriminant = b * b - a * c;
  Line line;
  line.isSure = std::abs(discriminant) > kDoubt * a && a > kDoubt * glm::dot(d, d);
  if (!(discriminant > 0)) return line;
  for (const bool entering : {true, false}) {
    const double t = (-b + (entering ? -1 : 1) * std::sqrt(discriminant)) / a, z = o.z + t * d.z;
    line.isSure = line.isSure && std::abs(std::abs(z) - 1) > kDoubt;
    if (std::abs(z) < 1) line.crossings.push_back({t, entering});
  }
  return line;
}

// A ring at z = 0, between the radii 0.4 and 1, whose outside is above.
Line CrossRing(const Point3d& o, const Vector3d& d) {
  const double t = -o.z / d.z, radius = std::hypot(o.x + t * d.x, o.y + t * d.y);
  Line line;
  line.isSure = std::abs(d.z) > kDoubt && std::abs(radius - 1) > kDoubt && std::abs(radius - 0.4) > kDoubt;
  if (radius < 1 && radius > 0.4) line.crossings.push_back({t, d.z < 0});
  return line;
}

// The box from -1 to 1.
Line CrossBox(const Point3d& o, const Vector3d& d) {
  double first = -1e30, second = -1e30, last = 1e30, beforeLast = 1e30;
  Line line;
  for (int k = 0; k < 3; ++k) {
    line.isSure = line.isSure && std::abs(d[k]) > kDoubt;
    const double in = (-std::copysign(1.0, d[k]) - o[k]) / d[k], out = (std::copysign(1.0, d[k]) - o[k]) / d[k];
    second = std::max(second, std::min(first, in));
    first = std::max(first, in);
    beforeLast = std::min(beforeLast, std::max(last, out));
    last = std::min(last, out);
  }
  line.isSure = line.isSure && std::min({std::abs(last - first), first - second, beforeLast - last}) > kDoubt;
  if (first < last) line.crossings = {{first, true}, {last, false}};
  return line;
}

// z = 0.1 + 0.2 x - 0.3 y + 0.6 x y over [-1,1]², whose outside is above.
double Saddle(double x, double y) {
  return 0.1 + 0.2 * x - 0.3 * y + 0.6 * x * y;
}

Line CrossSaddle(const Point3d& o, const Vector3d& d) {
  const double a = 0.6 * d.x * d.y, b = 0.2 * d.x - 0.3 * d.y + 0.6 * (o.x * d.y + o.y * d.x) - d.z,
               c = Saddle(o.x, o.y) - o.z, discriminant = b * b - 4 * a * c;
  Line line;
  line.isSure = std::abs(discriminant) > kDoubt && std::abs(a) > kDoubt;
  if (!(discriminant > 0)) return line;
  std::array<double, 2> roots = {(-b - std::sqrt(discriminant)) / (2 * a), (-b + std::sqrt(discriminant)) / (2 * a)};
  std::sort(roots.begin(), roots.end());
  for (const double t : roots) {
    const double x = o.x + t * d.x, y = o.y + t * d.y;
    line.isSure = line.isSure && std::abs(std::abs(x) - 1) > kDoubt && std::abs(std::abs(y) - 1) > kDoubt;
    if (std::abs(x) > 1 || std::abs(y) > 1) continue;
    line.crossings.push_back({t, 2 * a * t + b > 0});  // the height above the surface falls
  }
  return line;
}

BilinearMesh SaddlePatch() {
  BilinearMesh mesh;
  for (const double y : {-1.0, 1.0})
    for (const double x : {-1.0, 1.0}) mesh.positions.emplace_back(x, y, Saddle(x, y));
  mesh.patches = {{0, 1, 2, 3}};
  return mesh;
}

Quadric QuadricOf(Quadric::Kind kind) {
  Quadric quadric = Sphere(1);
  quadric.kind = kind;
  if (kind == Quadric::Kind::Disk) {
    quadric.innerRadius = 0.4f;
    quadric.zMin = quadric.zMax = 0;
  }
  return quadric;
}

struct Subject {
  const char* name;
  Shape shape;
  Analytic cross;
};

std::vector<Subject> Subjects() {
  return {{"sphere", QuadricOf(Quadric::Kind::Sphere), CrossSphere},
          {"tube", QuadricOf(Quadric::Kind::Cylinder), CrossTube},
          {"ring", QuadricOf(Quadric::Kind::Disk), CrossRing},
          {"mesh", MeshShape(Box(Point3(-1), Point3(1))), CrossBox},
          {"patches", std::make_shared<const BilinearMesh>(PatchBox()), CrossBox},
          {"saddle", std::make_shared<const BilinearMesh>(SaddlePatch()), CrossSaddle}};
}

// Expected crossings in (0, tMax) of a ray from `o` along `d`, both in the shape's own space.
std::optional<std::vector<Expected>> Expect(Analytic cross, const Point3d& o, const Vector3d& d, double tMax) {
  Line line = cross(o, d);
  if (!line.isSure) return std::nullopt;
  for (const Expected& e : line.crossings)
    if (std::abs(e.t) < kDoubt || std::abs(e.t - tMax) < kDoubt) return std::nullopt;
  std::erase_if(line.crossings, [&](const Expected& e) { return e.t < 0 || e.t > tMax; });
  return line.crossings;
}

void ExpectCrossings(const std::vector<Crossing>& found, const std::vector<Expected>& expected, bool isReversed) {
  ASSERT_EQ(found.size(), expected.size());
  for (size_t i = 0; i < found.size(); ++i) {
    ASSERT_NEAR(found[i].t, expected[i].t, 1e-4 * (1 + expected[i].t));
    ASSERT_EQ(found[i].entering, expected[i].entering != isReversed);
    ASSERT_EQ(found[i].medium, found[i].entering ? kInside : kOutside);
    ASSERT_EQ(found[i].transmittance, Color(1.0f));
  }
}

// 1e4 rays in a scene of one boundary, placed at a time by `placement`.
template <class Placement>
void CheckRays(const GeometryScene& scene, const Subject& subject, const Placement& placement, bool isReversed,
               uint32_t seed) {
  ASSERT_TRUE(scene.HasBoundaries());
  Random random(seed);
  int checked = 0, crossed = 0;
  for (int i = 0; i < 10000; ++i) {
    Ray ray{{}, {}, i % 2 ? kInfinity : random.Uniform(0, 6), random.Uniform()};
    const Affine toRender = placement(ray.time);
    ray.origin = toRender.Point(random.InBox(1.8f));
    ray.direction = glm::normalize(toRender.Point(random.InBox(1)) - ray.origin);
    const glm::dmat3 toObject = glm::inverse(glm::dmat3(toRender.linear));
    const auto expected = Expect(subject.cross, toObject * Vector3d(ray.origin - toRender.translation),
                                 toObject * Vector3d(ray.direction), static_cast<double>(ray.tMax));
    if (!expected) continue;
    ++checked;
    crossed += !expected->empty();
    const uint32_t kinds = 1u << (i % 3);
    RayHit hit;
    std::vector<Crossing> found;
    Color tint;
    ASSERT_FALSE(scene.Trace(ray, kinds, hit, found));
    ASSERT_NO_FATAL_FAILURE(ExpectCrossings(found, *expected, isReversed)) << subject.name << ", ray " << i;
    ASSERT_EQ(scene.Transmittance(ray, kinds, found), Color(1.0f));
    ASSERT_NO_FATAL_FAILURE(ExpectCrossings(found, *expected, isReversed)) << subject.name << ", shadow ray " << i;
    ASSERT_EQ(scene.Transmittance(ray, kinds), Color(1.0f));
    ASSERT_FALSE(scene.Intersect(ray, kinds, hit, tint));
    ASSERT_EQ(tint, Color(1.0f));
  }
  EXPECT_GT(checked, 9000) << subject.name;
  EXPECT_GT(crossed, 3000) << subject.name;
}

const Transform kPlacements[] = {
    Transform(), Transform::Translate({5, -3, 2}) * Transform::Rotate(50, {1, 2, 3}) * Transform::Scale({0.5, 2, 1.2}),
    Transform::Translate({1, 0, 2}) * Transform::Scale({1, -1, 1}) * Transform::Rotate(20, {1, 0, 1}),
    Transform(glm::dmat4(1, 0.3, 0, 0, -0.4, 1, 0.1, 0, 0.2, 0, -1, 0, 1, 1, 1, 1))};  // sheared and mirrored

// Rays of all kinds cross a boundary, although its shape is visible to the camera alone.
GeometryEntry Unseen(const Subject& subject) {
  GeometryEntry entry = Boundary(subject.shape);
  entry.attributes.visibility = visibility::kCamera;
  entry.attributes.isParametrized = false;
  return entry;
}

TEST(Boundaries, OfInstancesAreWhereTheyShouldBe) {
  for (const Subject& subject : Subjects()) {
    for (size_t i = 0; i < std::size(kPlacements); ++i) {
      GeometryDescription description;
      description.objects.push_back({{Unseen(subject)}});
      description.instances.push_back({0, kPlacements[i].ToAffine(), kPlacements[i].Inverse().ToAffine()});
      const GeometryScene scene(std::move(description));
      CheckRays(
          scene, subject, [&](float) { return kPlacements[i].ToAffine(); }, false, 100 + static_cast<uint32_t>(i));
    }
  }
}

// ReverseOrientation swaps the sides.
TEST(Boundaries, OutsideInstancesHaveSides) {
  for (const Subject& subject : Subjects()) {
    for (const bool isReversed : {false, true}) {
      Subject turned = subject;
      if (const auto* mesh = std::get_if<std::shared_ptr<const TriangleMesh>>(&subject.shape)) {
        TriangleMesh copy = **mesh;
        copy.flipNormals = isReversed;
        turned.shape = MeshShape(copy);
      } else if (const auto* patches = std::get_if<std::shared_ptr<const BilinearMesh>>(&subject.shape)) {
        BilinearMesh copy = **patches;
        copy.flipNormals = isReversed;
        turned.shape = std::make_shared<const BilinearMesh>(copy);
      } else {
        turned.shape = Place(std::get<Quadric>(subject.shape), Transform(), isReversed);
      }
      GeometryDescription description;
      description.entries.push_back(Unseen(turned));
      CheckRays(
          GeometryScene(std::move(description)), turned, [](float) { return Affine(); }, isReversed, 7);
    }
  }
}

TEST(Boundaries, Move) {
  const Transform start = Transform::Translate({-0.5, 0, 0.2}) * Transform::Scale({1, 1.3, 0.8});
  const Transform end = Transform::Translate({0.6, 0.3, -0.2}) * Transform::Rotate(70, {1, 0.4, 0.2});
  const MotionChain chain = MotionChain() * AnimatedTransform(start, end, "a shape", {});
  for (const Subject& subject : Subjects()) {
    for (const MotionTimes& times : {MotionTimes{0, 1}, MotionTimes{0.3, 0.6}}) {
      GeometryDescription description;
      description.objects.push_back({{Unseen(subject)}});
      GeometryInstance instance;
      instance.motion = MakeMotion(chain, times, {}, "a shape", {});
      description.instances.push_back(instance);
      const GeometryScene scene(std::move(description));
      CheckRays(
          scene, subject, [&](float time) { return instance.motion->At(time); }, false, 9);
    }
  }
}

// The medium at the end of a ray is the one that the end is in, whatever was crossed: nested, displaced and instanced
// closed shapes, from starts and to ends inside and outside of all of them.
TEST(Boundaries, LeadToTheMediumOfTheEnd) {
  GeometryDescription description;
  description.entries.push_back(Boundary(Sphere(2), 1, kVacuum));
  description.entries.push_back(Boundary(MeshShape(Box(Point3(-0.5f), Point3(0.9f))), 2, 1));
  description.objects.push_back({{Boundary(Sphere(0.3f), 3, 2)}});
  const Transform stretched = Transform::Translate({0.2, 0.1, 0.2}) * Transform::Scale({1, -2, 0.5});
  description.instances.push_back({0, stretched.ToAffine(), stretched.Inverse().ToAffine()});
  const GeometryScene scene(std::move(description));
  const auto mediumAt = [&](const Point3& p) {
    if (glm::length(stretched.Inverse().Point(Point3d(p))) < 0.3) return 3;
    if (p.x > -0.5f && p.y > -0.5f && p.z > -0.5f && MaxComponent(p) < 0.9f) return 2;
    return glm::length(p) < 2 ? 1 : kVacuum;
  };
  Random random(12);
  std::array<int, 5> ends{};
  std::vector<Crossing> crossings;
  for (int i = 0; i < 100000; ++i) {
    const Point3 from = random.InBox(i % 2 ? 1.0f : 2.5f), to = random.InBox(i % 4 < 2 ? 1.0f : 2.5f);
    const Ray ray{from, glm::normalize(to - from), glm::length(to - from)};
    RayHit hit;
    ASSERT_FALSE(scene.Trace(ray, visibility::kIndirect, hit, crossings));
    int32_t medium = mediumAt(from);
    double last = 0;
    for (const Crossing& crossing : crossings) {
      ASSERT_NE(crossing.medium, medium) << i;
      ASSERT_GE(crossing.t, last);
      last = crossing.t;
      medium = crossing.medium;
    }
    ASSERT_EQ(medium, mediumAt(to)) << i;
    ++ends[static_cast<size_t>(medium + 1)];
  }
  for (const int32_t medium : {kVacuum, 1, 2, 3}) EXPECT_GT(ends[static_cast<size_t>(medium + 1)], 500) << medium;
}

// A rounded point of a sphere is inside or outside of it, and a ray from there crosses accordingly. One that starts in
// the plane of a face has not crossed it.
TEST(Boundaries, ThatARayStartsOn) {
  const GeometryScene sphere([] {
    GeometryDescription description;
    description.entries.push_back(Boundary(Sphere(1)));
    return description;
  }());
  Random random(13);
  int inside = 0;
  std::vector<Crossing> crossings;
  RayHit hit;
  for (int i = 0; i < 10000; ++i) {
    const Point3 start = random.Direction();
    const double excess = glm::dot(Point3d(start), Point3d(start)) - 1;
    if (std::abs(excess) < 1e-14) continue;
    Vector3 inwards = random.Direction();
    if (glm::dot(inwards, start) > 0) inwards = -inwards;
    if (glm::dot(inwards, start) > -0.01f) continue;
    inside += excess < 0;
    ASSERT_FALSE(sphere.Trace({start, inwards}, visibility::kIndirect, hit, crossings));
    ASSERT_EQ(crossings.size(), excess < 0 ? 1u : 2u) << i;
    EXPECT_EQ(crossings.back().medium, kOutside);
  }
  EXPECT_GT(inside, 1000);
  const GeometryScene box([] {
    GeometryDescription description;
    description.entries.push_back(Boundary(MeshShape(Box(Point3(-1), Point3(1)))));
    return description;
  }());
  for (int i = 0; i < 1000; ++i) {
    const Point3 start(random.Uniform(-0.9f, 0.9f), random.Uniform(-0.9f, 0.9f), 1);
    Vector3 direction = random.Direction();
    ASSERT_FALSE(box.Trace({start, direction}, visibility::kIndirect, hit, crossings));
    ASSERT_EQ(crossings.size(), direction.z < 0 ? 1u : 0u);
  }
}

Shape Square(float z) {
  TriangleMesh mesh;
  mesh.positions = {{-9, -9, z}, {9, -9, z}, {9, 9, z}, {-9, 9, z}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return MeshShape(mesh);
}

std::vector<int32_t> MediaAlong(const GeometryScene& scene, const Ray& ray) {
  std::vector<Crossing> crossings;
  RayHit hit;
  EXPECT_FALSE(scene.Trace(ray, visibility::kIndirect, hit, crossings));
  std::vector<int32_t> media;
  double last = 0;
  for (const Crossing& crossing : crossings) {
    EXPECT_GE(crossing.t, last);
    last = crossing.t;
    media.push_back(crossing.medium);
  }
  return media;
}

// Between boxes that touch, and along edges: a ray leaves before it enters, and crosses once.
TEST(Boundaries, AtEqualDistances) {
  GeometryDescription description;
  description.entries.push_back(Boundary(MeshShape(Box({-1, -1, 0}, {1, 1, 1})), 1, kVacuum));
  description.entries.push_back(Boundary(MeshShape(Box({-1, -1, 1}, {1, 1, 2})), 2, kVacuum));
  const GeometryScene scene(std::move(description));
  for (const float x : {0.0f, 0.3f, -0.5f}) {  // the diagonal of the faces, and beside it
    EXPECT_EQ(MediaAlong(scene, {{x, x, -1}, {0, 0, 1}}), (std::vector<int32_t>{1, kVacuum, 2, kVacuum})) << x;
    EXPECT_EQ(MediaAlong(scene, {{x, x, 3}, {0, 0, -1}}), (std::vector<int32_t>{2, kVacuum, 1, kVacuum})) << x;
    EXPECT_EQ(MediaAlong(scene, {{x, x, 1.5f}, {0, 0, -1}}), (std::vector<int32_t>{kVacuum, 1, kVacuum})) << x;
  }
}

// Boxes that touch and boxes within a box that share its faces, turned and shifted so that the distances of the faces
// are rounded differently: no ray meets a false medium.
TEST(Boundaries, ThatTouchAreCrossedInTurn) {
  Random random(21);
  int touched = 0;
  for (int i = 0; i < 40; ++i) {
    const Transform place = Transform::Translate(Vector3d(random.InBox(50))) *
                            Transform::Rotate(random.Uniform(0, 360), Vector3d(random.Direction()));
    const Affine toRender = place.ToAffine();
    const auto placedBox = [&](const Point3& min, const Point3& max) {
      TriangleMesh box = Box(min, max);
      for (Point3& p : box.positions) p = toRender.Point(p);
      return MeshShape(box);
    };
    GeometryDescription description;
    description.entries.push_back(Boundary(placedBox({-1, -1, -1}, {1, 1, 0}), 1, kVacuum));
    description.objects.push_back({{Boundary(MeshShape(Box({-1, -1, 0}, {1, 1, 1})), 2, kVacuum)}});
    description.instances.push_back({0, toRender, place.Inverse().ToAffine()});
    description.entries.push_back(Boundary(placedBox({-0.9f, -0.9f, 0}, {0.9f, 0.9f, 0.5f}), 3, 2));
    const GeometryScene scene(std::move(description));
    for (int k = 0; k < 1000; ++k) {
      const Point3 top(random.Uniform(-0.8f, 0.8f), random.Uniform(-0.8f, 0.8f), 2);
      const Point3 bottom(random.Uniform(-0.8f, 0.8f), random.Uniform(-0.8f, 0.8f), -2);
      const bool isUp = k % 2;
      const Point3 from = toRender.Point(isUp ? bottom : top), to = toRender.Point(isUp ? top : bottom);
      const std::vector<int32_t> media = MediaAlong(scene, {from, glm::normalize(to - from)});
      const std::vector<int32_t> up = {1, kVacuum, 2, 3, 2, kVacuum}, down = {2, 3, 2, kVacuum, 1, kVacuum};
      ASSERT_EQ(media, isUp ? up : down) << i << " " << k;
      ++touched;
    }
  }
  EXPECT_EQ(touched, 40000);
}

// A ray through an edge that meets the faces on both of its sides has touched the box, and goes on outside.
TEST(Boundaries, ThatAreTouchedAtAnEdge) {
  GeometryDescription description;
  description.entries.push_back(Boundary(MeshShape(Box(Point3(-1), Point3(1))), 1, kVacuum));
  description.entries.push_back(Entry(Square(-4)));
  const GeometryScene scene(std::move(description));
  Random random(22);
  std::vector<Crossing> crossings;
  int touched = 0;
  for (int i = 0; i < 10000; ++i) {
    const Point3 edge(1, random.Uniform(-0.9f, 0.9f), 1);
    const Vector3 offset(0.5f, random.Uniform(-0.3f, 0.3f), -0.5f);  // both faces are seen under the same angle
    const Ray ray{edge - offset, glm::normalize(offset)};
    RayHit hit;
    ASSERT_TRUE(scene.Trace(ray, visibility::kIndirect, hit, crossings));
    touched += !crossings.empty();
    ASSERT_TRUE(crossings.empty() || crossings.back().medium == kVacuum) << i;
  }
  EXPECT_GT(touched, 1000);
}

class Pane : public ThinSurface {
 public:
  explicit Pane(const Color& tint) : tint_(tint) {}
  float TransmittedFraction(float) const override { return 1; }
  Color Tint(const Point2&, const Point3&, const Normal3&) const override { return tint_; }
  bool IsClear() const override { return tint_ == Color(1.0f); }

 private:
  Color tint_;
};

class Opacity : public AlphaSource {
 public:
  // Opacity where x > `from` in render space, and 0 elsewhere.
  Opacity(float opacity, float from) : opacity_(opacity), from_(from) {}
  float Alpha(const Point2&, const Point3& p, const Normal3&) const override { return p.x > from_ ? opacity_ : 0.0f; }

 private:
  float opacity_, from_;
};

// Boundaries, tinted panes, a clear pane between media and cut-outs above a wall: crossings in order, the tint as
// without boundaries, and one transmittance by all ways.
TEST(Boundaries, AmongThinSurfacesAndCutOuts) {
  const Color tint(0.5f, 0.8f, 0.9f);
  const auto build = [&](bool hasBoundaries) {
    GeometryDescription description;
    for (int i = 0; i < 12; ++i) {
      if (hasBoundaries) description.entries.push_back(Boundary(Square(3.0f + 0.5f * static_cast<float>(i)), i, i + 1));
      if (i % 4) continue;
      description.entries.push_back(Entry(Square(3.2f + 0.5f * static_cast<float>(i))));
      description.entries.back().attributes.thin = std::make_shared<Pane>(tint);
    }
    description.entries.push_back(Entry(Square(2), std::make_shared<Opacity>(0.25f, -99.0f)));
    description.entries.back().attributes.insideMedium = 77;
    description.entries.push_back(Entry(Square(1)));
    description.entries.back().attributes.thin = std::make_shared<Pane>(Color(1.0f));
    description.entries.back().attributes.insideMedium = 50;
    description.entries.push_back(Boundary(Square(-1), 99, 98));  // behind the wall
    description.entries.push_back(Entry(Square(0)));
    return std::make_unique<GeometryScene>(std::move(description));
  };
  const auto scene = build(true), plain = build(false);
  Random random(14);
  int throughHole = 0;
  constexpr int kCount = 10000;
  std::vector<Crossing> crossings;
  for (int i = 0; i < kCount; ++i) {
    Ray ray{{random.Uniform(-1, 1), random.Uniform(-1, 1), 10}, {}};
    ray.direction = glm::normalize(Vector3(random.Uniform(-0.1f, 0.1f), random.Uniform(-0.1f, 0.1f), -1));
    RayHit hit, plainHit;
    Color passed, plainPassed;
    ASSERT_TRUE(scene->Trace(ray, visibility::kIndirect, hit, crossings));
    const bool isWall = hit.t > 9.5f;
    throughHole += isWall;
    ASSERT_EQ(crossings.size(), isWall ? 16u : 15u);
    for (size_t k = 1; k < crossings.size(); ++k) ASSERT_GT(crossings[k].t, crossings[k - 1].t);
    int32_t expected = 11;
    for (const Crossing& crossing : crossings) {
      if (crossing.medium == kSameMedium) {
        ASSERT_EQ(crossing.transmittance, tint);
      } else if (crossing.medium != 50) {
        ASSERT_EQ(crossing.medium, expected--);
      }
    }
    ASSERT_EQ(crossings.back().medium, isWall ? 50 : 0);
    ASSERT_TRUE(scene->Intersect(ray, visibility::kIndirect, hit, passed));
    ASSERT_TRUE(plain->Intersect(ray, visibility::kIndirect, plainHit, plainPassed));
    ASSERT_EQ(passed, Transmittance(crossings));
    // The same tint. The wall and the cut-out are other primitives there, and the chance of a hole is another.
    ASSERT_EQ(passed, plainPassed);
    ASSERT_TRUE(scene->Transmittance(ray, visibility::kShadow, crossings).IsBlack());
    ASSERT_TRUE(crossings.empty());
    ray.tMax = 9.5f / -ray.direction.z;
    const Color left = scene->Transmittance(ray, visibility::kShadow, crossings);
    ASSERT_EQ(crossings.size(), 16u);
    ASSERT_EQ(left, scene->Transmittance(ray, visibility::kShadow));
    ASSERT_EQ(left, plain->Transmittance(ray, visibility::kShadow));
    ASSERT_NEAR(left.r, 0.75f * tint.r * tint.r * tint.r, 1e-6f);
  }
  EXPECT_NEAR(throughHole / double(kCount), 0.75, 5 * std::sqrt(0.75 * 0.25 / kCount));
}

TEST(Boundaries, EndWhereTheirOpacityIsZero) {
  for (const bool isThin : {false, true}) {
    GeometryDescription description;
    GeometryEntry entry = Boundary(Sphere(1));
    entry.attributes.alpha = std::make_shared<Opacity>(0.5f, 1.0f);
    entry.attributes.isBoundary = !isThin;
    if (isThin) entry.attributes.thin = std::make_shared<Pane>(Color(1.0f));
    description.objects.push_back({{entry}});
    const Transform there = Transform::Translate({1, 0, 0});
    description.instances.push_back({0, there.ToAffine(), there.Inverse().ToAffine()});
    const GeometryScene scene(std::move(description));
    Random random(15);
    std::vector<Crossing> crossings;
    for (int i = 0; i < 1000; ++i) {
      const Ray ray{{random.Uniform(0.4f, 1.6f), random.Uniform(-0.6f, 0.6f), 3}, {0, 0, -1}};
      RayHit hit;
      ASSERT_FALSE(scene.Trace(ray, visibility::kIndirect, hit, crossings));
      const auto changes = std::count_if(crossings.begin(), crossings.end(),
                                         [](const Crossing& crossing) { return crossing.medium != kSameMedium; });
      ASSERT_EQ(changes, ray.origin.x > 1 ? 2 : 0);
      if (!isThin) {
        ASSERT_EQ(crossings.size(), static_cast<size_t>(changes));
      }
    }
  }
}

// A surface that separates media stops the rays that see it. To the others it is a boundary.
TEST(Boundaries, AreWhatUnseenSurfacesAre) {
  GeometryDescription description;
  for (Shape shape : {Shape(Sphere(1)), MeshShape(Box({-1, -1, 3}, {1, 1, 4}))}) {
    description.entries.push_back(Boundary(std::move(shape)));
    description.entries.back().attributes.isBoundary = false;
    description.entries.back().attributes.visibility = visibility::kIndirect | visibility::kShadow;
  }
  const GeometryScene scene(std::move(description));
  const Ray ray{{0.2f, 0.1f, -5}, {0, 0, 1}};
  std::vector<Crossing> crossings;
  RayHit hit;
  ASSERT_FALSE(scene.Trace(ray, visibility::kCamera, hit, crossings));
  ASSERT_EQ(crossings.size(), 4u);
  for (size_t i = 0; i < 4; ++i) EXPECT_EQ(crossings[i].medium, i % 2 ? kOutside : kInside);
  ASSERT_TRUE(scene.Trace(ray, visibility::kIndirect, hit, crossings));
  EXPECT_EQ(hit.primitive, 0u);
  EXPECT_TRUE(crossings.empty());
  EXPECT_FALSE(scene.Occluded(ray, visibility::kCamera));
  EXPECT_TRUE(scene.Occluded(ray, visibility::kShadow));
}

TEST(Boundaries, AreNoCurves) {
  CurveSet curve;
  curve.kind = CurveSet::Kind::Cylinder;
  curve.segments = {{Point3(-3, 0, 0), Point3(-1, 0, 0), Point3(1, 0, 0), Point3(3, 0, 0)}};
  curve.radii = {{2, 2, 2, 2}};
  curve.uRange = {{0, 1}};
  GeometryDescription description;
  description.entries.push_back(Boundary(std::make_shared<const CurveSet>(curve)));
  EXPECT_THROW(GeometryScene{description}, Error);
  EXPECT_FALSE(GeometryScene(SceneOf(Sphere(1))).HasBoundaries());
}

}  // namespace
}  // namespace lampyr
