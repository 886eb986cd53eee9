// A light of a scene, as who checks it needs it.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "geometry/shapes.h"
#include "lights/light.h"
#include "scene/parameters.h"

namespace lampyr {

// Besides the light itself.
struct SceneLight {
  std::string name;            // its own, or its type, and where it was written
  std::optional<Shape> shape;  // that it is on, in the space that its placement leads from
  // Cut-outs let rays pass that the suite does not trace: such a light is checked as it is without them. Null: as it
  // is.
  std::shared_ptr<const Light> withoutCutOuts;
  ParameterList parameters;
};

}  // namespace lampyr
