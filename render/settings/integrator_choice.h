// Creates the integrator that the settings name; integrator variants.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "render/settings/render_settings.h"

namespace lampyr {

// Sample count of splats in the weights of bidirectional techniques: PixelFilter::SplatCount over the gain of camera
// samples by Sobol points.
double SplatCount(const RenderSettings& settings);

// The integrator of the settings, for `scene`. Throws a UsageError if it cannot render the scene.
std::unique_ptr<Integrator> MakeIntegrator(const RenderScene& scene, const RenderSettings& settings);

// The settings with another integrator, by a name such as "path", or with some of its settings changed, too:
// "path:shadow-threshold=0.01:light-samples=4". Throws a UsageError that lists the valid names.
// "auto": the settings as they are, whose integrator and counts auto has chosen. A name that ends in ":denoise" gives
// the settings of the name before that.
RenderSettings VariantOf(const RenderSettings& settings, const std::string& name);
inline constexpr const char* kAuto = "auto";
bool IsDenoised(const std::string& name);
// True for "auto", denoised or not.
bool IsAuto(const std::string& name);

// For --integrator: throws a UsageError that lists the valid names, unless it is one of them or "auto".
void CheckIntegratorName(const std::string& name);

// One line for each of the settings `given`, by name, that the integrator does not read, with those that do.
std::vector<std::string> SettingsWithoutEffect(const std::string& integrator,
                                               const std::map<std::string, SettingValue>& given);

bool GathersPhotons(const RenderSettings& settings);

// The layers of the strategies of the settings' integrator. Throws an Error where they were asked for, a UsageError
// without a place, if it has none.
StrategyLayers StrategiesOf(const RenderSettings& settings);

}  // namespace lampyr
