// Path tracing with next-event estimation: at each vertex lights are sampled and one BSDF direction is followed, and
// the two ways of reaching a light are weighted by the power heuristic ([Veach97 §9], [Pharr23 §13.4]).
//
// Cannot find: delta lights through anything but diffuse or rough surfaces (no caustics of point lights).
#pragma once

#include <memory>

#include "integrators/walk/integrator.h"
#include "integrators/walk/shadow_roulette.h"

namespace lampyr {

struct PathSettings {
  int maxDepth = 5;  // scattering events; 0 shows only what the camera sees of the lights
  ShadowRays shadowRays;
};

std::unique_ptr<Integrator> MakePathIntegrator(const PathSettings& settings);

}  // namespace lampyr
