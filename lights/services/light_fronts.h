// What every question about a light begins with, read at random places among all of them: which object it is, whose
// transform it has, what kind it is.
#pragma once

#include <cstdint>
#include <span>

#include "base/large_array.h"
#include "lights/placed_light.h"

namespace lampyr {

struct LightFront {
  const Light* light;
  uint32_t place;  // the light in whose PlacedLight its transform is: many have the same, and need not read their own
  LightKind kind : 8;
  bool canBeHit : 1, isInstance : 1, moves : 1;
};
static_assert(sizeof(LightFront) == 16);

class LightFronts {
 public:
  LightFronts() = default;
  // `lights` must outlive this.
  explicit LightFronts(std::span<const PlacedLight> lights);

  const LightFront& operator[](uint32_t light) const { return fronts_[light]; }
  uint32_t Size() const { return static_cast<uint32_t>(fronts_.Size()); }

 private:
  LargeArray<LightFront> fronts_;
};

}  // namespace lampyr
