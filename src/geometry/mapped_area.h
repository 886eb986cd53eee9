// The area of a surface under linear maps, from the distribution of its normals. Fast enough to be evaluated for every
// sample of a surface whose motion changes its area.
#pragma once

#include <vector>

#include <glm/mat3x3.hpp>

#include "math/vec.h"

namespace lampyr {

// A part of the surface of area dA and normal n has the area |cof(M) n| dA under M. Parts with similar normals share a
// cell, which keeps their second moments: exact for a few flat faces, within 1e-3 for round surfaces and maps that stretch
// one way three times as much as another.
class MappedArea {
 public:
  // A part: its area and unit normal (of either side), in the surface's own space.
  void Add(double area, const Vector3d& normal);
  // Call after the last part: drops empty cells.
  void Finish();

  double Under(const glm::dmat3& linear) const;

 private:
  struct Cell {
    float area = 0;
    float squares[3] = {}, products[3] = {};  // ∫ n.x², …, and of n.y n.z, n.z n.x, n.x n.y
  };
  std::vector<Cell> cells_;
};

}  // namespace lampyr
