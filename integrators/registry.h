// Registry of the integrators and their settings, for the renderer and the commands.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "integrators/walk/integrator_type.h"

namespace lampyr {

const std::vector<IntegratorType>& IntegratorRegistry();
std::vector<std::string> IntegratorNames();
// The type of that name; null if there is none.
const IntegratorType* FindIntegrator(const std::string& name);
// The type of that name. Throws an Error if there is none.
const IntegratorType& IntegratorOf(const std::string& name);

// The settings of all integrators, each once, at their default values.
Settings IntegratorSettings();

// True if the integrator of that name gathers photons with these settings; false for an unknown name.
bool GathersPhotons(const std::string& integrator, const Settings& settings);
// IntegratorType::counted of the integrator of that name; none for an unknown name.
CountedTechniques CountedTechniquesOf(const std::string& integrator, const Settings& settings);

// IntegratorType::hints of the integrator of that name; empty for an unknown name.
std::vector<std::string> IntegratorHints(const RenderScene& scene, const std::string& integrator);
// Names of the biased settings that were changed, but that the integrator of that name does not read. Its picture does
// not have the bias that was asked for.
std::vector<std::string> UnreadBias(const std::string& integrator, const Settings& settings);
// IntegratorType::refusal of the integrator of that name; "" for an unknown name.
std::string IntegratorRefusal(const RenderScene& scene, const std::string& integrator);

}  // namespace lampyr
