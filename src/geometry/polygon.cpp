#include "geometry/polygon.h"

#include <algorithm>
#include <cmath>

namespace lampyr {

namespace {

// Twice the vector area [Newell]: the sum of the cross products around the polygon, relative to its first corner.
Vector3d AreaOf(const std::vector<Point3>& positions, std::span<const uint32_t> corners) {
  const Vector3d origin(positions[corners[0]]);
  Vector3d sum(0.0), last(0.0);
  for (const uint32_t corner : corners.subspan(1)) {
    const Vector3d next = Vector3d(positions[corner]) - origin;
    sum += glm::cross(last, next);
    last = next;
  }
  return sum;
}

using Point2d = glm::dvec2;

// Twice the signed area.
double Area(const Point2d& a, const Point2d& b, const Point2d& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

bool IsIn(const Point2d& p, const Point2d& a, const Point2d& b, const Point2d& c) {
  if (p == a || p == b || p == c) return false;  // corners that a polygon visits twice
  return Area(a, b, p) >= 0 && Area(b, c, p) >= 0 && Area(c, a, p) >= 0;
}

// The corners in the plane across the largest component of the area, anticlockwise.
std::vector<Point2d> Projected(const std::vector<Point3>& positions, std::span<const uint32_t> corners) {
  const Vector3d area = AreaOf(positions, corners), size = glm::abs(area);
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  std::vector<Point2d> points;
  for (const uint32_t corner : corners) {
    const Vector3d p(positions[corner]);
    points.push_back(area[axis] >= 0 ? Point2d(p[u], p[v]) : Point2d(p[v], p[u]));
  }
  return points;
}

}  // namespace

bool IsFan(const std::vector<Point3>& positions, std::span<const uint32_t> corners) {
  const Vector3d area = AreaOf(positions, corners), origin(positions[corners[0]]);
  double largest = 0;
  for (const uint32_t corner : corners)
    largest = std::max(largest, static_cast<double>(MaxAbsComponent(positions[corner])));
  const double rounding = 0x1p-22 * largest * glm::length(area);  // of positions in float, per length of a side
  for (size_t k = 2; k < corners.size(); ++k) {
    const Vector3d a = Vector3d(positions[corners[k - 1]]) - origin, b = Vector3d(positions[corners[k]]) - origin;
    if (glm::dot(glm::cross(a, b), area) < -rounding * (glm::length(a) + glm::length(b))) return false;
  }
  return true;
}

std::vector<TriangleCorners> CutEars(const std::vector<Point3>& positions, std::span<const uint32_t> corners) {
  const std::vector<Point2d> points = Projected(positions, corners);
  std::vector<size_t> left(corners.size());
  for (size_t i = 0; i < left.size(); ++i) left[i] = i;
  std::vector<TriangleCorners> triangles;
  size_t at = 0, misses = 0;
  while (left.size() > 3) {
    const size_t count = left.size();
    at %= count;
    const size_t a = left[(at + count - 1) % count], b = left[at], c = left[(at + 1) % count];
    const auto isFree = [&] {
      for (const size_t other : left) {
        if (other != a && other != b && other != c && IsIn(points[other], points[a], points[b], points[c]))
          return false;
      }
      return true;
    };
    // A polygon that crosses itself may have no ear. The next corner is cut then, so that the loop ends.
    const bool isEar = misses >= count || (Area(points[a], points[b], points[c]) > 0 && isFree());
    if (!isEar) {
      ++at;
      ++misses;
      continue;
    }
    triangles.push_back({corners[a], corners[b], corners[c]});
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(at));
    misses = 0;
  }
  triangles.push_back({corners[left[0]], corners[left[1]], corners[left[2]]});
  return triangles;
}

}  // namespace lampyr
