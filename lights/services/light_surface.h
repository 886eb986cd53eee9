// Lights that are their own surface, as the ray tracer takes them: Light::Surface() in the light's own space, placed.
#pragma once

#include <memory>

#include "geometry/custom_surface.h"
#include "lights/selection/light_selector.h"

namespace lampyr {

// Null for a light without a surface of its own.
std::shared_ptr<const CustomSurface> MakeLightSurface(const PlacedLight& placed);

}  // namespace lampyr
