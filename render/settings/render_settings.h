// Render settings: those of the scene file, overridden by the command line.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "camera/camera.h"
#include "film/film.h"
#include "film/pixel_filter.h"
#include "integrators/registry.h"
#include "lights/selection/light_selector.h"
#include "render/settings/output_layers.h"
#include "sampling/sampler.h"
#include "scene/scene_description.h"

namespace lampyr {

// Adaptive sampling (adaptive_sampling.h).
struct AdaptiveSettings {
  double share = 0.95;  // of the pixels, whose largest error counts, in (0, 1]
};

// Overrides of the command line. Absent: the scene file's value.
struct RenderOverrides {
  std::optional<std::string> integrator;
  std::map<std::string, SettingValue> values;  // settings of integrators, by name
  std::optional<int> samplesPerPixel;
  std::optional<int> width, height;
  std::optional<std::string> crop;  // "x0,x1,y0,y1": fractions of the image, or pixels when one is above 1
  std::optional<std::string> sampler;
  std::vector<std::string> layers;  // names of pixel layers, or as ParseLayer reads them, besides those of the scene
  bool seesThroughSmooth = false;   // RenderSettings
  std::optional<AdaptiveSettings> adaptive;
  std::optional<uint64_t> memory;    // limit on the scene's memory, bytes; absent: all available memory
  std::optional<bool> spectral;      // absent: where the scene asks for it, or something disperses light
  std::optional<int> spectralBands;  // absent: those that the scene asks for
  uint64_t seed = 0;
  int threads = 0;  // of what is done before rendering; 0: all
};

// The space of the layers of Film "gbuffer".
enum class FirstHitSpace { Camera, World };

struct RenderSettings {
  std::string integrator = "path";
  FileLocation integratorWhere;                   // of its statement; without a file if the command line names it
  std::shared_ptr<const TechniqueCounts> counts;  // of the integrator, if "auto" has chosen it
  std::string namedIntegrator;             // named by the scene, as lampyr calls it; "" if it names none or "auto"
  Settings values = IntegratorSettings();  // of all integrators
  int width = 1280, height = 720;
  PixelRect crop;
  PixelFilterSettings filter;
  SamplerKind sampler = SamplerKind::Sobol;
  int samplesPerPixel = 16;
  uint64_t seed = 0;
  bool halfPrecision = false;
  SensorResponse sensor;                  // exposure, white balance, limit on samples
  std::string outputFile;                 // named by the scene
  std::optional<FirstHitSpace> firstHit;  // absent: no such layers
  std::vector<LayerRequest> layers;       // besides those of light groups
  std::vector<const PixelLayer*> pixelLayers;
  std::optional<FileLocation> strategies;    // where StrategyLayers were asked for; empty: on the command line
  bool seesThroughSmooth = false;            // what is seen first is what mirrors and glass show
  std::optional<bool> spectral;              // light is carried by wavelength; absent: where something disperses it
  std::optional<SpectralBands> bands;        // of the spectrum, kept besides the picture; absent: none
  std::optional<AdaptiveSettings> adaptive;  // absent: all pixels have the same number of samples

  bool Wants(const char* pixelLayer) const;
  bool WantsFirstHit() const;  // any layer of what is seen first

  int MaxDepth() const { return MaxDepthOf(values); }
  bool LearnsLights() const { return values.IsOn("learn-lights"); }
  bool AlwaysLearnsLights() const { return values.IsOn("learn-always"); }
  // The most lights that are chosen at a vertex: what the settings say, or what "auto" has decided.
  int LightSamples() const {
    const auto set = static_cast<int>(values.Integer("light-samples"));
    return set > 0 ? set : counts ? counts->lightSamples : 1;
  }
  // True if samples may have several camera rays where the camera sees edges of lights. Not if samples are limited or
  // have negative weights: those cannot be divided.
  bool SamplesLightEdges() const;
  bool GuidesPaths() const { return values.IsOn("guide-paths"); }
  bool AlwaysGuidesPaths() const { return values.IsOn("guide-always"); }
  LightSelection LightSampler() const { return *ParseLightSelection(values.Word("light-sampler")); }
};

// True for the endings of files of pictures (".png"), which are not part of a picture's name as that of "frame.0001"
// is.
bool IsPictureEnding(const std::string& ending);

// Reads Film, PixelFilter, Sampler and Integrator. Throws located Errors; UsageError when an override is wrong.
RenderSettings ReadRenderSettings(const SceneDescription& description, const RenderOverrides& overrides,
                                  Diagnostics& diagnostics);

// Reads Camera. `worldToRender`: from world space to render space.
std::unique_ptr<Camera> BuildCamera(const SceneDescription& description, const RenderSettings& settings,
                                    const Transform& worldToRender, Diagnostics& diagnostics);

}  // namespace lampyr
