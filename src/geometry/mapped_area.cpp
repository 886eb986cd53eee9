#include "geometry/mapped_area.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace lampyr {

namespace {

// Half a cube of directions: n and -n are the same.
constexpr int kSide = 12;
constexpr int kCells = 3 * kSide * kSide;

size_t CellOf(const Vector3d& n) {
  const Vector3d size = glm::abs(n);
  const int face = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  // Equal angles, more or less.
  const auto along = [&](int axis) {
    const double turned = std::atan(n[axis] / n[face]) * (4 / 3.14159265358979323846);
    return std::clamp(static_cast<int>((turned + 1) * (0.5 * kSide)), 0, kSide - 1);
  };
  return static_cast<size_t>((face * kSide + along((face + 1) % 3)) * kSide + along((face + 2) % 3));
}

}  // namespace

void MappedArea::Add(double area, const Vector3d& normal) {
  if (!(area > 0) || !(glm::dot(normal, normal) > 0)) return;
  if (cells_.empty()) cells_.resize(kCells);
  Cell& cell = cells_[CellOf(normal)];
  cell.area += static_cast<float>(area);
  for (int i = 0; i < 3; ++i) {
    cell.squares[i] += static_cast<float>(area * normal[i] * normal[i]);
    cell.products[i] += static_cast<float>(area * normal[(i + 1) % 3] * normal[(i + 2) % 3]);
  }
}

void MappedArea::Finish() {
  std::erase_if(cells_, [](const Cell& cell) { return !(cell.area > 0); });
  cells_.shrink_to_fit();
}

double MappedArea::Under(const glm::dmat3& linear) const {
  const glm::dmat3 cofactors(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                             glm::cross(linear[0], linear[1]));
  const Vector3d squares(glm::dot(cofactors[0], cofactors[0]), glm::dot(cofactors[1], cofactors[1]),
                         glm::dot(cofactors[2], cofactors[2]));
  const Vector3d products = 2.0 * Vector3d(glm::dot(cofactors[1], cofactors[2]), glm::dot(cofactors[2], cofactors[0]),
                                           glm::dot(cofactors[0], cofactors[1]));
  double sum = 0;
  for (const Cell& cell : cells_) {
    double stretched = 0;
    for (int i = 0; i < 3; ++i) {
      stretched +=
          squares[i] * static_cast<double>(cell.squares[i]) + products[i] * static_cast<double>(cell.products[i]);
    }
    sum += std::sqrt(std::max(stretched * static_cast<double>(cell.area), 0.0));
  }
  return sum;
}

}  // namespace lampyr
