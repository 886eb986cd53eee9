// Areas under linear maps: of any surface from the distribution of its normals, fast enough to be evaluated for every
// sample of a surface whose motion changes its area; of ellipsoids and of cylinders with an elliptic section in closed
// form, by Carlson's symmetric elliptic integrals ([Carlson95]), exact to rounding.
#pragma once

#include <glm/mat3x3.hpp>
#include <vector>

#include "math/vec.h"

namespace lampyr {

// A part of the surface of area dA and normal n has the area |cof(M) n| dA under M. Parts with similar normals share a
// cell, which keeps their second moments: exact for a few flat faces, within 1e-3 for round surfaces and maps that
// stretch one way three times as much as another.
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

// R_G(x, y, z): the mean over all directions n of sqrt(x n.x² + y n.y² + z n.z²). Not negative, at most one of them 0.
double CarlsonRG(double x, double y, double z);

// Mean over the unit sphere of |m n|.
double MeanStretchOverSphere(const glm::dmat3& m);
// Mean over the unit circle of |m (cosφ, sinφ, 0)|.
double MeanStretchOverCircle(const glm::dmat3& m);

}  // namespace lampyr
