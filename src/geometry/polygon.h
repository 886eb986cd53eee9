// Polygons of more than four corners as triangles.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "math/vec.h"

namespace lampyr {

using TriangleCorners = std::array<uint32_t, 3>;

// True if the triangles (corner 0, k − 1, k) form the polygon: none of them is turned against its normal by more than
// the rounding of positions. The normal is that of the vector area, a mean normal if the corners are not in a plane.
bool IsFan(const std::vector<Point3>& positions, std::span<const uint32_t> corners);

// Triangulates a simple polygon, which may be concave, by ear clipping [Meisters75]: corners − 2 triangles, in the
// polygon's orientation. For a polygon that crosses itself, some triangles may have the opposite orientation. Time: at
// least quadratic in the number of corners.
std::vector<TriangleCorners> CutEars(const std::vector<Point3>& positions, std::span<const uint32_t> corners);

}  // namespace lampyr
