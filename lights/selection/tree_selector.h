// Selection by what lights send to the receiver: emitters with a place by the light tree, those at infinity beside it.
#pragma once

#include "lights/selection/light_selector.h"

namespace lampyr {

// How emitters with a place are chosen among: by the tree, or by the importance of each of them, O(n): the limit that a
// tree comes near to.
enum class EmitterSearch { Tree, Exhaustive };

std::unique_ptr<LightSelector> MakeTreeSelector(EmitterSearch search, std::span<const PlacedLight> lights,
                                                const BoundingSphere& scene, int threads);

}  // namespace lampyr
