#include "lights/services/light_fronts.h"

#include <cstring>
#include <type_traits>

namespace lampyr {

namespace {

bool HasSamePlace(const PlacedLight& a, const PlacedLight& b) {
  static_assert(std::is_trivially_copyable_v<LightTransform>);
  return std::memcmp(&a.transform, &b.transform, sizeof a.transform) == 0;
}

}  // namespace

LightFronts::LightFronts(std::span<const PlacedLight> lights) : fronts_(lights.size()) {
  for (uint32_t i = 0; i < lights.size(); ++i) {
    const PlacedLight& placed = lights[i];
    LightFront& front = fronts_[i];
    front.light = placed.light.get();
    front.place = i > 0 && HasSamePlace(placed, lights[i - 1]) ? fronts_[i - 1].place : i;
    front.kind = placed.light->Kind();
    front.canBeHit = placed.canBeHit;
    front.isInstance = placed.isInstance;
    front.moves = placed.motion != nullptr;
  }
}

}  // namespace lampyr
