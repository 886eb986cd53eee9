// The integrators by name.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "integrators/walk/integrator.h"
#include "render/settings/render_settings.h"

namespace lampyr {

// The one that the settings name, for `scene`.
std::unique_ptr<Integrator> MakeIntegrator(const RenderScene& scene, const RenderSettings& settings);

// The settings with the integrator of a name such as "path", or "path:shadow-threshold=0.01": one of its settings is
// then changed. Throws a UsageError that says what there is.
RenderSettings VariantOf(const RenderSettings& settings, const std::string& name);

// The radius (scene units) within which the first pass of vcm gathers photons.
double FirstRadius(const RenderScene& scene, const RenderSettings& settings);

// Of a name: whether it finds light by photons, and blurs it, unless its settings say otherwise.
bool GathersPhotons(const std::string& integrator);
// With these settings: vcm that does not merge gathers none.
bool GathersPhotons(const RenderSettings& settings);

// Whether any material has a mirror or clear glass in it.
bool HasSmoothMaterial(const RenderScene& scene);

// Whether the integrator of that name learns where photons are of use, if the settings let it.
bool MayGuidePhotons(const RenderScene& scene, const RenderSettings& settings, const std::string& integrator);

// Names for --integrator and for Integrator in a scene.
const std::vector<std::string>& IntegratorNames();

}  // namespace lampyr
