// W/m² of an even surface of radiance 1 as a function of its normal, where shaping makes it one: a table over normals,
// interpolated, to about 1 %.
#pragma once

#include <type_traits>
#include <vector>

#include "lights/types/surface_emission.h"

namespace lampyr {

class ExitanceTable {
 public:
  // Without shaping the table is one number.
  ExitanceTable(const SurfaceEmission& emission, const LightTransform& transform);
  Color operator()(const Normal3& normal) const { return values_.size() == 1 ? values_[0] : Interpolate(normal); }
  // The same for a normal that `getNormal()` computes, which without shaping nobody needs.
  template <class GetNormal>
  requires std::is_invocable_v<GetNormal> Color operator()(const GetNormal& getNormal) const {
    return values_.size() == 1 ? values_[0] : Interpolate(getNormal());
  }

 private:
  Color Interpolate(const Normal3& normal) const;

  static constexpr int kRings = 16, kSectors = 32;
  std::vector<Color> values_;  // (kRings + 1) × kSectors, from +z; or one
};

}  // namespace lampyr
