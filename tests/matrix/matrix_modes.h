// The modes of the integrators: each is a column of the matrix.
#pragma once

#include <string>
#include <vector>

#include "render/settings/integrator_choice.h"

namespace lampyr::test {

struct Mode {
  std::string name, integrator;
  bool merges = true, connects = true;  // vcm
  bool directFromPhotons = false;       // sppm
  bool guides = false;                  // photons
  bool learns = false;                  // the selection of lights
  bool isAdaptive = false;              // pixels differ in their numbers of samples
  bool guidesPaths = false;             // from the second sample on
  int lightSamples = 0;                 // most lights at a vertex; 0: the default
  TechniqueCounts counts{};             // as --integrator auto may choose them
  // Per pixel of a trial replica; at least that many in each. What is learned takes effect from pass to pass.
  int Samples() const { return isAdaptive ? 8 : Adapts() ? 6 : 4; }
  bool Adapts() const { return guides || learns || guidesPaths; }

  bool GathersPhotons() const {
    RenderSettings settings;
    Apply(settings);
    return lampyr::GathersPhotons(settings);
  }
  void Apply(RenderSettings& settings) const {
    settings.integrator = integrator;
    settings.values.Set("merge", merges);
    settings.values.Set("connect", connects);
    settings.values.Set("direct-photons", directFromPhotons);
    settings.values.Set("learn-lights", learns);
    settings.values.Set("learn-always", learns);
    settings.values.Set("light-samples", int64_t{lightSamples});
    settings.values.Set("guide-photons", guides);
    settings.values.Set("guide-paths", guidesPaths);
    settings.values.Set("guide-always", guidesPaths);
    settings.counts = counts.IsDefault() ? nullptr : std::make_shared<TechniqueCounts>(counts);
    settings.adaptive.reset();
    if (isAdaptive) settings.adaptive.emplace();
  }
};

// Techniques that are used now and then, wherever they are on the film.
inline TechniqueCounts NowAndThen(int log2LightPaths, float connecting, float merging, float continuing) {
  const auto everywhere = [](float value) { return FilmMask(1, 1, Point2(1.0f), {value}); };
  return {log2LightPaths, everywhere(connecting), everywhere(merging), everywhere(continuing)};
}

inline const std::vector<Mode>& Modes() {
  static const std::vector<Mode> modes = {
      {.name = "path, learning, adaptive, 2 lights",
       .integrator = "path",
       .learns = true,
       .isAdaptive = true,
       .lightSamples = 2},
      {.name = "path, guided", .integrator = "path", .guidesPaths = true},
      {.name = "light", .integrator = "light"},
      {.name = "bdpt", .integrator = "bdpt"},
      {.name = "bdpt, learning, adaptive, 2 lights, counts",
       .integrator = "bdpt",
       .learns = true,
       .isAdaptive = true,
       .lightSamples = 2,
       .counts = NowAndThen(-1, 1, 1, 0.5f)},
      {.name = "bdpt, guided", .integrator = "bdpt", .guidesPaths = true},
      {.name = "vcm", .integrator = "vcm"},
      {.name = "vcm, guided, learning, adaptive, 2 lights, counts",
       .integrator = "vcm",
       .guides = true,
       .learns = true,
       .isAdaptive = true,
       .guidesPaths = true,
       .lightSamples = 2,
       .counts = NowAndThen(0, 0.7f, 0.7f, 0.5f)},
      {.name = "vcm --no-connect", .integrator = "vcm", .connects = false},
      {.name = "vcm --no-connect, guided, learning",
       .integrator = "vcm",
       .connects = false,
       .guides = true,
       .learns = true,
       .guidesPaths = true},
      {.name = "sppm", .integrator = "sppm"},
      {.name = "sppm, guided, learning, adaptive, 2 lights",
       .integrator = "sppm",
       .guides = true,
       .learns = true,
       .isAdaptive = true,
       .lightSamples = 2},
      {.name = "sppm --direct-photons", .integrator = "sppm", .directFromPhotons = true},
      {.name = "sppm --direct-photons, guided", .integrator = "sppm", .directFromPhotons = true, .guides = true},
  };
  return modes;
}

// Mode `path` is what all are held against.
inline Mode Reference() {
  return {.name = "path", .integrator = "path"};
}

}  // namespace lampyr::test
