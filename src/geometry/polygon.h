// Polygons of more than four corners as triangles.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "math/vec.h"

namespace lampyr {

using TriangleCorners = std::array<uint32_t, 3>;

// True if the triangles (corner 0, k − 1, k) are the polygon: none of them opposes its normal by more than the rounding
// of positions. The normal is that of the vector area, which is the mean one if the corners are not in a plane.
bool IsFan(const std::vector<Point3>& positions, std::span<const uint32_t> corners);

// Triangulates a simple polygon that may have notches, by cutting ears [Meisters75]: corners − 2 triangles, in the
// polygon's orientation. Of one that crosses itself some triangles may oppose the rest. Time: corners² and more.
std::vector<TriangleCorners> CutEars(const std::vector<Point3>& positions, std::span<const uint32_t> corners);

}  // namespace lampyr
