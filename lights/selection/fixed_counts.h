// Selection where lights have sample counts of their own: a light whose fixedSampleCount is n is sampled n times at
// each receiver, and the other lights are selected among themselves. Selection for emission and for segments of rays
// ignores these counts.
#pragma once

#include <memory>
#include <span>

#include "lights/selection/light_selector.h"

namespace lampyr {

// The samples that each light has at a receiver: fixedSampleCount, or less where all together do not fit into
// LightChoices::kMost beside one for the other lights. 0: the light is selected among the others.
std::vector<int> FixedCounts(std::span<const PlacedLight> lights);

// `whole`: selects among all lights, for segments. `others`: among those of `lights` whose count is 0, by their indices
// there; null: there are none.
std::unique_ptr<LightSelector> MakeFixedCountSelector(std::span<const PlacedLight> lights, std::span<const int> counts,
                                                      const BoundingSphere& scene, std::unique_ptr<LightSelector> whole,
                                                      std::unique_ptr<LightSelector> others);

}  // namespace lampyr
