// Selection with light linking: one selector for each set of lights that illuminate the same receivers, so that no
// sample is spent on a light that is not linked.
#pragma once

#include <memory>
#include <span>

#include "lights/selection/light_selector.h"

namespace lampyr {

// Memory is bounded: sets beyond four times the emitters of the scene plus a million use the selector of all lights,
// and the choice of a light that is not linked contributes nothing.
std::unique_ptr<LightSelector> MakeLinkedSelector(LightSelection selection, std::span<const PlacedLight> lights,
                                                  const BoundingSphere& scene, const LightSets& sets);

}  // namespace lampyr
