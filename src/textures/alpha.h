// Opacity of a surface from a float parameter, for cut-outs.
#pragma once

#include <memory>

#include "geometry/geometry_scene.h"
#include "textures/texture.h"

namespace lampyr {

// Null if the parameter is a constant of at least 1: opaque surfaces cost nothing.
std::shared_ptr<const AlphaSource> MakeAlphaSource(const FloatParameter& parameter);

}  // namespace lampyr
