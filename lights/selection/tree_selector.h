// Selection by importance at the receiver: emitters with a position by the light tree, lights at infinity beside it.
#pragma once

#include "lights/selection/light_selector.h"

namespace lampyr {

// Search among emitters with a position: by the tree, or exhaustively by the importance of each of them, in O(n), which
// is the limit of what a tree can reach.
enum class EmitterSearch { Tree, Exhaustive };

std::unique_ptr<LightSelector> MakeTreeSelector(EmitterSearch search, std::span<const PlacedLight> lights,
                                                const BoundingSphere& scene, int threads);

}  // namespace lampyr
