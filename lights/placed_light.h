// A light in the scene: where it is, how it moves, and whether rays find it.
#pragma once

#include <memory>

#include "lights/light.h"
#include "math/motion.h"

namespace lampyr {

struct PlacedLight {
  std::shared_ptr<const Light> light;
  LightTransform transform;
  bool canBeHit = true;  // false: an area light whose surface lets every ray through; only light sampling finds it
  std::shared_ptr<const Motion> motion = nullptr;  // null: static. Otherwise `transform` is that at shutter open

  bool isInstance = false;  // its shape is traced within an instance, placed as the light is

  int32_t filter = -1;         // index of its light filter, -1: none
  float radianceModifier = 1;  // fraction that the filter transmits, as light selection assumes it

  // Placement of a moving light at `time`. Requires `motion`.
  LightTransform At(float time) const {
    const Affine toRender = motion->At(time);
    return {toRender, toRender.Inverse()};
  }
};

}  // namespace lampyr
