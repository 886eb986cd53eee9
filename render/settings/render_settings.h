// How a scene is to be rendered: what its file says, with what the command line says laid over it.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "camera/camera.h"
#include "film/film.h"
#include "film/pixel_filter.h"
#include "integrators/registry.h"
#include "lights/selection/light_selector.h"
#include "sampling/sampler.h"
#include "scene/scene_description.h"

namespace lampyr {

// What the command line may change. Absent: as the scene file says.
struct RenderOverrides {
  std::optional<std::string> integrator;
  std::map<std::string, SettingValue> values;  // settings of integrators, by name
  std::optional<int> samplesPerPixel;
  std::optional<int> width, height;
  std::optional<std::string> crop;  // "x0,x1,y0,y1": fractions of the image, or pixels when one is above 1
  std::optional<std::string> sampler;
  std::optional<uint64_t> memory;  // bytes that the scene may take; absent: all that there is
  uint64_t seed = 0;
};

struct RenderSettings {
  std::string integrator = "path";
  Settings values = IntegratorSettings();  // of all integrators
  int width = 1280, height = 720;
  PixelRect crop;
  PixelFilterSettings filter;
  SamplerKind sampler = SamplerKind::Sobol;
  int samplesPerPixel = 16;
  uint64_t seed = 0;
  bool halfPrecision = false;
  float imagingRatio = 1;  // exposure time · ISO / 100: film value of radiance 1
  std::string outputFile;  // as the scene names it

  int MaxDepth() const { return MaxDepthOf(values); }
  bool LearnsLights() const { return values.IsOn("learn-lights"); }
  LightSelection LightSampler() const { return *ParseLightSelection(values.Word("light-sampler")); }
};

// Reads Film, PixelFilter, Sampler and Integrator. Throws located Errors; UsageError when an override is wrong.
RenderSettings ReadRenderSettings(const SceneDescription& description, const RenderOverrides& overrides,
                                  Diagnostics& diagnostics);

// Reads Camera. `worldToRender` moves the world to where it is rendered.
std::unique_ptr<Camera> BuildCamera(const SceneDescription& description, const RenderSettings& settings,
                                    const Transform& worldToRender, Diagnostics& diagnostics);

}  // namespace lampyr
