// What a render may not have met yet.
#pragma once

#include "integrators/walk/integrator.h"
#include "render/settings/render_settings.h"

namespace lampyr {

// The luminance on the film of the brightest light that falls on something smooth, or nearly so: a path that finds the
// light by way of that does so by chance, and is then as bright as the light. 0 where no such thing was found: all
// other paths to lights are also sampled from the lights, and weighted down. Found by photons, and by paths from the
// camera for what is small beside the scene: some ten milliseconds.
double LargestUnseenSample(const RenderScene& scene, const RenderSettings& settings);

}  // namespace lampyr
