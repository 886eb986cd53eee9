// The walk of rays through a grid of majorants, against the cell of each point on its own.
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "media/majorant_grid.h"
#include "sampling/rng.h"
#include "sampling/warp.h"

namespace lampyr::testing {
namespace {

// Cells of a few values, so that neighbours are often equal, some of them 0.
std::vector<float> FewValues(int count, Rng& rng) {
  std::vector<float> values(static_cast<size_t>(count));
  for (float& value : values) value = std::floor(4 * rng.NextFloat());
  return values;
}

Affine Placed(const Transform& toRender) {
  return toRender.Inverse().ToAffine();
}

RayDouble InDouble(const Ray& ray, float tMin, float tMax) {
  return {Point3d(ray.origin), Vector3d(ray.direction), static_cast<double>(tMin), static_cast<double>(tMax)};
}

std::vector<MajorantSegment> SegmentsOf(const MajorantGrid& grid, const Ray& ray, float tMin, float tMax) {
  std::vector<MajorantSegment> segments;
  grid.Walk(InDouble(ray, tMin, tMax), [&](const MajorantSegment& segment) {
    segments.push_back(segment);
    return true;
  });
  return segments;
}

// Segments in order, without gaps, not empty, and within the range.
void CheckOrder(const std::vector<MajorantSegment>& segments, float tMin, float tMax) {
  for (size_t i = 0; i < segments.size(); ++i) {
    ASSERT_LT(segments[i].tMin, segments[i].tMax);
    ASSERT_GE(segments[i].tMin, tMin);
    ASSERT_LE(segments[i].tMax, tMax);
    if (i == 0) continue;
    ASSERT_EQ(segments[i].tMin, segments[i - 1].tMax);
    ASSERT_NE(segments[i].majorant, segments[i - 1].majorant);
  }
}

// The overlap of a ray with the box of the grid, by the sides of the box one by one, in double.
bool OverlapOf(const Bounds3& box, const Affine& toMedium, const Ray& ray, double& from, double& to) {
  const Point3d o = glm::dmat3(toMedium.linear) * Point3d(ray.origin) + Vector3d(toMedium.translation);
  const Vector3d d = glm::dmat3(toMedium.linear) * Vector3d(ray.direction);
  for (int axis = 0; axis < 3; ++axis) {
    const double low = static_cast<double>(box.min[axis]), high = static_cast<double>(box.max[axis]);
    if (d[axis] == 0) {
      if (o[axis] < low || o[axis] > high) return false;
      continue;
    }
    const double a = (low - o[axis]) / d[axis], b = (high - o[axis]) / d[axis];
    from = std::max(from, std::min(a, b));
    to = std::min(to, std::max(a, b));
  }
  return from < to;
}

// Compares with the values at points of the ray, but for points next to the border of a segment.
void CheckValues(const MajorantGrid& grid, const std::vector<MajorantSegment>& segments, const Ray& ray, Rng& rng) {
  for (const MajorantSegment& segment : segments) {
    const auto length = static_cast<float>(segment.tMax - segment.tMin);
    for (int i = 0; i < 20; ++i) {
      const float t = static_cast<float>(segment.tMin) + length * (0.02f + 0.96f * rng.NextFloat());
      const Point3 p = ray.origin + ray.direction * t;
      if (length < 1e-4f * (1 + std::abs(t))) continue;
      ASSERT_EQ(grid.At(p), segment.majorant)
          << "at t = " << t << " of [" << segment.tMin << ", " << segment.tMax << "]";
    }
  }
}

TEST(MajorantGrid, WalkIsTheCellsOfItsPoints) {
  Rng rng(1);
  size_t segmentCount = 0, misses = 0;
  const Bounds3 box{{-1, 0.5f, 2}, {3, 1.5f, 5}};
  const Transform placements[] = {Transform(), Transform::Translate({3, -2, 1}) * Transform::Rotate(37, {1, 2, 3}) *
                                                   Transform::Scale({2, 0.3, -5})};
  for (int i = 0; i < 4000; ++i) {
    const int n[3] = {1 + static_cast<int>(8 * rng.NextFloat()), 1 + static_cast<int>(8 * rng.NextFloat()),
                      1 + static_cast<int>(8 * rng.NextFloat())};
    const Transform& toRender = placements[i % 2];
    const Affine toMedium = Placed(toRender);
    const MajorantGrid grid(box, n[0], n[1], n[2], FewValues(n[0] * n[1] * n[2], rng), toMedium);
    // From within the box, or from around it, in any direction or towards it.
    const auto inBox = [&](float margin) {
      const Vector3 u(rng.NextFloat(), rng.NextFloat(), rng.NextFloat());
      const Point3 p = box.min + (u * (1 + 2 * margin) - Vector3(margin)) * box.Diagonal();
      return Point3(toRender.Point(Point3d(p)));
    };
    Ray ray;
    ray.origin = inBox(i % 3 == 0 ? 0.0f : 1.0f);
    ray.direction = i % 3 == 1 ? glm::normalize(inBox(0) - ray.origin) : SampleUniformSphere(rng.NextPoint2());
    const float tMin = i % 5 == 0 ? 3 * rng.NextFloat() : 0.0f;
    const float tMax = i % 4 == 0 ? tMin + 4 * rng.NextFloat() : kInfinity;
    const auto segments = SegmentsOf(grid, ray, tMin, tMax);
    double from = static_cast<double>(tMin), to = static_cast<double>(tMax);
    if (!OverlapOf(box, toMedium, ray, from, to)) {
      ASSERT_TRUE(segments.empty());
      ++misses;
      continue;
    }
    if (to - from < 1e-6 * (1 + to)) continue;
    ASSERT_FALSE(segments.empty());
    CheckOrder(segments, tMin, tMax);
    ASSERT_NEAR(static_cast<double>(segments.front().tMin), from, 1e-6 * (1 + from));
    ASSERT_NEAR(static_cast<double>(segments.back().tMax), to, 1e-6 * (1 + to));
    CheckValues(grid, segments, ray, rng);
    segmentCount += segments.size();
  }
  EXPECT_GT(segmentCount, 8000u);
  EXPECT_GT(misses, 300u);
}

MajorantGrid CountedGrid() {
  std::vector<float> values;
  for (int i = 0; i < 64; ++i) values.push_back(static_cast<float>(i + 1));
  return {{{0, 0, 0}, {4, 4, 4}}, 4, 4, 4, values, Affine{}};
}

TEST(MajorantGrid, WalksAlongAxesAndBorders) {
  const MajorantGrid grid = CountedGrid();
  for (int axis = 0; axis < 3; ++axis) {
    for (const float sign : {1.0f, -1.0f}) {
      // On a border between cells, on a face of the grid, on an edge of it, within a cell.
      for (const float across : {0.0f, 0.5f, 1.0f, 4.0f}) {
        Ray ray;
        ray.origin = Point3(across);
        ray.origin[axis] = sign > 0 ? -1.0f : 5.0f;
        ray.direction = Vector3(0.0f);
        ray.direction[axis] = sign;
        const auto segments = SegmentsOf(grid, ray, 0, kInfinity);
        ASSERT_EQ(segments.size(), 4u) << axis << ", " << across;
        CheckOrder(segments, 1, 5);
        EXPECT_EQ(segments.front().tMin, 1);
        EXPECT_EQ(segments.back().tMax, 5);
        const float stride = axis == 0 ? 1.0f : axis == 1 ? 4.0f : 16.0f;
        for (size_t i = 1; i < 4; ++i) EXPECT_EQ(segments[i].majorant - segments[i - 1].majorant, sign * stride);
      }
      Ray beside;
      beside.origin = Point3(4.000001f);
      beside.direction = Vector3(0.0f);
      beside.direction[axis] = sign;
      EXPECT_TRUE(SegmentsOf(grid, beside, 0, kInfinity).empty());
    }
  }
}

TEST(MajorantGrid, WalksThroughCornersOfCells) {
  const MajorantGrid grid = CountedGrid();
  const float third = 1 / std::sqrt(3.0f);
  const Ray diagonal{{-1, -1, -1}, {third, third, third}};
  const auto segments = SegmentsOf(grid, diagonal, 0, kInfinity);
  ASSERT_GE(segments.size(), 4u);
  CheckOrder(segments, 0, kInfinity);
  EXPECT_NEAR(segments.front().tMin, 1 / third, 1e-6f);
  EXPECT_NEAR(segments.back().tMax, 5 / third, 2e-6f);
  // From a corner of cells, in both directions: the cells that the ray goes into.
  EXPECT_EQ(SegmentsOf(grid, {{2, 2, 2}, {third, third, third}}, 0, 0.1f).front().majorant, 2 + 2 * 4 + 2 * 16 + 1);
  EXPECT_EQ(SegmentsOf(grid, {{2, 2, 2}, {-third, -third, -third}}, 0, 0.1f).front().majorant, 1 + 4 + 16 + 1);
}

TEST(MajorantGrid, WalksOddRanges) {
  const MajorantGrid grid = CountedGrid();
  const Ray ray{{0.5f, 0.5f, 0.5f}, {1, 0, 0}};
  EXPECT_TRUE(SegmentsOf(grid, ray, 0, 0).empty());
  EXPECT_TRUE(SegmentsOf(grid, ray, 1, 1).empty());
  EXPECT_TRUE(SegmentsOf(grid, ray, 2, 1).empty());
  EXPECT_TRUE(SegmentsOf(grid, ray, 3.5f, kInfinity).empty());
  EXPECT_TRUE(SegmentsOf(grid, ray, 1e30f, 1e38f).empty());
  EXPECT_TRUE(SegmentsOf(grid, {{-1, 2, 2}, {-1, 0, 0}}, 0, kInfinity).empty());
  // The range is a float's last step.
  const auto last = SegmentsOf(grid, ray, 1, std::nextafter(1.0f, 2.0f));
  ASSERT_EQ(last.size(), 1u);
  EXPECT_EQ(last[0].majorant, 2);
  // A direction so flat that the other sides are never met.
  for (const float flat : {1e-30f, 1e-45f, -1e-45f}) {
    const auto segments = SegmentsOf(grid, {{0.5f, 2, 0.5f}, {1, flat, 0}}, 0, kInfinity);
    ASSERT_EQ(segments.size(), 4u);
    EXPECT_EQ(segments.back().tMax, 3.5f);
    EXPECT_EQ(segments.front().majorant, flat > 0 ? 1 + 2 * 4 : 1 + 1 * 4);
  }
  // From afar: as near as t can say.
  const auto far = SegmentsOf(grid, {{-1e6f, 2.5f, 2.5f}, {1, 0, 0}}, 0, kInfinity);
  ASSERT_FALSE(far.empty());
  CheckOrder(far, 1e6f, 1e6f + 4);
  int visits = 0;
  grid.Walk(InDouble(ray, 0, kInfinity), [&](const MajorantSegment&) { return ++visits < 2; });
  EXPECT_EQ(visits, 2);
}

TEST(MajorantGrid, EqualNeighboursAreOnePart) {
  const MajorantGrid grid({{0, 0, 0}, {4, 1, 1}}, 4, 1, 1, {2, 2, 0, 0}, Affine{});
  const auto segments = SegmentsOf(grid, {{-1, 0.5f, 0.5f}, {1, 0, 0}}, 0, kInfinity);
  ASSERT_EQ(segments.size(), 2u);
  EXPECT_EQ(segments[0].tMax, 3);
  EXPECT_EQ(segments[0].majorant, 2);
  EXPECT_EQ(segments[1].tMax, 5);
  EXPECT_EQ(segments[1].majorant, 0);
}

}  // namespace
}  // namespace lampyr::testing
