// The fields of lights that are read first for any operation, in 16 bytes per light because access is random: the
// object, the index of its transform, its kind and flags.
#pragma once

#include <cstdint>
#include <span>

#include "base/large_array.h"
#include "lights/placed_light.h"

namespace lampyr {

struct LightFront {
  const Light* light;
  uint32_t place;  // index of the light whose PlacedLight holds its transform; lights with equal transforms share one
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
