// Finds the light or light filter that gives invalid values.
#pragma once

#include <optional>
#include <string>

#include "render/build/scene_builder.h"

namespace lampyr {

struct InvalidLight {
  FileLocation where;
  std::string text;  // "this LightFilter gives values that are not finite, or negative"
};

// Samples all lights, with their filters, at points that the camera sees, and their emission. Returns the first that
// gives values that are not finite or negative; nullopt: none was found.
std::optional<InvalidLight> FindInvalidLight(const BuiltScene& built);

}  // namespace lampyr
