// Registration of an integrator: name, settings, factory, and properties that are known before it is created. A new
// integrator is a file that defines `IntegratorType …IntegratorType()`, and a row in integrators/registry.cpp.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "base/setting.h"
#include "integrators/walk/integrator.h"
#include "integrators/walk/shadow_roulette.h"
#include "integrators/walk/technique_counts.h"

namespace lampyr {

// Input of an integrator's factory.
struct IntegratorInput {
  const RenderScene& scene;
  int width = 1, height = 1;  // of the full image, pixels
  float imagingRatio = 1;     // film value of radiance 1
  const Settings& settings;
  const TechniqueCounts* counts = nullptr;  // of bidirectional integrators; null: all techniques once
  double splatCount = 1;                    // sample count of splats in weights (SplatCount)
  double fewer = 1;                         // pixels of the image over light paths of a pass; above 1 in a pilot

  double FilmPixels() const { return static_cast<double>(width) * static_cast<double>(height); }
};

struct IntegratorType {
  std::string name;
  std::string help;  // one line: how it finds light
  // Settings that it reads. A setting shared by several integrators is one declaration (common_settings).
  std::vector<const Setting*> settings;
  std::function<std::unique_ptr<Integrator>(const IntegratorInput&)> create;
  // True if it gathers photons, which blurs light, with these settings. Empty: never.
  std::function<bool(const Settings&)> gathersPhotons;
  // Its techniques that have counts, with these settings. Empty: none.
  std::function<CountedTechniques(const Settings&)> counted;
  // True if it reports each path with its technique to SampleContext::observer, for the layers of strategies.
  bool hasTechniques = false;
  // One line for each kind of light path that the scene may have and this integrator cannot find, with the integrator
  // that can. Judged by lights and materials alone, without testing that such a path exists. Empty: it finds all light.
  std::function<std::vector<std::string>(const RenderScene&)> hints;
  // Why it cannot render the scene at all, and which integrators can; "": it can. Empty: it always can.
  std::function<std::string(const RenderScene&)> refusal;
};

// Settings shared by several integrators.
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
                                   .help = "Most lights to choose at each vertex; fewer where few matter",
                                   .fallback = int64_t{0},
                                   .least = 1,
                                   .most = LightChoices::kMost,
                                   .fallbackText = "1, or what auto decides"};
inline const Setting kLearnLights{
    .name = "learn-lights",
    .help = "Let the light tree learn which lights are occluded where, if that reduces the noise",
    .fallback = true};
inline const Setting kLearnAlways{.name = "learn-always",
                                  .help = "Choose lights by what is learned from the start, whether it pays or not",
                                  .fallback = false};
inline const Setting kGuidePaths{
    .name = "guide-paths",
    .help = "Learn where paths find light: guide them there, if that reduces the noise, and end those that find little",
    .fallback = true};
inline const Setting kGuideAlways{.name = "guide-always",
                                  .help = "Guide paths as soon as anything is learned, whether it pays or not",
                                  .fallback = false};
inline const Setting kShadowRoulette{
    .name = "shadow-roulette",
    .help =
        "Russian roulette for shadow rays whose light is below this fraction of what their sample has gathered; "
        "unbiased; 0: off",
    .fallback = 0.05,
    .least = 0,
    .most = 1};
inline const Setting kShadowThreshold{
    .name = "shadow-threshold",
    .help = "Drop light below this value, in the image's units, without a shadow ray: faster, and biased",
    .fallback = 0.0,
    .least = 0,
    .most = std::numeric_limits<float>::max(),
    .range = "0 or more",
    .isBiased = true};

inline const Setting kLightEdges{.name = "light-edges",
                                 .help = "More camera rays where the camera sees the edges of bright lights",
                                 .fallback = true};

// Settings of integrators with next-event estimation.
inline const std::vector<const Setting*> kOfNextEvent = {&kMaxDepth,        &kLightSampler, &kLightSamples,
                                                         &kLearnLights,     &kLearnAlways,  &kShadowRoulette,
                                                         &kShadowThreshold, &kLightEdges};
// Settings of integrators whose camera paths go on after they have been scattered widely.
inline const std::vector<const Setting*> kOfGuiding = {&kGuidePaths, &kGuideAlways};

}  // namespace common_settings

// Shadow-ray settings. The threshold is converted from the image's units to radiance.
ShadowRays ShadowRaysOf(const IntegratorInput& input);
int MaxDepthOf(const Settings& settings);

// True if any material has a delta lobe that scatters: a mirror or clear glass.
bool HasSmoothMaterial(const RenderScene& scene);
// Number of delta lights among all lights, as "2 of 5", if smooth materials may form caustics of them; "" if not.
std::string DeltaLightsOfCaustics(const RenderScene& scene);
// "N of M" lights that start no paths (traceLightPaths off); empty if all do.
std::string LightsWithoutPaths(const RenderScene& scene);

}  // namespace lampyr
