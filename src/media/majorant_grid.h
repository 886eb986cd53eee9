// Upper bounds of a medium's extinction in the cells of a coarse grid, and the walk of a ray through them.
#pragma once

#include <array>
#include <vector>

#include "geometry/ray.h"
#include "math/bounds.h"
#include "math/transform.h"

namespace lampyr {

// A part of a ray with one majorant. Parameters t are those of the ray.
struct MajorantSegment {
  double tMin = 0, tMax = 0;
  float majorant = 0;  // 1/scene unit; 0: the medium is empty there
};

class MajorantGrid {
 public:
  // `bounds`: in the medium's space, not empty. `majorants`: x fastest, nx · ny · nz. `toMedium`: render space to the
  // medium's. Cells are closed: a bound holds on their borders too.
  MajorantGrid(const Bounds3& bounds, int nx, int ny, int nz, std::vector<float> majorants, const Affine& toMedium);

  // Calls visit(const MajorantSegment&) for the parts of the ray within [tMin, tMax] that lie in the grid, in order and
  // without gaps; neighbouring cells with the same majorant are one part. Ends when visit returns false. tMax may be
  // infinite, and the direction need not be unit length.
  template <class Visit>
  void Walk(const RayDouble& ray, const Visit& visit) const;

  // The bound at a point of render space; 0 outside of the grid.
  float At(const Point3& position) const;

  const Bounds3& Bounds() const { return bounds_; }
  const std::array<int, 3>& Resolution() const { return resolution_; }
  const std::vector<float>& Values() const { return majorants_; }

 private:
  friend class MajorantWalk;

  Bounds3 bounds_;
  std::array<int, 3> resolution_;
  std::vector<float> majorants_;
  glm::dmat3 linear_;  // render space to cells: the grid is [0, resolution]
  Vector3d translation_;
};

// The segments of MajorantGrid::Walk, one by one. The grid has to outlive it.
class MajorantWalk {
 public:
  MajorantWalk(const MajorantGrid& grid, const RayDouble& ray);

  // The next segment; false after the last.
  bool Next(MajorantSegment& segment);

 private:
  // Parameter at which the ray leaves `cell_` across a border of the axis.
  double Crossing(int axis) const;
  float Majorant() const;
  // The axis whose border is next.
  int NextAxis() const;
  // Moves to the next cell, or ends the walk; returns the parameter at which the last cell ends.
  double Step();

  const MajorantGrid* grid_;
  Point3d origin_;  // in cells
  Vector3d direction_;
  double tEnd_ = 0;
  double t_ = 0;  // end of the last segment
  bool isDone_ = true;
  std::array<int, 3> cell_{};
  std::array<double, 3> crossings_{};
};

template <class Visit>
void MajorantGrid::Walk(const RayDouble& ray, const Visit& visit) const {
  MajorantWalk walk(*this, ray);
  MajorantSegment segment;
  while (walk.Next(segment)) {
    if (!visit(segment)) return;
  }
}

}  // namespace lampyr
