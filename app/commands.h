// The commands, with their options as plain data, independent of the command line.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/network_place.h"
#include "render/build/plugins.h"
#include "render/settings/render_settings.h"

namespace lampyr {

struct RenderOptions {
  std::filesystem::path scene;
  PluginOptions plugins;
  std::optional<std::filesystem::path>
      output;  // default: the scene's own file name, else the scene's stem, in this folder
  bool png = false;
  float exposure = 0;    // stops, of the PNG
  bool clipPng = false;  // the PNG clips at 1 instead of compressing highlights
  RenderOverrides overrides;
  std::optional<double> seconds;      // --time
  std::optional<double> targetError;  // --target-error
  std::optional<double> pixelShare;   // --of-pixels
  int threads = 0;                    // 0: all
  std::optional<std::filesystem::path> stats;
  std::optional<std::filesystem::path> strategyImages;  // a folder
  bool denoise = false;
  bool autoLayers = false;                  // layers of the decisions of auto
  std::optional<double> checkpointSeconds;  // --checkpoint
  std::optional<double> previewSeconds;     // --preview
  std::optional<NetworkPlace> display;      // --display
  bool resume = false;
  std::optional<std::pair<int, int>> shard;  // which of how many, from 1
  bool quiet = false;
  bool strict = false;
  bool robust = true;
};

struct MergeOptions {
  std::vector<std::filesystem::path> parts;
  std::filesystem::path output;
  bool partial = false;  // parts may be missing
  bool png = false;
  float exposure = 0;  // stops, of the PNG
  bool clipPng = false;
  bool quiet = false;
};

struct CompareOptions {
  std::filesystem::path scene;
  PluginOptions plugins;
  std::vector<std::string> integrators = {"path", "bdpt"};
  std::vector<double> times;      // seconds; neither times nor sample counts: 1, 4 and 16 s
  std::vector<int> sampleCounts;  // per pixel
  int repeats = 5;
  std::optional<std::filesystem::path> reference;  // absent: rendered, or kept from before
  std::optional<double> referenceSeconds;          // absent: ten times the longest render
  std::filesystem::path output;                    // a folder
  float exposure = 0;                              // stops, of the pictures
  RenderOverrides overrides;
  int threads = 0;           // 0: all
  bool ofProcessor = false;  // times are processor times
  bool quiet = false;
  bool strict = false;
  bool robust = true;
  std::string command;  // as it was typed, for the report
};

struct PlanOptions {
  std::filesystem::path scene;
  PluginOptions plugins;
  RenderOverrides overrides;
  int threads = 0;  // 0: all
  bool strict = false;
};

struct DiffOptions {
  std::filesystem::path a, b;
  bool json = false;
  bool fail = false;             // exit with 1 unless they agree
  std::filesystem::path output;  // of the error image; empty: none
  int blockSize = 8;
};

struct DenoiseOptions {
  std::filesystem::path input, output;
  int threads = 0;  // 0: all
  bool png = false;
  float exposure = 0;  // stops, of the PNG
  bool clipPng = false;
  bool quiet = false;
};

struct MixOptions {
  std::filesystem::path input, output;
  std::vector<std::string> factors;  // LAYER=FACTOR
  bool png = false;
  float exposure = 0;  // stops, of the PNG
  bool clipPng = false;
  bool quiet = false;
};

struct DeskOptions {
  std::filesystem::path scene;
  PluginOptions plugins;
  RenderOverrides overrides;
  int port = 0;     // 0: any that is free
  int threads = 0;  // 0: any free port
  bool quiet = false;
  bool strict = false;
  bool robust = true;
};

struct PngOptions {
  std::filesystem::path input, output;  // output empty: beside the input, with the extension .png
  float exposure = 0;                   // stops
  bool clip = false;                    // clips at 1 instead of compressing highlights
  bool quiet = false;
};

struct CheckLightsOptions {
  std::optional<std::filesystem::path> scene;  // absent: types
  PluginOptions plugins;
  std::string type;  // "": all types of `plugins`, or all types if there are none
  bool json = false;
  uint64_t seed = 1;
  int threads = 0;  // 0: all
};

struct LightsOptions {
  PluginOptions plugins;
  std::string type;  // "" lists all
};

// Each returns an exit code. Errors are thrown.
int RunRender(const RenderOptions& options);
int RunMerge(const MergeOptions& options);
int RunCompare(const CompareOptions& options);
int RunPlan(const PlanOptions& options);
int RunDiff(const DiffOptions& options);
int RunMix(const MixOptions& options);
int RunDesk(const DeskOptions& options);
int RunDenoise(const DenoiseOptions& options);
int RunPng(const PngOptions& options);
int RunLights(const LightsOptions& options);
int RunCheckLights(const CheckLightsOptions& options);  // fails if a property does not hold

}  // namespace lampyr
