#include "lights/services/light_fronts.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <type_traits>

namespace lampyr {

namespace {

bool HasSamePlace(const PlacedLight& a, const PlacedLight& b) {
  static_assert(std::is_trivially_copyable_v<LightTransform>);
  return std::memcmp(&a.transform, &b.transform, sizeof a.transform) == 0;
}

bool DiffersInNothingButTheLight(const LightFront& a, const LightFront& b) {
  return a.place == b.place && a.kind == b.kind && a.canBeHit == b.canBeHit && a.isInstance == b.isInstance &&
         a.moves == b.moves;
}

}  // namespace

LightFronts::LightFronts(std::span<const PlacedLight> lights) : each_(lights.size()) {
  for (uint32_t i = 0; i < lights.size(); ++i) {
    const PlacedLight& placed = lights[i];
    LightFront& front = each_[i];
    front.light = placed.light.get();
    front.place = i > 0 && HasSamePlace(placed, lights[i - 1]) ? each_[i - 1].place : i;
    front.kind = placed.light->Kind();
    front.canBeHit = placed.canBeHit;
    front.isInstance = placed.isInstance;
    front.moves = placed.motion != nullptr;
  }
  for (uint32_t first = 0; first < Size(); first += kRun) runs_.push_back(RunOf(first, std::min(kRun, Size() - first)));
}

LightFronts::Run LightFronts::RunOf(uint32_t first, uint32_t count) const {
  Run run{each_[first], 1};
  if (count == 1) return run;
  const int64_t stride =
      reinterpret_cast<intptr_t>(each_[first + 1].light) - reinterpret_cast<intptr_t>(run.first.light);
  bool isEven = stride == static_cast<int32_t>(stride);
  for (uint32_t i = 1; i < count; ++i) {
    const LightFront& front = each_[first + i];
    isEven &= DiffersInNothingButTheLight(front, run.first) && front.light == Moved(run.first.light, i * stride);
  }
  run.stride = isEven ? static_cast<int32_t>(stride) : 0;
  return run;
}

}  // namespace lampyr
