#include "render/settings/integrator_choice.h"

#include <algorithm>
#include <cstdlib>

#include "base/error.h"
#include "integrators/bidirectional/bidirectional_integrator.h"
#include "integrators/light/light_integrator.h"
#include "integrators/path/path_integrator.h"
#include "integrators/photon/sppm_integrator.h"
#include "integrators/walk/footprint.h"

namespace lampyr {

namespace {

// The radius of merging in the first pass, where the user names none: a blur no wider than that of most pixel
// filters.
constexpr double kRadiusInPixels = 1;

// A radius that the scene can have: two of its own find everything, and what is less than its rounding finds nothing.
PhotonSettings PhotonsFor(const RenderScene& scene, const RenderSettings& settings) {
  PhotonSettings photons = settings.photons;
  const auto size = static_cast<double>(scene.lighting->SceneSphere().radius);
  if (photons.radius > 0 && size > 0) photons.radius = std::clamp(photons.radius, 1e-7 * size, 2 * size);
  return photons;
}

// The threshold is in the image's units; integrators know radiance.
ShadowRays ShadowRaysFor(const RenderSettings& settings) {
  ShadowRays shadowRays = settings.shadowRays;
  if (settings.imagingRatio > 0) shadowRays.threshold /= settings.imagingRatio;
  return shadowRays;
}

}  // namespace

bool HasSmoothMaterial(const RenderScene& scene) {
  return std::any_of(scene.materials.begin(), scene.materials.end(),
                     [](const auto& material) { return material && material->IsSmooth(); });
}

// Where nothing is smooth, connections find all light: photons are little of it, whatever they are aimed at.
bool MayGuidePhotons(const RenderScene& scene, const RenderSettings& settings, const std::string& integrator) {
  return integrator == "sppm" || (integrator == "vcm" && (!settings.connects || HasSmoothMaterial(scene)));
}

double FirstRadius(const RenderScene& scene, const RenderSettings& settings) {
  const double radius = PhotonsFor(scene, settings).radius;
  return radius > 0 ? radius : kRadiusInPixels * TypicalFootprint(scene, settings.width, settings.height);
}

bool GathersPhotons(const std::string& integrator) {
  return integrator == "sppm" || integrator == "vcm";
}

bool GathersPhotons(const RenderSettings& settings) {
  return settings.integrator == "sppm" || (settings.integrator == "vcm" && settings.merges);
}

const std::vector<std::string>& IntegratorNames() {
  static const std::vector<std::string> names = {"path", "light", "bdpt", "sppm", "vcm"};
  return names;
}

RenderSettings VariantOf(const RenderSettings& settings, const std::string& name) {
  RenderSettings variant = settings;
  const size_t colon = name.find(':');
  variant.integrator = name.substr(0, colon);
  if (std::find(IntegratorNames().begin(), IntegratorNames().end(), variant.integrator) == IntegratorNames().end()) {
    std::string all;
    for (const std::string& known : IntegratorNames()) all += (all.empty() ? "" : ", ") + known;
    throw UsageError("--integrators: there is no integrator \"" + variant.integrator + "\"" +
                     DidYouMean(variant.integrator, IntegratorNames()) + "; there are: " + all);
  }
  if (colon == std::string::npos) return variant;
  const std::string setting = name.substr(colon + 1);
  const size_t equals = setting.find('=');
  const std::string key = setting.substr(0, equals);
  const std::vector<std::string> keys = {"shadow-roulette", "shadow-threshold"};
  float* value = key == keys[0]   ? &variant.shadowRays.roulette
                 : key == keys[1] ? &variant.shadowRays.threshold
                                  : nullptr;
  if (!value) {
    throw UsageError("--integrators: \"" + name + "\": there is no setting \"" + key + "\"" + DidYouMean(key, keys) +
                     "; there are: shadow-roulette, shadow-threshold");
  }
  const std::string number = equals == std::string::npos ? "" : setting.substr(equals + 1);
  char* end = nullptr;
  *value = std::strtof(number.c_str(), &end);
  if (number.empty() || *end != '\0' || !(*value >= 0 && *value < kInfinity))
    throw UsageError("--integrators: \"" + name + "\": " + key + " is a number of 0 or more, such as " + key + "=0.01");
  return variant;
}

std::unique_ptr<Integrator> MakeIntegrator(const RenderScene& scene, const RenderSettings& settings) {
  if (settings.integrator == "path") return MakePathIntegrator({settings.maxDepth, ShadowRaysFor(settings)});
  if (settings.integrator == "light") return MakeLightIntegrator({settings.maxDepth});
  if (settings.integrator == "bdpt" || settings.integrator == "vcm") {
    BidirectionalSettings bdpt;
    bdpt.merges = settings.integrator == "vcm" && settings.merges;
    bdpt.connects = settings.integrator == "bdpt" || settings.connects;
    bdpt.photons = PhotonsFor(scene, settings);
    if (bdpt.merges) bdpt.photons.radius = FirstRadius(scene, settings);
    bdpt.photons.guided = bdpt.photons.guided && MayGuidePhotons(scene, settings, "vcm");
    bdpt.maxDepth = settings.maxDepth;
    bdpt.shadowRays = ShadowRaysFor(settings);
    bdpt.filmPixels = static_cast<double>(settings.width) * static_cast<double>(settings.height);
    return MakeBidirectionalIntegrator(bdpt);
  }
  if (settings.integrator == "sppm") {
    SppmSettings sppm;
    sppm.maxDepth = settings.maxDepth;
    sppm.shadowRays = ShadowRaysFor(settings);
    sppm.filmPixels = static_cast<double>(settings.width) * static_cast<double>(settings.height);
    sppm.photons = PhotonsFor(scene, settings);
    sppm.directFromPhotons = settings.directFromPhotons;
    return MakeSppmIntegrator(sppm);
  }
  throw Error("there is no integrator \"" + settings.integrator + "\"");
}

}  // namespace lampyr
