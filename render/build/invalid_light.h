// Who has sent light that is no number, or an infinite one.
#pragma once

#include <optional>
#include <string>

#include "render/build/scene_builder.h"

namespace lampyr {

struct InvalidLight {
  FileLocation where;
  std::string text;  // "this LightFilter gives values that are not finite"
};

// Asks all lights, and their filters, for samples at places that the camera sees, and for photons: the first one that
// gives something not finite or negative. nullopt: none does there.
std::optional<InvalidLight> FindInvalidLight(const BuiltScene& built);

}  // namespace lampyr
