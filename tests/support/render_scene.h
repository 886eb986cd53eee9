// Renders scene text or files within a test.
#pragma once

#include <filesystem>
#include <string>

#include "render/build/scene_builder.h"
#include "render/progressive_render.h"
#include "render/settings/integrator_choice.h"
#include "scene/scene_description.h"

namespace lampyr::test {

struct Rendered {
  Image image;
  RenderOutcome outcome;
  uint64_t rejectedRays = 0;
};

inline Rendered RenderBuilt(const BuiltScene& built, int samplesPerPixel, int threads) {
  const std::unique_ptr<Integrator> integrator = MakeIntegrator(built.scene, built.settings);
  Film film(built.settings.width, built.settings.height, built.settings.crop, built.FilmLayers());
  StopConditions stop;
  stop.samplesPerPixel = samplesPerPixel;
  Rendered rendered;
  rendered.outcome =
      Render(built.scene, *integrator, built.settings, stop, threads, film, [](const RenderOutcome&, double) {});
  rendered.image = film.Develop();
  rendered.rejectedRays = built.scene.geometry->RejectedRays();
  return rendered;
}

inline Rendered RenderDescription(const SceneDescription& description, RenderOverrides overrides, int samplesPerPixel,
                                  int threads = 1) {
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  return RenderBuilt(BuildScene(description, overrides, true, diagnostics), samplesPerPixel, threads);
}

inline Rendered RenderText(const std::string& text, int samplesPerPixel, const RenderOverrides& overrides = {},
                           int threads = 1) {
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  return RenderDescription(ParseScene(text, "test.pbrt", diagnostics), overrides, samplesPerPixel, threads);
}

inline Rendered RenderFile(const std::filesystem::path& file, int samplesPerPixel,
                           const RenderOverrides& overrides = {}, int threads = 1) {
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  return RenderDescription(ReadScene(file, diagnostics), overrides, samplesPerPixel, threads);
}

// One light chosen for the receiver, and a sample on it.
inline DirectSample SampleOneLight(const LightingServices& lighting, const Receiver& receiver, float uSelect,
                                   const Point2& u, float time, bool bidirectional) {
  LightChoices choices;
  lighting.SelectLights(receiver, uSelect, choices);
  return choices.count == 0 ? DirectSample()
                            : lighting.GenerateSamples(receiver, choices.of[0], u, time, bidirectional);
}

// Mean and standard error of the whole image's green channel, from the variance layer (an upper bound for stratified
// samples).
struct MeanValue {
  double mean = 0, standardError = 0;
};
inline MeanValue MeanOf(const Image& image, size_t channel = 1) {
  const int variance = image.ChannelIndex("variance.G");
  MeanValue result;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      result.mean += static_cast<double>(image.At(x, y, channel));
      result.standardError += static_cast<double>(image.At(x, y, static_cast<size_t>(variance)));
    }
  }
  const double pixels = static_cast<double>(image.width) * image.height;
  result.mean /= pixels;
  result.standardError = std::sqrt(result.standardError) / pixels;
  return result;
}

}  // namespace lampyr::test
