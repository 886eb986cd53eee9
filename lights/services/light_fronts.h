// What every question about a light begins with, read at random places among all of them: which object it is, whose
// transform it has, what kind it is.
//
// A million lights are mostly alike, made one after the other, and so lie evenly in memory: of such runs only the first
// is kept, where the cache holds it, and a light is waited for without waiting for the table first.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/large_array.h"
#include "lights/light.h"
#include "lights/selection/light_selector.h"

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

  LightFront operator[](uint32_t light) const {
    const Run& run = runs_[light / kRun];
    if (run.stride == 0) [[unlikely]]
      return each_[light];
    LightFront front = run.first;
    front.light = Moved(front.light, static_cast<int64_t>(light % kRun) * run.stride);
    return front;
  }
  uint32_t Size() const { return static_cast<uint32_t>(each_.Size()); }

 private:
  static constexpr uint32_t kRun = 64;
  struct Run {
    LightFront first;
    int32_t stride;  // from each light to the next, bytes; 0: they are not alike, or not evenly in memory
  };
  static const Light* Moved(const Light* light, int64_t bytes) {
    return reinterpret_cast<const Light*>(reinterpret_cast<intptr_t>(light) + bytes);
  }
  Run RunOf(uint32_t first, uint32_t count) const;

  LargeArray<LightFront> each_;
  std::vector<Run> runs_;
};

}  // namespace lampyr
