// The only file that includes CLI11.
#include "app/command_line.h"

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <initializer_list>
#include <limits>
#include <new>
#include <optional>
#include <string_view>

#include "app/command_support.h"
#include "app/commands.h"
#include "base/version.h"

namespace lampyr {

namespace {

struct Unit {
  const char* name;
  double factor;
};

// A number and one of the units, or none. Nothing where it is not that.
std::optional<double> ParseWithUnit(const std::string& text, std::initializer_list<Unit> units) {
  char* end = nullptr;
  const double number = std::strtod(text.c_str(), &end);
  if (end == text.c_str()) return std::nullopt;
  for (const Unit& unit : units) {
    if (std::string_view(end) == unit.name) return number * unit.factor;
  }
  return std::nullopt;
}

// "90", "90s", "1.5m", "2h" -> seconds.
double ParseDuration(const std::string& option, const std::string& text) {
  const auto seconds = ParseWithUnit(text, {{"", 1}, {"s", 1}, {"m", 60}, {"min", 60}, {"h", 3600}});
  if (!seconds || !(*seconds > 0) || !(*seconds < 1e9)) {
    throw UsageError(option + ": \"" + text + "\" is not a duration; write 90s, 5m or 2h");
  }
  return *seconds;
}

// "800M", "4G", "1000000000" -> bytes; nothing where nothing is said.
std::optional<uint64_t> ParseMemory(const std::string& option, const std::string& text) {
  if (text.empty()) return std::nullopt;
  constexpr double kibi = 1024, mebi = 1024 * kibi, gibi = 1024 * mebi;
  const auto bytes = ParseWithUnit(
      text, {{"", 1}, {"B", 1}, {"K", kibi}, {"KiB", kibi}, {"M", mebi}, {"MiB", mebi}, {"G", gibi}, {"GiB", gibi}});
  if (!bytes || !(*bytes >= 1) || !(*bytes < 1e15)) {
    throw UsageError(option + ": \"" + text + "\" is not a size; write 800M or 4G");
  }
  return static_cast<uint64_t>(*bytes);
}

void ParseResolution(const std::string& text, RenderOverrides& overrides) {
  int width = 0, height = 0;
  char rest = 0;
  if (std::sscanf(text.c_str(), "%dx%d%c", &width, &height, &rest) != 2 || width < 1 || height < 1 || width > 65536 ||
      height > 65536) {
    throw UsageError("--resolution: \"" + text + "\" is not a size; write 640x360");
  }
  overrides.width = width;
  overrides.height = height;
}

// The number that the whole text is; NaN where it is none. CLI11's own checks let NaN through.
double ParseFinite(const std::string& text) {
  char* end = nullptr;
  const double number = std::strtod(text.c_str(), &end);
  return end != text.c_str() && *end == '\0' && std::isfinite(number) ? number : std::nan("");
}

constexpr double kSmallestFloat = std::numeric_limits<float>::min(), kLargestFloat = std::numeric_limits<float>::max();

// Of numbers that become floats: less is 0 there, and more is infinite.
std::string CheckPositive(const std::string& text) {
  const double number = ParseFinite(text);
  if (number >= kSmallestFloat && number <= kLargestFloat) return "";
  if (!(number > 0)) return "\"" + text + "\" is not a number above 0";
  return "\"" + text + "\" is too " + (number < 1 ? "small: at least 1.2e-38" : "large: at most 3.4e38");
}

std::string CheckNotNegative(const std::string& text) {
  const double number = ParseFinite(text);
  return number >= 0 && number <= kLargestFloat ? "" : "\"" + text + "\" is not a number of 0 or more";
}

std::string CheckFraction(const std::string& text) {
  const double number = ParseFinite(text);
  return number >= 0 && number <= 1 ? "" : "\"" + text + "\" is not a number from 0 to 1";
}

std::string CheckFinite(const std::string& text) {
  return std::abs(ParseFinite(text)) <= kLargestFloat ? "" : "\"" + text + "\" is not a finite number";
}

// Absent unless the flag or its opposite is given.
void AddSwitch(CLI::App& app, const std::string& names, std::optional<bool>& value, const std::string& description) {
  app.add_flag(
      names, [&value](int64_t times) { value = times > 0; }, description);
}

void DefinePluginOption(CLI::App& app, PluginOptions& plugins, bool readsScenes = true) {
  app.add_option("--plugin", plugins.files,
                 "A plugin with types of lights and filters, e.g. ring.so; may be given several times. Those in the "
                 "folders of LAMPYR_PLUGIN_PATH are loaded, too")
      ->allow_extra_args(false);
  if (!readsScenes) return;
  app.add_flag("--allow-scene-plugins", plugins.allowsScenePlugins,
               "Load the plugins that the scene names (Option \"plugins\"), wherever they lie: they are native code");
}

// What render and compare are told alike.
void DefineSceneOptions(CLI::App& app, RenderOverrides& overrides, std::string& resolution, std::string& photonMemory,
                        int& threads) {
  app.add_option("--seed", overrides.seed, "Seed of the random numbers (0)");
  app.add_option("--threads", threads, "Threads (all)")->check(CLI::Range(1, 4096));
  app.add_option("--resolution", resolution, "Size of the image, e.g. 640x360");
  app.add_option("--crop", overrides.crop, "x0,x1,y0,y1: the part to render, in fractions of the image or in pixels");
  app.add_option("--max-depth", overrides.maxDepth, "Scattering events of a path at most")
      ->check(CLI::Range(0, 1 << 20));
  app.add_option("--sampler", overrides.sampler, "sobol | independent");
  app.add_option("--light-sampler", overrides.lightSampler,
                 "How a light is chosen: uniform | power | tree (default) | exhaustive");
  app.add_option("--light-samples", overrides.lightSamples,
                 "Lights to choose at each vertex, at most; fewer where few matter (1)")
      ->check(CLI::Range(1, LightChoices::kMost));
  app.add_option("--photons", overrides.photons, "sppm, vcm: light paths of a pass (as many as the image has pixels)")
      ->check(CLI::Range(uint64_t{1}, uint64_t{1} << 31));
  app.add_option("--photon-memory", photonMemory,
                 "sppm, vcm: memory for the photons of a pass, e.g. 512M, 4G; fewer light paths where it does not do "
                 "(4G, on any machine: the picture depends on it)");
  app.add_option("--radius", overrides.radius,
                 "sppm, vcm: where photons are gathered in the first pass, scene units (from the size of pixels)")
      ->check(CheckPositive, "POSITIVE");
  app.add_option("--alpha", overrides.alpha, "sppm, vcm: how fast that radius shrinks, as pass^((alpha - 1) / 2) (2/3)")
      ->check(CheckFraction, "");
  AddSwitch(app, "--merge,!--no-merge", overrides.merges, "vcm: merge with photons (on); without, it is bdpt");
  AddSwitch(app, "--connect,!--no-connect", overrides.connects,
            "vcm: connect vertices (on); without, it is bidirectional photon mapping");
  AddSwitch(app, "--direct-photons,!--no-direct-photons", overrides.directFromPhotons,
            "sppm: gather photons for direct light, too, instead of sampling lights (off)");
  AddSwitch(app, "--guide-photons,!--no-guide-photons", overrides.guidesPhotons,
            "sppm, vcm: learn where photons are of use, and aim them there if it pays (on)");
  app.add_option(
         "--shadow-roulette", overrides.shadowRoulette,
         "Trace shadow rays by chance whose light is below this part of what their sample has gathered: the mean "
         "stays (0.05); 0: trace all")
      ->check(CheckFraction, "");
  app.add_option(
         "--shadow-threshold", overrides.shadowThreshold,
         "Leave out light that is below this, in the image's units, without a shadow ray: faster, and biased (0)")
      ->check(CheckNotNegative, "");
  AddSwitch(app, "--learn-lights,!--no-learn-lights", overrides.learnLights,
            "Let the light tree learn which lights are occluded where (off)");
}

// "2/8".
std::pair<int, int> ParseShard(const std::string& text) {
  int index = 0, count = 0;
  char rest = 0;
  if (std::sscanf(text.c_str(), "%d/%d%c", &index, &count, &rest) != 2 || count < 1 || count > 1 << 20 || index < 1 ||
      index > count) {
    throw UsageError("--shard: \"" + text + "\" is no part; write 2/8 for the second of eight");
  }
  return {index, count};
}

// How often --resume goes on writing checkpoints, where nothing is said.
constexpr double kCheckpointSeconds = 60;

struct RenderCommand {
  RenderOptions options;
  std::string time, resolution, photonMemory, checkpoint, shard;
  bool fast = false;

  void Define(CLI::App& app) {
    RenderOverrides& overrides = options.overrides;
    app.add_option("scene", options.scene, "The scene: a pbrt-v4 file (.pbrt, .pbrt.gz)")->required();
    app.add_option("-o,--output", options.output, "The image to write (.exr); default: the name in the scene");
    app.add_flag("--png", options.png, "Also write a tone-mapped PNG beside it");
    app.add_option("--exposure", options.exposure, "Exposure of the PNG in stops (0)")->check(CheckFinite, "");
    app.add_flag("--clip", options.clipPng, "Clip the PNG at white instead of rolling highlights off");
    app.add_option("--integrator", overrides.integrator,
                   "path | light | bdpt | sppm | vcm, or auto: as `lampyr plan` says");
    app.add_option("--spp", overrides.samplesPerPixel, "Stop after this many samples per pixel")
        ->check(CLI::Range(1, 1 << 30));
    app.add_option("--time", time, "Stop after this time: 90s, 5m, 2h");
    app.add_option("--target-error", options.targetError,
                   "Stop when the estimated relative error (95 % confidence) is below this, e.g. 0.02")
        ->check(CheckPositive, "POSITIVE");
    DefineSceneOptions(app, overrides, resolution, photonMemory, options.threads);
    DefinePluginOption(app, options.plugins);
    app.add_option("--checkpoint", checkpoint,
                   "Write the image and what it takes to go on (OUT.checkpoint) this often: 30s, 5m. It stays there");
    app.add_flag("--resume", options.resume,
                 "Go on where OUT.checkpoint ends, if there is one, and write more of them (every minute)");
    app.add_option("--shard", shard,
                   "Render one part of the samples, e.g. 2/8, for `lampyr merge`; default of --output: OUT.2-of-8.exr");
    app.add_option("--stats", options.stats, "Write statistics to this JSON file");
    app.add_option("--strategy-images", options.strategyImages,
                   "Write what each technique of bdpt contributes, weighted and not, to this folder");
    app.add_flag("--quiet", options.quiet, "No progress and no summary");
    app.add_flag("--strict", options.strict, "Warnings about the scene are errors");
    app.add_flag("--fast-intersection", fast,
                 "Trade watertight intersection for speed: rays may slip through shared edges");
  }

  int Run() {
    if (!time.empty()) options.seconds = ParseDuration("--time", time);
    if (options.resume) options.checkpointSeconds = kCheckpointSeconds;
    if (!checkpoint.empty()) options.checkpointSeconds = ParseDuration("--checkpoint", checkpoint);
    if (!shard.empty()) options.shard = ParseShard(shard);
    if (!resolution.empty()) ParseResolution(resolution, options.overrides);
    options.overrides.photonMemory = ParseMemory("--photon-memory", photonMemory);
    options.robust = !fast;
    return RunRender(options);
  }
};

void DefineMerge(CLI::App& app, MergeOptions& options) {
  app.add_option("parts", options.parts, "Images of `lampyr render --shard`")->required();
  app.add_option("-o,--output", options.output, "The image to write (.exr)")->required();
  app.add_flag("--partial", options.partial, "Merge what there is, even if parts are missing or not finished");
  app.add_flag("--png", options.png, "Also write a tone-mapped PNG beside it");
  app.add_option("--exposure", options.exposure, "Exposure of the PNG in stops (0)")->check(CheckFinite, "");
  app.add_flag("--clip", options.clipPng, "Clip the PNG at white instead of rolling highlights off");
  app.add_flag("--quiet", options.quiet, "No summary");
}

struct CompareCommand {
  CompareOptions options;
  std::vector<std::string> times;
  std::string resolution, photonMemory, referenceTime;
  bool fast = false;

  void Define(CLI::App& app) {
    app.add_option("scene", options.scene, "The scene: a pbrt-v4 file (.pbrt, .pbrt.gz)")->required();
    app.add_option("-o,--output", options.output,
                   "The folder for results.csv, results.json, report.html and the reference; default: SCENE-compare");
    app.add_option(
           "--integrators", options.integrators,
           "Which to compare, e.g. path,bdpt (path,bdpt); path:shadow-threshold=0.01 is one with a setting changed")
        ->delimiter(',')
        ->allow_extra_args(false);
    app.add_option("--budget", times, "Times to compare at, e.g. 5s,20s,80s (1s,4s,16s)")
        ->delimiter(',')
        ->allow_extra_args(false);
    app.add_option("--spp", options.sampleCounts, "Samples per pixel to compare at, e.g. 4,16,64")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->check(CLI::Range(1, 1 << 30));
    app.add_option("--repeat", options.repeats, "Renders with other seeds that the intervals come from (5)")
        ->check(CLI::Range(2, 1000));
    app.add_option("--reference", options.reference,
                   "An image to measure against; default: made, and kept in the folder");
    app.add_option("--reference-time", referenceTime,
                   "Time to make the reference in; default: ten times the longest render");
    app.add_option("--exposure", options.exposure, "Exposure of the pictures in stops (0)")->check(CheckFinite, "");
    DefineSceneOptions(app, options.overrides, resolution, photonMemory, options.threads);
    DefinePluginOption(app, options.plugins);
    app.add_flag("--quiet", options.quiet, "No progress and no tables");
    app.add_flag("--strict", options.strict, "Warnings about the scene are errors");
    app.add_flag("--fast-intersection", fast,
                 "Trade watertight intersection for speed: rays may slip through shared edges");
  }

  int Run(int argc, char** argv) {
    for (const std::string& time : times) options.times.push_back(ParseDuration("--budget", time));
    if (!referenceTime.empty()) options.referenceSeconds = ParseDuration("--reference-time", referenceTime);
    if (!resolution.empty()) ParseResolution(resolution, options.overrides);
    options.overrides.photonMemory = ParseMemory("--photon-memory", photonMemory);
    options.robust = !fast;
    options.command = "lampyr";
    for (int i = 1; i < argc; ++i) options.command += std::string(" ") + argv[i];
    return RunCompare(options);
  }
};

}  // namespace

namespace {

int ParseAndRun(int argc, char** argv) {
  CLI::App app("lampyr: a renderer whose subject is the light", "lampyr");
  app.set_version_flag("--version", std::string("lampyr ") + kVersion);
  app.require_subcommand(1);

  RenderCommand render;
  render.Define(*app.add_subcommand("render", "Render a scene to an EXR image"));

  CompareCommand compare;
  compare.Define(
      *app.add_subcommand("compare", "Measure integrators against each other: error by time and by samples"));

  MergeOptions merge;
  CLI::App* mergeCommand = app.add_subcommand("merge", "Make one image of the parts of a render");
  DefineMerge(*mergeCommand, merge);

  PlanOptions plan;
  CLI::App* planCommand =
      app.add_subcommand("plan", "What a scene requires, and what is therefore modelled, with reasons");
  plan.overrides.integrator = "auto";
  planCommand->add_option("scene", plan.scene, "The scene: a pbrt-v4 file (.pbrt, .pbrt.gz)")->required();
  planCommand->add_option("--integrator", plan.overrides.integrator, "Instead of the one that suits the scene");
  planCommand->add_flag("--strict", plan.strict, "Warnings about the scene are errors");
  DefinePluginOption(*planCommand, plan.plugins);

  DiffOptions diff;
  CLI::App* diffCommand = app.add_subcommand("diff", "Compare two images: MSE, relMSE, FLIP, bias, z-test by blocks");
  diffCommand->add_option("a", diff.a, "The image that is judged")->required();
  diffCommand->add_option("b", diff.b, "The reference")->required();
  diffCommand->add_option("--block", diff.blockSize, "Side of the z-test's blocks in pixels (8)")
      ->check(CLI::Range(1, 4096));
  diffCommand->add_flag("--json", diff.json, "Print JSON");
  diffCommand->add_flag("--fail", diff.fail, "Exit with 1 unless the images are equal or agree");
  diffCommand->add_option(
      "-o,--output", diff.output,
      "Write the error image (.exr): the absolute difference of each pixel, and its relative error");

  CheckLightsOptions check;
  CLI::App* checkCommand =
      app.add_subcommand("check-lights",
                         "Prove the densities of lights, and light filters: of every type, a plugin's, or a scene's "
                         "lights. What fails is named, with what that means and where it was worst");
  checkCommand->add_option("scene", check.scene, "A scene, whose lights are checked as they are placed");
  checkCommand->add_option("--type", check.type, "Only this type of light or of light filter");
  DefinePluginOption(*checkCommand, check.plugins);
  checkCommand->add_flag("--json", check.json, "Print JSON");
  checkCommand->add_option("--seed", check.seed, "Seed of the samples (1)");
  checkCommand->add_option("--threads", check.threads, "Threads (all)")->check(CLI::Range(1, 4096));

  LightsOptions lights;
  CLI::App* lightsCommand =
      app.add_subcommand("lights", "The types of light and of light filter, and their parameters");
  lightsCommand->add_option("type", lights.type, "Only this type");
  DefinePluginOption(*lightsCommand, lights.plugins, false);

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kExitDone : kExitUsage;
  }
  if (app.got_subcommand("render")) return render.Run();
  if (app.got_subcommand(mergeCommand)) return RunMerge(merge);
  if (app.got_subcommand("compare")) return compare.Run(argc, argv);
  if (app.got_subcommand(planCommand)) return RunPlan(plan);
  if (app.got_subcommand(diffCommand)) return RunDiff(diff);
  if (app.got_subcommand(checkCommand)) return RunCheckLights(check);
  return RunLights(lights);
}

}  // namespace

int RunCommandLine(int argc, char** argv) {
  try {
    return ParseAndRun(argc, argv);
  } catch (const UsageError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return kExitUsage;
  } catch (const Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return kExitFailed;
  } catch (const std::bad_alloc&) {
    ReportMemoryFailure();
    return kExitFailed;
  } catch (const std::exception& error) {  // of a library or of the system
    std::fprintf(stderr, "error: %s\n", error.what());
    return kExitFailed;
  }
}

}  // namespace lampyr
