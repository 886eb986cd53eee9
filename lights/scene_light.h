// A light of a scene, with the data that are needed to check it.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "geometry/shapes.h"
#include "lights/light.h"
#include "scene/parameters.h"

namespace lampyr {

// The data besides the light itself.
struct SceneLight {
  std::string name;            // its own, or its type, and where it was written
  std::optional<Shape> shape;  // that it is on, in the space that its placement leads from
  // The light without its cut-outs, which let rays pass and are not traced by the suite: this one is checked instead.
  // Null: the light is checked as it is.
  std::shared_ptr<const Light> withoutCutOuts;
  ParameterList parameters;
};

}  // namespace lampyr
