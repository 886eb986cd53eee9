// What an integrator cannot find in a scene, told before it is rendered.
#pragma once

#include <string>
#include <vector>

#include "integrators/walk/integrator.h"

namespace lampyr {

// A line for each kind of light path that the integrator of that name cannot find, though the scene may have it, and
// which integrator can. From the lights and materials alone: whether such a path exists is not looked at.
std::vector<std::string> IntegratorHints(const RenderScene& scene, const std::string& integrator);

}  // namespace lampyr
