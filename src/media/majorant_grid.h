// Upper bounds of a medium's extinction in the cells of a coarse grid, and the walk of a ray through them.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/ray.h"
#include "math/bounds.h"
#include "math/transform.h"

namespace lampyr {

// A part of a ray with one majorant. Parameters t are those of the ray.
struct MajorantSegment {
  float tMin = 0, tMax = 0;
  float majorant = 0;  // 1/scene unit; 0: the medium is empty there
};

class MajorantGrid {
 public:
  // `bounds`: in the medium's space. `majorants`: x fastest, nx · ny · nz.
  MajorantGrid(const Bounds3& bounds, int nx, int ny, int nz, std::vector<float> majorants, const Affine& toMedium);

  // Calls visit(const MajorantSegment&) for the parts of the ray within [tMin, tMax] that lie in the grid, in order and
  // without gaps; neighbouring cells with the same majorant may be one part. Ends when visit returns false.
  template <class Visit>
  void Walk(const Ray& ray, float tMin, float tMax, const Visit& visit) const;

  const std::vector<float>& Values() const { return majorants_; }

 private:
  Bounds3 bounds_;
  int resolution_[3];
  std::vector<float> majorants_;
  Affine toMedium_;  // render space to the medium's
};

}  // namespace lampyr
