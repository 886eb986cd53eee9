// The integrator that settings name.
#pragma once

#include <memory>
#include <string>

#include "render/settings/render_settings.h"

namespace lampyr {

// For `scene`.
std::unique_ptr<Integrator> MakeIntegrator(const RenderScene& scene, const RenderSettings& settings);

// The settings with the integrator of a name such as "path", or "path:shadow-threshold=0.01:light-samples=4": some of
// its settings are then changed. Throws a UsageError that says what there is.
RenderSettings VariantOf(const RenderSettings& settings, const std::string& name);

bool GathersPhotons(const RenderSettings& settings);

}  // namespace lampyr
