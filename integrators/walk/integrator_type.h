// What an integrator is registered with: its name, its settings, how it is made, and what may be asked of it before. A
// new one is a file that defines `IntegratorType …IntegratorType()`, and a row in integrators/registry.cpp.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "base/setting.h"
#include "integrators/walk/integrator.h"
#include "integrators/walk/shadow_roulette.h"

namespace lampyr {

// What an integrator is made from.
struct IntegratorInput {
  const RenderScene& scene;
  int width = 1, height = 1;  // of the full image, pixels
  float imagingRatio = 1;     // film value of radiance 1
  const Settings& settings;

  double FilmPixels() const { return static_cast<double>(width) * static_cast<double>(height); }
};

struct IntegratorType {
  std::string name;
  std::string help;  // one line: what it finds light by
  // Settings that it looks at. One that others have, too, is the same declaration.
  std::vector<const Setting*> settings;
  std::function<std::unique_ptr<Integrator>(const IntegratorInput&)> create;
  // Whether it finds light by photons, and blurs it, with these settings. Empty: it never does.
  std::function<bool(const Settings&)> gathersPhotons;
  // It tells PathObserver of all paths, each of one technique: --strategy-images.
  bool hasTechniques = false;
  // A line for each kind of light path that it cannot find, though the scene may have it, and which integrator can.
  // From the lights and materials alone: whether such a path exists is not looked at. Empty: it finds all.
  std::function<std::vector<std::string>(const RenderScene&)> hints;
};

// Settings that several integrators have.
namespace common_settings {

inline const Setting kMaxDepth{.name = "max-depth",
                               .help = "Scattering events of a path at most",
                               .fallback = int64_t{5},
                               .least = 0,
                               .most = std::numeric_limits<int>::max(),
                               .range = "0 or more"};
inline const Setting kLightSampler{.name = "light-sampler",
                                   .help = "How a light is chosen: uniform | power | tree | exhaustive",
                                   .fallback = std::string("tree"),
                                   .choices = {"uniform", "power", "tree", "exhaustive", "bvh"}};
inline const Setting kLightSamples{.name = "light-samples",
                                   .help = "Lights to choose at each vertex, at most; fewer where few matter",
                                   .fallback = int64_t{1},
                                   .least = 1,
                                   .most = LightChoices::kMost};
inline const Setting kLearnLights{
    .name = "learn-lights", .help = "Let the light tree learn which lights are occluded where", .fallback = false};
inline const Setting kShadowRoulette{
    .name = "shadow-roulette",
    .help =
        "Trace shadow rays by chance whose light is below this part of what their sample has gathered: the mean "
        "stays; 0: trace all",
    .fallback = 0.05,
    .least = 0,
    .most = 1};
inline const Setting kShadowThreshold{
    .name = "shadow-threshold",
    .help = "Leave out light that is below this, in the image's units, without a shadow ray: faster, and biased",
    .fallback = 0.0,
    .least = 0,
    .most = std::numeric_limits<float>::max(),
    .range = "0 or more"};

// Of integrators that do next-event estimation.
inline const std::vector<const Setting*> kOfNextEvent = {&kMaxDepth,    &kLightSampler,   &kLightSamples,
                                                         &kLearnLights, &kShadowRoulette, &kShadowThreshold};

}  // namespace common_settings

// As the settings say; the threshold is in the image's units, and integrators know radiance.
ShadowRays ShadowRaysOf(const IntegratorInput& input);
int MaxDepthOf(const Settings& settings);

// Whether any material has a mirror or clear glass in it.
bool HasSmoothMaterial(const RenderScene& scene);
// "2 of 5": how many of the lights have no extent, where a smooth material may make caustics of them; "": no caustics.
std::string DeltaLightsOfCaustics(const RenderScene& scene);

}  // namespace lampyr
