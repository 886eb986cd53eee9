// Light tracing: paths start at the lights, and each of their vertices is connected to the camera ([Veach97 §10.3.1],
// the techniques with t = 1; particle tracing of [Dutré93]).
//
// Finds what path tracing cannot: caustics of point, spot and distant lights on anything that is not perfectly smooth.
// Cannot find: what the camera sees in or through something perfectly smooth (a mirror, a pane, glass), because a delta
// is never met by a connection; lights at infinity seen directly (the background), which have no point to connect; and
// lights with traceLightPaths off, which send out nothing. Such parts of the picture are black, not wrong.
// What is small or far off in the image gets few paths: they go where the light goes, not where the camera looks.
//
// Depth counts scattering events between light and camera, as for `path`. Survival of roulette enters the throughput
// only.
#pragma once

#include <memory>

#include "integrators/walk/integrator.h"

namespace lampyr {

struct LightPathSettings {
  int maxDepth = 5;  // scattering events; 0 shows only the surfaces of lights
};

std::unique_ptr<Integrator> MakeLightIntegrator(const LightPathSettings& settings);

}  // namespace lampyr
