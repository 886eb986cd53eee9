// Cells of unit normals, for tables by normal: an octahedral map to 32 × 32 squares, without transcendental functions.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "math/vec.h"

namespace lampyr::normal_cells {

inline constexpr int kSide = 32;
inline constexpr uint32_t kCount = uint32_t{kSide} * kSide;
// More than the sine of the angle from any normal of a cell to the nearest of NormalsOf.
inline constexpr float kReach = 0.13f;

inline uint32_t CellOf(const Normal3& normal) {
  const float scale = 1 / (std::abs(normal.x) + std::abs(normal.y) + std::abs(normal.z));
  Point2 p = Point2(normal.x, normal.y) * scale;
  if (normal.z < 0) p = {std::copysign(1 - std::abs(p.y), p.x), std::copysign(1 - std::abs(p.x), p.y)};
  const auto cell = [](float x) { return std::clamp(static_cast<int>((x + 1) * (0.5f * kSide)), 0, kSide - 1); };
  return static_cast<uint32_t>(cell(p.y) * kSide + cell(p.x));
}

// The inverse map, for a point of [0,kSide]².
inline Normal3 NormalAt(const Point2& at) {
  const Point2 p = at * (2.0f / kSide) - Point2(1.0f);
  Normal3 normal(p.x, p.y, 1 - std::abs(p.x) - std::abs(p.y));
  if (normal.z < 0) {
    normal.x = std::copysign(1 - std::abs(p.y), p.x);
    normal.y = std::copysign(1 - std::abs(p.x), p.y);
  }
  return glm::normalize(normal);
}

// The normals in the middle and at the corners of a cell.
inline std::array<Normal3, 5> NormalsOf(uint32_t cell) {
  const Point2 corner(static_cast<float>(cell % kSide), static_cast<float>(cell / kSide));
  return {NormalAt(corner + Point2(0.5f)), NormalAt(corner), NormalAt(corner + Point2(1, 0)),
          NormalAt(corner + Point2(0, 1)), NormalAt(corner + Point2(1))};
}

}  // namespace lampyr::normal_cells
