// Selection where some lights do not shine on some receivers: one selector for each set of lights that shine together,
// so that no sample is spent on a light that is not linked.
#pragma once

#include <memory>
#include <span>

#include "lights/selection/light_selector.h"

namespace lampyr {

// `sets` as many as there are lights for: those that take more than four times the emitters of the scene, and a
// million, fall back on all lights, where a light that is not linked is chosen in vain.
std::unique_ptr<LightSelector> MakeLinkedSelector(LightSelection selection, std::span<const PlacedLight> lights,
                                                  const BoundingSphere& scene, const LightSets& sets);

}  // namespace lampyr
