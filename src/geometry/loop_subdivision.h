// Loop's subdivision surfaces ([Loop87]; boundary and limit rules of [Hoppe94], [Zorin00]).
#pragma once

#include <array>
#include <vector>

#include "base/error.h"
#include "math/vec.h"

namespace lampyr {

struct SubdividedMesh {
  std::vector<Point3>
      positions;  // on the limit surface (boundaries: nearly); the control vertices that faces use come first
  // Unit normals of the limit surface. As in pbrt-v4 they point *against* the winding: with counter-clockwise faces,
  // inwards.
  std::vector<Normal3> normals;
  std::vector<std::array<uint32_t, 3>> triangles;  // wound like the control faces
};

// Refines `levels` >= 0 times and moves the vertices onto the limit surface. A vertex at which separate fans of faces
// touch becomes one vertex for each; at an edge of more than two faces they are joined in pairs. Throws Error at
// `where` for indices out of range, vertices that are not finite, two neighbours of opposite winding, and too many
// levels.
SubdividedMesh Subdivide(const std::vector<Point3>& positions, const std::vector<std::array<uint32_t, 3>>& triangles,
                         int levels, const FileLocation& where = {});

}  // namespace lampyr
