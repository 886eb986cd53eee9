// Path tracing with next-event estimation: at each vertex one light is sampled and one BSDF direction followed, and the
// two ways of reaching a light are weighted by the power heuristic ([Veach97 §9], [Pharr23 §13.4]).
//
// Cannot find: delta lights through anything but diffuse or rough surfaces (no caustics of point lights).
#pragma once

#include <memory>

#include "integrators/common/shadow_roulette.h"
#include "integrators/integrator.h"

namespace lampyr {

struct PathSettings {
  int maxDepth = 5;  // scattering events; 0 shows only what the camera sees of the lights
  ShadowRays shadowRays;
};

// `scene` must outlive the integrator.
std::unique_ptr<CameraIntegrator> MakePathIntegrator(const RenderScene& scene, const PathSettings& settings);

}  // namespace lampyr
