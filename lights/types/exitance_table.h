// Radiant exitance (W/m²) of a shaped surface of uniform radiance 1, as a function of its normal: an interpolated table
// over normals, accurate to about 1 %.
#pragma once

#include <type_traits>
#include <vector>

#include "lights/types/surface_emission.h"

namespace lampyr {

class ExitanceTable {
 public:
  // Without shaping the table has one entry.
  ExitanceTable(const SurfaceEmission& emission, const LightTransform& transform);
  Color operator()(const Normal3& normal) const { return values_.size() == 1 ? values_[0] : Interpolate(normal); }
  // Exitance for the normal computed by `getNormal()`. Without shaping `getNormal` is not called.
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
