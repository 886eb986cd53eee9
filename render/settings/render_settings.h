// How a scene is to be rendered: what its file says, with what the command line says laid over it.
#pragma once

#include <optional>
#include <string>

#include "camera/camera.h"
#include "film/film.h"
#include "film/pixel_filter.h"
#include "integrators/walk/integrator.h"
#include "integrators/walk/shadow_roulette.h"
#include "lights/selection/light_selector.h"
#include "sampling/sampler.h"
#include "scene/scene_description.h"

namespace lampyr {

// What the command line may change. Absent: as the scene file says.
struct RenderOverrides {
  std::optional<std::string> integrator;
  std::optional<int> samplesPerPixel;
  std::optional<int> maxDepth;
  std::optional<int> width, height;
  std::optional<std::string> crop;  // "x0,x1,y0,y1": fractions of the image, or pixels when one is above 1
  std::optional<std::string> sampler;
  std::optional<std::string> lightSampler;
  std::optional<bool> learnLights;
  std::optional<int> lightSamples;
  std::optional<double> radius, alpha;  // of photons, see PhotonSettings
  std::optional<uint64_t> photons, photonMemory;
  std::optional<bool> merges, connects, directFromPhotons, guidesPhotons;
  std::optional<double> shadowRoulette, shadowThreshold;
  std::optional<uint64_t> memory;  // bytes that the scene may take; absent: all that there is
  uint64_t seed = 0;
};

struct RenderSettings {
  std::string integrator = "path";
  int maxDepth = 5;
  int width = 1280, height = 720;
  PixelRect crop;
  PixelFilterSettings filter;
  SamplerKind sampler = SamplerKind::Sobol;
  int samplesPerPixel = 16;
  uint64_t seed = 0;
  LightSelection lightSelection = LightSelection::Tree;
  int lightSamples = 1;      // lights that next-event estimation chooses at a vertex, at most
  ShadowRays shadowRays;     // its threshold in the image's units
  bool learnLights = false;  // selection learns from shadow rays (light_learning.h)
  PhotonSettings photons;
  bool merges = true, connects = true;  // vcm: which techniques
  bool directFromPhotons = false;       // sppm: light that comes straight from lights, too
  bool halfPrecision = false;
  float imagingRatio = 1;  // exposure time · ISO / 100: film value of radiance 1
  std::string outputFile;  // as the scene names it
};

// Reads Film, PixelFilter, Sampler and Integrator. Throws located Errors; UsageError when an override is wrong.
RenderSettings ReadRenderSettings(const SceneDescription& description, const RenderOverrides& overrides,
                                  Diagnostics& diagnostics);

// The parameters that Integrator may have in a scene.
const std::vector<std::string>& IntegratorParameterNames();

// Reads Camera. `worldToRender` moves the world to where it is rendered.
std::unique_ptr<Camera> BuildCamera(const SceneDescription& description, const RenderSettings& settings,
                                    const Transform& worldToRender, Diagnostics& diagnostics);

}  // namespace lampyr
