// The pdf suite on the lights of a scene, as they are placed there, and the properties of choosing among them:
//
//   selection    at every receiver the probabilities of all lights sum to 1, and none that contributes has 0
#pragma once

#include "lights/services/lighting_services.h"
#include "lights/suite/pdf_suite.h"

namespace lampyr {

// What the suite needs to know of a scene's light besides the light itself.
struct SceneLight {
  std::string name;            // its own, or its type, and where it was written
  std::optional<Shape> shape;  // that it is on, in the space that its placement leads from
  // Cut-outs let rays pass that the suite does not trace: such a light is checked as it is without them. Null: as it
  // is.
  std::shared_ptr<const Light> withoutCutOuts;
  ParameterList parameters;
};

// `lights` are those of the services, in their order. Moving ones are checked at shutter open, in the middle and at
// shutter close.
std::vector<SuiteResult> RunPdfSuiteOnScene(const LightingServices& services, const std::vector<SceneLight>& lights,
                                            const SuiteOptions& options);

// Parameters that name images or profiles, or shape what is emitted: the power has no closed form.
bool IsUneven(const ParameterList& parameters);

}  // namespace lampyr
