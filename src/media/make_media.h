// The media of a scene, as its file describes them.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/memory.h"
#include "media/medium.h"
#include "scene/scene_description.h"

namespace lampyr {

// One medium for each of `description.media`, in their order. Grids are counted against `memory` before they are
// allocated. Throws located Errors for unknown types and parameters, values out of range, and files that are absent or
// damaged.
std::vector<std::shared_ptr<const Medium>> MakeMedia(const SceneDescription& description,
                                                     const Transform& renderFromWorld, MemoryBudget& memory,
                                                     Diagnostics& diagnostics);

// "homogeneous", "uniformgrid", …
std::vector<std::string> MediumTypeNames();

}  // namespace lampyr
