// The only file that includes CLI11.
#include "app/command_line.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <map>
#include <new>

#include "app/command_support.h"
#include "app/commands.h"
#include "app/help_formatter.h"
#include "app/option_values.h"
#include "base/version.h"
#include "integrators/registry.h"

namespace lampyr {

namespace {

// Help text of a setting with its default, and with the integrators that have it unless nearly all do.
std::string HelpOf(const Setting& setting) {
  std::string owners;
  size_t count = 0;
  for (const IntegratorType& type : IntegratorRegistry()) {
    if (std::find(type.settings.begin(), type.settings.end(), &setting) == type.settings.end()) continue;
    owners += (count > 0 ? ", " : "") + type.name;
    ++count;
  }
  // A setting that at most one integrator lacks is not attributed to particular integrators.
  std::string help = count + 1 >= IntegratorRegistry().size() ? "" : owners + ": ";
  help +=
      setting.help + " (" + (setting.fallbackText.empty() ? setting.Format(setting.fallback) : setting.fallbackText);
  if (!setting.without.empty()) help += "; without, " + setting.without;
  return help + ")";
}

// Placeholder for a value in the help: "N" for integers, "X" for reals, "WORD" for text.
const char* KindOf(const SettingValue& value) {
  return std::holds_alternative<int64_t>(value) ? "N" : std::holds_alternative<double>(value) ? "X" : "WORD";
}

// Defines an option for each setting of an integrator: --name VALUE, for switches --name and --no-name.
void DefineSettings(CLI::App& app, std::map<std::string, SettingValue>& values) {
  const Settings all = IntegratorSettings();
  for (const auto& [declared, fallback] : all.All()) {
    const Setting* setting = declared;
    const std::string name = "--" + setting->name, help = HelpOf(*setting);
    if (const bool* isOn = std::get_if<bool>(&fallback)) {
      const std::string off = "!--no-" + setting->name;
      app.add_flag(
          *isOn ? off + "," + name : name + "," + off,
          [&values, setting](int64_t times) { values[setting->name] = times > 0; }, help);
      continue;
    }
    app.add_option_function<std::string>(
           name, [&values, setting](const std::string& text) { values[setting->name] = setting->Parse(text); }, help)
        ->check(CLI::Validator(
            [setting](std::string& text) -> std::string {
              try {
                setting->Parse(text);
                return "";
              } catch (const Error& error) {
                return error.Text();
              }
            },
            ""))
        ->type_name(KindOf(fallback));
  }
}

void DefinePluginOption(CLI::App& app, PluginOptions& plugins, bool readsScenes = true) {
  app.add_option("--plugin", plugins.files,
                 "A plugin with types of lights and filters, e.g. ring.so; may be given several times. Those in the "
                 "folders of LAMPYR_PLUGIN_PATH are loaded, too")
      ->type_name("FILE")
      ->allow_extra_args(false);
  if (!readsScenes) return;
  app.add_flag("--allow-scene-plugins", plugins.allowsScenePlugins,
               "Load the plugins that the scene names (Option \"plugins\"), wherever they lie: they are native code");
}

// Options that plan, render and compare share.
void DefineSceneOptions(CLI::App& app, RenderOverrides& overrides, std::string& resolution, int& threads) {
  app.add_option("--seed", overrides.seed, "Seed of the random numbers (0)")->check(CheckSeed, "");
  app.add_option("--threads", threads, "Threads (all)")->check(CLI::Range(1, 4096));
  app.add_option("--resolution", resolution, "Size of the image, e.g. 640x360")->type_name("WxH");
  app.add_option("--crop", overrides.crop, "x0,x1,y0,y1: the part to render, in fractions of the image or in pixels")
      ->type_name("X0,X1,Y0,Y1");
  app.add_option("--sampler", overrides.sampler, "sobol | independent")->type_name("NAME");
  DefineSettings(app, overrides.values);
}

// Help text of --integrator.
std::string IntegratorChoices() {
  std::string names;
  for (const IntegratorType& type : IntegratorRegistry()) names += (names.empty() ? "" : " | ") + type.name;
  return names + ", or auto: as `lampyr plan` says";
}

// Options of a PNG that is written beside the image.
void DefinePngOptions(CLI::App& app, bool& png, float& exposure, bool& clips) {
  app.add_flag("--png", png, "Also write a tone-mapped PNG beside it");
  app.add_option("--exposure", exposure, "Exposure of the PNG in stops (0)")->check(CheckFinite, "");
  app.add_flag("--clip", clips, "Clip the PNG at white instead of rolling highlights off");
}

// Default interval of checkpoints with --resume, seconds.
constexpr double kCheckpointSeconds = 60;

// The names of light path expressions.
std::string KnownLayers() {
  std::string names;
  for (const NamedExpression& each : NamedExpressions()) names += (names.empty() ? "" : ", ") + std::string(each.name);
  return names;
}
std::string KnownPixelLayers() {
  std::string names;
  for (const PixelLayer& each : PixelLayers()) names += (names.empty() ? "" : ", ") + std::string(each.name);
  return names;
}

struct RenderCommand {
  RenderOptions options;
  std::string time, resolution, checkpoint, preview, shard, display;
  bool adaptive = false, notAdaptive = false, fast = false, isSpectral = false, isNotSpectral = false;

  void Define(CLI::App& app) {
    RenderOverrides& overrides = options.overrides;
    app.add_option("scene", options.scene, "The scene: a pbrt-v4 file (.pbrt, .pbrt.gz)")
        ->type_name("FILE")
        ->required();
    app.add_option("-o,--output", options.output, "The image to write (.exr); default: the name in the scene")
        ->type_name("FILE");
    DefinePngOptions(app, options.png, options.exposure, options.clipPng);
    app.add_option("--integrator", overrides.integrator, IntegratorChoices())->type_name("NAME");
    app.add_option("--spp", overrides.samplesPerPixel, "Stop after this many samples per pixel")
        ->check(CLI::Range(1, 1 << 30));
    app.add_option("--time", time, "Stop after this time: 90s, 5m, 2h")->type_name("DURATION");
    app.add_option("--target-error", options.targetError,
                   "Stop when the estimated relative error (95 % confidence) is below this, e.g. 0.02")
        ->check(CheckPositive, "POSITIVE");
    app.add_option("--of-pixels", options.pixelShare,
                   "With --target-error: stop when the errors of this share of the pixels, each by itself, are below "
                   "that, e.g. 0.95")
        ->check(CheckShare, "SHARE");
    CLI::Option* const on =
        app.add_flag("--adaptive", adaptive, "More samples where the error is large, unbiased (on with --of-pixels)");
    app.add_flag("--no-adaptive", notAdaptive, "All pixels have the same number of samples")->excludes(on);
    CLI::Option* spectral =
        app.add_flag("--spectral", isSpectral, "Carry light by wavelength, whether something disperses it or not");
    app.add_flag("--no-spectral", isNotSpectral, "Carry light as red, green and blue; glass disperses nothing")
        ->excludes(spectral);
    DefineSceneOptions(app, overrides, resolution, options.threads);
    DefinePluginOption(app, options.plugins);
    app.add_option("--checkpoint", checkpoint,
                   "Write the image and what it takes to go on (OUT.checkpoint) this often: 30s, 5m. It stays there")
        ->type_name("DURATION");
    app.add_option(
           "--preview", preview,
           "Write the picture so far as a PNG, OUT.png, this often: 2s, 1m; and show it in the terminal if that "
           "has 24-bit colours (COLORTERM=truecolor)")
        ->type_name("DURATION");
    app.add_option("--display", display,
                   "Show the picture so far in the viewer tev, or another that speaks its protocol, with its layers of "
                   "light; tev listens at 127.0.0.1:14158")
        ->type_name("HOST:PORT");
    app.add_flag("--resume", options.resume,
                 "Go on where OUT.checkpoint ends, if there is one, and write more of them (every minute)");
    app.add_option("--shard", shard,
                   "Render one part of the samples, e.g. 2/8, for `lampyr merge`; default of --output: OUT.2-of-8.exr")
        ->type_name("I/N");
    app.add_option("--stats", options.stats, "Write statistics to this JSON file")->type_name("FILE");
    DefineLayers(app);
    app.add_flag("--quiet", options.quiet, "No progress and no summary");
    app.add_flag("--strict", options.strict, "Warnings about the scene are errors");
    app.add_flag("--fast-intersection", fast,
                 "Trade watertight intersection for speed: rays may slip through shared edges");
  }

  void DefineLayers(CLI::App& app) {
    app.add_option(
           "--layer", options.overrides.layers,
           "Add a layer of some of the light: " + KnownLayers() +
               "; one of these from one light, \"caustic<L.'key'>\"; or any light path expression with a name, "
               "\"keys=C<RD>[<L.'key'>O]\". Or one of what pixels see and of their samples: " +
               KnownPixelLayers() +
               ". Or \"strategies\": what each technique of bdpt and vcm contributes. May be given more than once")
        ->type_name("LAYER")
        ->allow_extra_args(false);
    app.add_flag("--through-smooth", options.overrides.seesThroughSmooth,
                 "What pixels see, for those layers, is what mirrors and smooth glass show");
    app.add_option("--spectral-bands", options.overrides.spectralBands,
                   "Carry light by wavelength and write the spectrum, too, as the mean of this many bands from 360 to "
                   "830 nm, or of the range of Film \"spectral\", which has 16")
        ->check(CLI::Range(1, 512));
    app.add_flag("--denoise", options.denoise,
                 "Denoise the picture; as it was rendered it stays in the layer \"noisy\". With --shard: keep what "
                 "`lampyr denoise` wants of the merged picture");
    app.add_flag("--auto-layers", options.autoLayers,
                 "Add layers of what --integrator auto decided: auto.lightPaths, auto.connecting, auto.merging, "
                 "auto.continuing");
    app.add_option(
           "--strategy-images", options.strategyImages,
           "Write what each technique of bdpt or vcm contributes, weighted and not, to this folder; the picture "
           "has it in layers, as with --layer strategies")
        ->type_name("FOLDER");
  }

  int Run() {
    if (!time.empty()) options.seconds = ParseDuration("--time", time);
    if (options.resume) options.checkpointSeconds = kCheckpointSeconds;
    if (!checkpoint.empty()) options.checkpointSeconds = ParseDuration("--checkpoint", checkpoint);
    if (!preview.empty()) options.previewSeconds = ParseDuration("--preview", preview);
    if (!display.empty()) options.display = ParseNetworkPlace("--display", display);
    if (!shard.empty()) options.shard = ParseShard(shard);
    if (!resolution.empty()) ParseResolution(resolution, options.overrides);
    options.robust = !fast;
    if (options.pixelShare && !options.targetError)
      throw UsageError("--of-pixels goes with --target-error: it is the share of the pixels that are to be below that");
    if (isSpectral || isNotSpectral) options.overrides.spectral = isSpectral;
    if (adaptive || (options.pixelShare && !notAdaptive))
      options.overrides.adaptive = AdaptiveSettings{options.pixelShare.value_or(AdaptiveSettings().share)};
    return RunRender(options);
  }
};

struct MergeCommand {
  MergeOptions options;

  void Define(CLI::App& app) {
    app.add_option("parts", options.parts, "Images of `lampyr render --shard`")->type_name("FILE")->required();
    app.add_option("-o,--output", options.output, "The image to write (.exr)")->type_name("FILE")->required();
    app.add_flag("--partial", options.partial, "Merge what there is, even if parts are missing or not finished");
    DefinePngOptions(app, options.png, options.exposure, options.clipPng);
    app.add_flag("--quiet", options.quiet, "No summary");
  }
  int Run() { return RunMerge(options); }
};

struct DenoiseCommand {
  DenoiseOptions options;

  void Define(CLI::App& app) {
    app.add_option("image", options.input, "An image with variance layers, as `lampyr render` writes it")
        ->type_name("FILE")
        ->required();
    app.add_option("-o,--output", options.output, "The image to write (.exr)")->type_name("FILE")->required();
    app.add_option("--threads", options.threads, "Threads (all)")->check(CLI::Range(1, 4096));
    DefinePngOptions(app, options.png, options.exposure, options.clipPng);
    app.add_flag("--quiet", options.quiet, "No progress and no summary");
  }
  int Run() { return RunDenoise(options); }
};

struct MixCommand {
  MixOptions options;

  void Define(CLI::App& app) {
    app.add_option("image", options.input, "A picture with layers (.exr), of light groups or of --layer")
        ->type_name("FILE")
        ->required();
    app.add_option("factors", options.factors, "Factors of layers: key=2 fill=0.5,0.4,0.3 caustic=0")
        ->type_name("LAYER=FACTOR")
        ->required();
    app.add_option("-o,--output", options.output, "The image to write (.exr)")->type_name("FILE")->required();
    DefinePngOptions(app, options.png, options.exposure, options.clipPng);
    app.add_flag("--quiet", options.quiet, "No summary");
  }
  int Run() { return RunMix(options); }
};

struct DeskCommand {
  DeskOptions options;
  std::string resolution;
  bool fast = false;

  void Define(CLI::App& app) {
    app.add_option("scene", options.scene, "The scene: a pbrt-v4 file (.pbrt, .pbrt.gz)")
        ->type_name("FILE")
        ->required();
    constexpr int kLargestPort = 65535;
    app.add_option("--port", options.port, "Of 127.0.0.1, where the page is served; default: any that is free")
        ->check(CLI::Range(1, kLargestPort));
    app.add_option("--integrator", options.overrides.integrator, IntegratorChoices())->type_name("NAME");
    app.add_option("--spp", options.overrides.samplesPerPixel,
                   "Rest after this many samples per pixel; default: go on and on")
        ->check(CLI::Range(1, 1 << 20));
    DefineSceneOptions(app, options.overrides, resolution, options.threads);
    DefinePluginOption(app, options.plugins);
    app.add_flag("--quiet", options.quiet, "Print the address alone");
    app.add_flag("--strict", options.strict, "Warnings about the scene are errors");
    app.add_flag("--fast-intersection", fast,
                 "Trade watertight intersection for speed: rays may slip through shared edges");
  }
  int Run() {
    if (!resolution.empty()) ParseResolution(resolution, options.overrides);
    options.robust = !fast;
    return RunDesk(options);
  }
};

struct PngCommand {
  PngOptions options;

  void Define(CLI::App& app) {
    app.add_option("image", options.input, "The image: an EXR, or another format that textures may have")
        ->type_name("FILE")
        ->required();
    app.add_option("-o,--output", options.output, "The PNG to write; default: beside the image, with its name")
        ->type_name("FILE");
    app.add_option("--exposure", options.exposure, "Exposure in stops (0)")->check(CheckFinite, "");
    app.add_flag("--clip", options.clip, "Clip at white instead of rolling highlights off");
    app.add_flag("--quiet", options.quiet, "No summary");
  }
  int Run() { return RunPng(options); }
};

struct PlanCommand {
  PlanOptions options;
  std::string resolution;

  void Define(CLI::App& app) {
    options.overrides.integrator = "auto";
    app.add_option("scene", options.scene, "The scene: a pbrt-v4 file (.pbrt, .pbrt.gz)")
        ->type_name("FILE")
        ->required();
    app.add_option("--integrator", options.overrides.integrator, "Instead of the one that suits the scene")
        ->type_name("NAME");
    DefineSceneOptions(app, options.overrides, resolution, options.threads);
    app.add_flag("--strict", options.strict, "Warnings about the scene are errors");
    DefinePluginOption(app, options.plugins);
  }
  int Run() {
    if (!resolution.empty()) ParseResolution(resolution, options.overrides);
    return RunPlan(options);
  }
};

struct DiffCommand {
  DiffOptions options;

  void Define(CLI::App& app) {
    app.add_option("a", options.a, "The image that is judged")->type_name("FILE")->required();
    app.add_option("b", options.b, "The reference")->type_name("FILE")->required();
    app.add_option("--block", options.blockSize, "Side of the z-test's blocks in pixels (8)")
        ->check(CLI::Range(1, 4096));
    app.add_flag("--json", options.json, "Print JSON");
    app.add_flag("--fail", options.fail, "Exit with 1 unless the images are equal or agree");
    app.add_option("-o,--output", options.output,
                   "Write the error image (.exr): the absolute difference of each pixel, and its relative error")
        ->type_name("FILE");
  }
  int Run() { return RunDiff(options); }
};

struct CheckLightsCommand {
  CheckLightsOptions options;

  void Define(CLI::App& app) {
    CLI::Option* scene = app.add_option("scene", options.scene, "A scene, whose lights are checked as they are placed")
                             ->type_name("FILE");
    app.add_option("--type", options.type, "Only this type of light or of light filter; not with a scene")
        ->type_name("NAME")
        ->excludes(scene);
    DefinePluginOption(app, options.plugins);
    app.add_flag("--json", options.json, "Print JSON");
    app.add_option("--seed", options.seed, "Seed of the samples (1)")->check(CheckSeed, "");
    app.add_option("--threads", options.threads, "Threads (all)")->check(CLI::Range(1, 4096));
  }
  int Run() { return RunCheckLights(options); }
};

struct LightsCommand {
  LightsOptions options;

  void Define(CLI::App& app) {
    app.add_option("type", options.type, "Only this type")->type_name("NAME");
    DefinePluginOption(app, options.plugins, false);
  }
  int Run() { return RunLights(options); }
};

struct CompareCommand {
  CompareOptions options;
  std::vector<std::string> times;
  std::string resolution, referenceTime;
  bool fast = false;

  void Define(CLI::App& app) {
    app.add_option("scene", options.scene, "The scene: a pbrt-v4 file (.pbrt, .pbrt.gz)")
        ->type_name("FILE")
        ->required();
    app.add_option("-o,--output", options.output,
                   "The folder for results.csv, results.json, report.html and the reference; default: SCENE-compare")
        ->type_name("FOLDER");
    app.add_option(
           "--integrators", options.integrators,
           "Which to compare, e.g. path,auto (path,bdpt); path:shadow-threshold=0.01 is one with a setting changed, "
           "path:denoise is one that is denoised")
        ->type_name("NAME,…")
        ->delimiter(',')
        ->allow_extra_args(false);
    app.add_option("--budget", times, "Times to compare at, e.g. 5s,20s,80s (1s,4s,16s)")
        ->type_name("DURATION,…")
        ->delimiter(',')
        ->allow_extra_args(false);
    app.add_option("--spp", options.sampleCounts, "Samples per pixel to compare at, e.g. 4,16,64")
        ->type_name("N,…")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->check(CLI::Range(1, 1 << 30));
    app.add_option("--repeat", options.repeats, "Renders with other seeds that the intervals come from (5)")
        ->check(CLI::Range(2, 1000));
    app.add_option("--reference", options.reference,
                   "An image to measure against; default: made, and kept in the folder")
        ->type_name("FILE");
    app.add_option("--reference-time", referenceTime,
                   "Time to make the reference in; default: ten times the longest render")
        ->type_name("DURATION");
    app.add_option("--exposure", options.exposure, "Exposure of the pictures in stops (0)")->check(CheckFinite, "");
    DefineSceneOptions(app, options.overrides, resolution, options.threads);
    DefinePluginOption(app, options.plugins);
    app.add_flag("--cpu-time", options.ofProcessor,
                 "Times are those of the processor, over the threads, which other work on the machine changes little");
    app.add_flag("--quiet", options.quiet, "No progress and no tables");
    app.add_flag("--strict", options.strict, "Warnings about the scene are errors");
    app.add_flag("--fast-intersection", fast,
                 "Trade watertight intersection for speed: rays may slip through shared edges");
  }

  // The command as it was typed, for the report.
  void Remember(int argc, char** argv) {
    options.command = "lampyr";
    for (int i = 1; i < argc; ++i) options.command += std::string(" ") + argv[i];
  }
  int Run() {
    for (const std::string& time : times) options.times.push_back(ParseDuration("--budget", time));
    if (!referenceTime.empty()) options.referenceSeconds = ParseDuration("--reference-time", referenceTime);
    if (!resolution.empty()) ParseResolution(resolution, options.overrides);
    options.robust = !fast;
    return RunCompare(options);
  }
};

}  // namespace

namespace {

// The arguments in the form that CLI11 expects: "lampyr SCENE.pbrt …" renders, and "lampyr help COMMAND" prints the
// help of the command. Throws a UsageError for an unknown command.
std::vector<std::string> CommandWords(const CLI::App& app, int argc, char** argv) {
  std::vector<std::string> words(argv + 1, argv + argc);
  if (words.empty()) return {"--help"};
  std::vector<std::string> commands = {"help"};
  for (const CLI::App* command : app.get_subcommands({})) commands.push_back(command->get_name());
  const auto isCommand = [&](const std::string& word) {
    return std::find(commands.begin(), commands.end(), word) != commands.end();
  };
  std::string& first = words.front();
  if (first == "help") {
    words.erase(words.begin());
    if (!words.empty() && !isCommand(words.front()))
      throw UsageError("there is no command \"" + words.front() + "\"" + DidYouMean(words.front(), commands));
    words.resize(std::min<size_t>(words.size(), 1));
    words.push_back("--help");
    return words;
  }
  if (first.starts_with("-") || isCommand(first)) return words;
  const bool isScene = first.ends_with(".pbrt") || first.ends_with(".pbrt.gz") || std::filesystem::exists(first);
  if (!isScene) {
    std::string all;
    for (const std::string& command : commands) all += (all.empty() ? "" : ", ") + command;
    throw UsageError("there is no command \"" + first + "\"" + DidYouMean(first, commands) + "; there are: " + all +
                     "; or name a scene to render, SCENE.pbrt");
  }
  words.insert(words.begin(), "render");
  return words;
}

// Prints a parse error as `error: …` and returns the exit code. An unknown option is named with the nearest known one.
int ReportParseError(const CLI::App& app, const CLI::ParseError& error) {
  const std::vector<CLI::App*> parsed = app.get_subcommands();
  const CLI::App& command = parsed.empty() ? app : *parsed.front();
  std::string text = error.what();
  const std::vector<std::string> extras = app.remaining(true);
  if (dynamic_cast<const CLI::ExtrasError*>(&error) && !extras.empty()) {
    std::vector<std::string> known;
    for (const CLI::Option* option : command.get_options()) {
      for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
    }
    const std::string given = extras.front().substr(0, extras.front().find('='));
    text = given.starts_with("-") ? "there is no option \"" + given + "\"" + DidYouMean(given, known)
                                  : "\"" + given + "\" is one word too many";
  }
  const std::string name = parsed.empty() ? "" : " " + command.get_name();
  std::fprintf(stderr, "error: %s; `lampyr%s --help` lists the options\n", text.c_str(), name.c_str());
  return kExitUsage;
}

// The commands and the options that each one parses.
class Commands {
 public:
  Commands(CLI::App& app, int argc, char** argv) : app_(app) {
    compare_.Remember(argc, argv);
    Add("render", "Render a scene to an EXR image", render_);
    Add("compare", "Measure integrators against each other: error by time and by samples", compare_);
    Add("merge", "Make one image of the parts of a render", merge_);
    Add("plan", "What a scene requires, and what is therefore modelled, with reasons", plan_);
    Add("diff", "Compare two images: MSE, relMSE, FLIP, bias, z-test by blocks", diff_);
    Add("mix", "Dim, tint or turn off lights in a finished picture with layers", mix_);
    Add("desk", "Light a scene in the browser: faders, colours and parameters of lights while it renders", desk_);
    Add("denoise", "Denoise an image; its variance then tells the error of the result", denoise_);
    Add("png", "Make a PNG to look at of an image", png_);
    Add("check-lights",
        "Prove the densities of lights, and light filters: of every type, a plugin's, or a scene's lights. What fails "
        "is named, with what that means and where it was worst",
        checkLights_);
    Add("lights", "The types of light and of light filter, and their parameters", lights_);
  }

  // Runs the command that was parsed.
  int Run() {
    const auto parsed = std::find_if(runs_.begin(), runs_.end(), [](const auto& run) { return run.first->parsed(); });
    // Rejected, because an empty word, as from a shell variable that is not set, would have the effect of no option.
    for (const CLI::Option* option : parsed->first->get_options()) {
      const std::vector<std::string>& words = option->results();
      if (std::find(words.begin(), words.end(), "") != words.end())
        throw UsageError(option->get_name() + ": its value is empty");
    }
    return parsed->second();
  }

 private:
  template <class Command>
  void Add(const char* name, const char* help, Command& command) {
    CLI::App* subcommand = app_.add_subcommand(name, help);
    command.Define(*subcommand);
    runs_.emplace_back(subcommand, [&command] { return command.Run(); });
  }

  CLI::App& app_;
  RenderCommand render_;
  CompareCommand compare_;
  MergeCommand merge_;
  PlanCommand plan_;
  DiffCommand diff_;
  MixCommand mix_;
  DeskCommand desk_;
  DenoiseCommand denoise_;
  PngCommand png_;
  CheckLightsCommand checkLights_;
  LightsCommand lights_;
  std::vector<std::pair<CLI::App*, std::function<int()>>> runs_;
};

int ParseAndRun(int argc, char** argv) {
  CLI::App app("lampyr: a renderer whose subject is the light", "lampyr");
  app.set_version_flag("--version", std::string("lampyr ") + kVersion);
  app.require_subcommand(1);
  const auto formatter = std::make_shared<HelpFormatter>();
  for (const auto& [name, shown] :
       {std::pair("INT", "N"), std::pair("UINT", "N"), std::pair("FLOAT", "X"), std::pair("TEXT", "NAME")})
    formatter->label(name, shown);
  app.formatter(formatter);
  Commands commands(app, argc, argv);
  try {
    std::vector<std::string> words = CommandWords(app, argc, argv);
    std::reverse(words.begin(), words.end());  // the order in which CLI11 takes them
    app.parse(std::move(words));
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != 0) return ReportParseError(app, error);
    app.exit(error);
    return kExitDone;
  }
  return commands.Run();
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
  } catch (const std::exception& error) {  // from a library or the system
    std::fprintf(stderr, "error: %s\n", error.what());
    return kExitFailed;
  }
}

}  // namespace lampyr
