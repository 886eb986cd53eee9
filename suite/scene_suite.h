// The pdf suite on the lights of a scene, as they are placed there, and the properties of selecting among them:
//
//   selection    at every receiver the probabilities of all lights sum to 1, and none that contributes has 0
#pragma once

#include "lights/scene_light.h"
#include "lights/services/lighting_services.h"
#include "suite/pdf_suite.h"

namespace lampyr {

// `lights` are those of the services, in their order. Moving ones are checked at shutter open, in the middle and at
// shutter close.
std::vector<SuiteResult> RunPdfSuiteOnScene(const LightingServices& services, const std::vector<SceneLight>& lights,
                                            const SuiteOptions& options);

// True if parameters name images or profiles, or shape the emission: the power has no closed form then.
bool IsUneven(const ParameterList& parameters);

}  // namespace lampyr
