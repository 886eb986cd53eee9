// Instances of objects, without the nesting of objects within objects.
#pragma once

#include <memory>
#include <vector>

#include "base/memory.h"
#include "math/motion.h"
#include "scene/scene_description.h"

namespace lampyr {

// An instance of an object with all nesting resolved. World space.
struct FlatInstance {
  size_t object = 0;
  Transform toWorld;                          // at the start of its motion
  std::shared_ptr<const MotionChain> motion;  // null: stays
  const InstanceDescription* description = nullptr;
};

// The instances of all objects that have shapes (`hasShapes`, by the index of the object). Throws an Error where they
// take more than is left of `memory`.
std::vector<FlatInstance> FlattenInstances(const SceneDescription& description, const std::vector<bool>& hasShapes,
                                           MemoryBudget& memory);

}  // namespace lampyr
