// The integrators, and what may be set of them: what the renderer and the commands ask.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "integrators/walk/integrator_type.h"

namespace lampyr {

const std::vector<IntegratorType>& IntegratorRegistry();
std::vector<std::string> IntegratorNames();
// The type of that name, or null.
const IntegratorType* FindIntegrator(const std::string& name);
// The same; throws an Error where there is none.
const IntegratorType& IntegratorOf(const std::string& name);

// The settings of all integrators, each once, at their fallbacks.
Settings IntegratorSettings();

// Whether the integrator of that name finds light by photons with these settings.
bool GathersPhotons(const std::string& integrator, const Settings& settings);

// IntegratorType::hints.
std::vector<std::string> IntegratorHints(const RenderScene& scene, const std::string& integrator);

}  // namespace lampyr
