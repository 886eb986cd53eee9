// Machine-readable reports.
#pragma once

#include <string>

#include "film/metrics.h"
#include "render/progressive_render.h"
#include "suite/verdict.h"

namespace lampyr {

// Contents of the file written by `--stats`. Times in seconds, memory in MiB.
struct RenderReport {
  std::string scene, sceneHash, integrator;
  std::vector<std::pair<std::string, SettingValue>> settings;  // of the integrator
  std::optional<UsedCounts> decided;  // by auto, on average over the film; nullopt: the integrator was given
  struct Adaptive {
    double share = 0;
    uint64_t fewestSamples = 0, mostSamples = 0;  // of a pixel
  };
  std::optional<Adaptive> adaptive;
  uint64_t seed = 0;
  int threads = 1, width = 0, height = 0;
  int64_t pixels = 0;
  size_t primitives = 0, lights = 0;
  std::vector<std::string> lightGroups;                     // layers of the image
  std::vector<std::pair<std::string, std::string>> layers;  // further ones, and their light path expressions
  double parseSeconds = 0, buildSeconds = 0, writeSeconds = 0;
  uint64_t rejectedRays = 0;
  int resumedSamples = 0;  // per pixel, from a checkpoint
  RenderOutcome outcome;
};

std::string ToJson(const RenderReport& report);
std::string ToJson(const std::vector<LightVerdict>& verdicts);
std::string ToJson(const ImageDifference& difference);

}  // namespace lampyr
