#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <utility>

#include "app/command_line.h"
#include "app/command_support.h"
#include "app/commands.h"
#include "app/denoise_support.h"
#include "app/json_report.h"
#include "app/preview.h"
#include "app/render_checks.h"
#include "app/render_files.h"
#include "app/tev_display.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "render/analysis/plan.h"
#include "render/analysis/unseen_samples.h"
#include "render/build/invalid_light.h"
#include "render/checkpoints.h"
#include "render/feature_layers.h"
#include "render/first_hit_layers.h"
#include "render/load_scene.h"
#include "render/output_files.h"
#include "render/progressive_render.h"
#include "render/render_part.h"
#include "render/sample_image.h"
#include "render/settings/integrator_choice.h"

namespace lampyr {

namespace {

// True if the render's state is written for another process, which needs to identify the render.
bool KeepsState(const RenderOptions& options) {
  return options.shard || options.resume || options.checkpointSeconds;
}

std::string DescribeError(const RenderOutcome& outcome, const RenderOptions& options) {
  if (!outcome.pixelError) {
    const bool hasBias = outcome.parts && outcome.parts->bias > 0;
    return "error " + FormatPercent(outcome.relativeError) +
           (hasBias ? ", of which bias " + FormatPercent(outcome.parts->bias) : "");
  }
  return "error " + FormatPercent(*outcome.pixelError) + " in " + FormatPercent(*options.pixelShare) + " of the pixels";
}

// `rendered`: the part of the image that the picture shows.
void PrintSummary(const RenderReport& report, const PixelRect& rendered, const std::filesystem::path& path,
                  const RenderOptions& options) {
  const RenderOutcome& outcome = report.outcome;
  std::fprintf(stderr, "%s: %d×%d, %d spp, %s, %.2f Mray/s, relative %s (95 %%)\n", path.c_str(), rendered.Width(),
               rendered.Height(), outcome.samplesPerPixel, FormatDuration(outcome.seconds).c_str(),
               static_cast<double>(outcome.counts.Rays()) / (1e6 * std::max(outcome.seconds, 1e-9)),
               DescribeError(outcome, options).c_str());
  if (report.rejectedRays > 0) {
    std::fprintf(stderr, "warning: %llu rays were rejected (not finite)\n",
                 static_cast<unsigned long long>(report.rejectedRays));
  }
}

// Report of dropped samples and photons.
struct DroppedReport {
  FileLocation where;
  std::string text;  // "": none
};
DroppedReport DescribeDropped(const RenderOutcome& outcome, const BuiltScene& built) {
  DroppedReport report;
  const uint64_t photons = outcome.photons ? outcome.photons->rejected : 0;
  const uint64_t samples = outcome.counts.droppedSamples;
  if (samples + photons == 0) return report;
  report.text = samples > 0 ? std::to_string(samples) + " samples" : "";
  if (photons > 0) report.text += (samples > 0 ? " and " : "") + std::to_string(photons) + " photons";
  report.text += " were dropped";
  if (const std::optional<InvalidLight> invalid = FindInvalidLight(built)) {
    report.where = invalid->where;
    report.text = invalid->text + ": " + report.text;
  } else {
    report.text += " (not finite or negative)";
  }
  if (outcome.droppedFraction > kMostDropped) report.text += ": the picture is wrong, and its error is unknown";
  return report;
}

// Describes a picture that has less than one sample per pixel: the completed fraction of the first sample.
std::string DescribePartialPicture(const RenderOptions& options, const Film& film, const RenderSettings& settings,
                                   TracedPaths paths) {
  if (options.shard) return "the part holds no samples";
  if (paths != TracedPaths::Light) {
    return "the picture is a part of the first sample: " + FormatPercent(film.SampledFraction()) +
           " of its pixels have it, the others are black";
  }
  const double whole = static_cast<double>(settings.width) * static_cast<double>(settings.height);
  return "the picture is made of " + FormatPercent(static_cast<double>(film.LightPaths()) / whole) +
         " of the light paths of the first sample";
}

StopConditions MakeStopConditions(const RenderOptions& options, const Shard& shard) {
  StopConditions stop;
  stop.samplesPerPixel = static_cast<int>(shard.end - shard.first);
  stop.seconds = options.seconds;
  stop.longestPass = options.checkpointSeconds;
  if (options.previewSeconds)
    stop.longestPass = std::min(*options.previewSeconds, stop.longestPass.value_or(*options.previewSeconds));
  constexpr double kLongestShown = 1;  // with a viewer, seconds
  if (options.display) stop.longestPass = std::min(kLongestShown, stop.longestPass.value_or(kLongestShown));
  stop.relativeError = options.targetError;
  stop.pixelShare = options.pixelShare;
  return stop;
}

// Layers of strategies require all techniques, once for each sample.
RenderSettings SettingsFor(RenderSettings settings) {
  if (settings.strategies) settings.counts.reset();
  return settings;
}

// One render, from the scene to its files.
class RenderJob {
 public:
  RenderJob(const RenderOptions& options, const LoadedScene& loaded);
  // The exit code.
  int Run();

 private:
  void Describe();
  void PrintHints() const;
  void MakeFirstHitLayers();
  void MakeFeatureLayers();
  void AddLayers(Image layers);
  void DenoisePicture() const;
  void GoOn(ProgressiveRender& render);
  void Trace(ProgressiveRender& render, Checkpoints* checkpoints);
  int Finish(ProgressiveRender& render, Checkpoints* checkpoints);
  int ExitCode(const std::string& partialPicture) const;

  const RenderOptions& options_;
  const LoadedScene& loaded_;
  const BuiltScene& built_;
  const RenderSettings settings_;
  const std::filesystem::path path_, checkpointPath_;
  std::unique_ptr<Integrator> integrator_;
  Shard shard_;
  PartHeader header_;
  Image layers_;  // first-hit layers, features, and decisions of auto; without channels if none are wanted
  RenderReport report_;
};

RenderJob::RenderJob(const RenderOptions& options, const LoadedScene& loaded)
    : options_(options),
      loaded_(loaded),
      built_(loaded.built),
      settings_(SettingsFor(built_.settings)),
      path_(OutputPath(options, settings_)),
      checkpointPath_(CheckpointPath(path_)) {
  CheckOptions(options, settings_, checkpointPath_);
  integrator_ = MakeIntegrator(built_.scene, settings_);
  CheckRenderMemory(settings_, *integrator_, built_.FilmLayers().size(), options.denoise);
  if (const auto photons = integrator_->Photons(); photons && !options.quiet) WarnOfPhotonMemory(settings_, *photons);
  const auto [part, parts] = options.shard.value_or(std::pair(1, 1));
  shard_ = ShardOf(part, parts, SamplesWanted(options, settings_));
  header_ = MakeHeader(options, loaded, shard_);
  const bool sharesPhotons = integrator_->Photons().has_value();
  if (settings_.adaptive && integrator_->Paths() == TracedPaths::Light)
    throw UsageError("--adaptive: " + settings_.integrator +
                     " follows no camera paths, whose number could differ from pixel to pixel; use --no-adaptive, or "
                     "another integrator");
  header_.isAdaptive = settings_.adaptive.has_value();
  header_.hasGroups = header_.isAdaptive && sharesPhotons;
  Describe();
}

void RenderJob::Describe() {
  report_.scene = options_.scene.string();
  report_.sceneHash = loaded_.hash;
  report_.parseSeconds = loaded_.parseSeconds;
  report_.buildSeconds = loaded_.buildSeconds;
  report_.integrator = settings_.integrator;
  if (settings_.counts)
    report_.decided = settings_.counts->Mean(CountedTechniquesOf(settings_.integrator, settings_.values));
  for (const Setting* setting : IntegratorOf(settings_.integrator).settings)
    report_.settings.emplace_back(setting->name, settings_.values.Value(setting->name));
  report_.seed = settings_.seed;
  report_.threads = options_.threads > 0 ? options_.threads : HardwareThreads();
  report_.width = settings_.width;
  report_.height = settings_.height;
  report_.pixels = static_cast<int64_t>(settings_.crop.Width()) * settings_.crop.Height();
  report_.primitives = built_.scene.geometry->PrimitiveCount();
  report_.lights = built_.scene.lighting->Lights().size();
  report_.lightGroups = built_.scene.lighting->Groups().Layers();
  for (const OutputLayer& layer : built_.scene.outputs->Layers()) {
    if (!layer.text.empty()) report_.layers.emplace_back(layer.name, layer.text);
  }
}

void RenderJob::GoOn(ProgressiveRender& render) {
  if (std::filesystem::exists(checkpointPath_)) {
    ResumeFrom(checkpointPath_, header_, render);
    report_.resumedSamples = render.Outcome().samplesPerPixel;
    if (!options_.quiet)
      std::fprintf(stderr, "%s: goes on after %d spp\n", checkpointPath_.c_str(), report_.resumedSamples);
  } else if (!options_.quiet) {
    std::fprintf(stderr, "there is no \"%s\" to go on with: starts anew\n", checkpointPath_.c_str());
  }
}

void RenderJob::Trace(ProgressiveRender& render, Checkpoints* checkpoints) {
  StopConditions stop = MakeStopConditions(options_, shard_);
  stop.largestSample = LargestUnseenSample(built_.scene, settings_);
  stop.interrupted = &FinishOnInterrupt();
  Progress progress(options_.quiet);
  std::optional<Preview> preview;
  if (options_.previewSeconds) {
    preview.emplace(std::filesystem::path(path_).replace_extension(".png"), *options_.previewSeconds, options_.exposure,
                    options_.clipPng ? ToneMap::Clip : ToneMap::Filmic, options_.quiet);
  }
  std::optional<TevDisplay> display;
  if (options_.display) display.emplace(*options_.display, path_.filename().string());
  const auto afterPass = [&](const RenderOutcome& soFar, double fraction) {
    if (display) display->MayShow(render, soFar.seconds, progress);
    if (preview) preview->MayShow(render, soFar.seconds, progress);
    progress.Update(fraction, std::to_string(soFar.samplesPerPixel) + " spp, " + DescribeError(soFar, options_));
    if (checkpoints) checkpoints->MayWrite(soFar);
  };
  report_.outcome = Continue(render, stop, afterPass);
  if (display) display->Show(render.Picture(), progress);
}

void RenderJob::PrintHints() const {
  for (const std::string& hint : IntegratorHints(built_.scene, settings_.integrator))
    std::fprintf(stderr, "hint: %s\n", hint.c_str());
  const std::string named = options_.overrides.integrator.value_or(settings_.namedIntegrator);
  if (!named.empty() && !IsAuto(named))
    for (const std::string& line : SettingsWithoutEffect(named, options_.overrides.values))
      std::fprintf(stderr, "hint: %s\n", line.c_str());
  if (options_.overrides.integrator || settings_.namedIntegrator.empty()) return;
  if (options_.shard || options_.resume) return;
  IntegratorChoice suits;
  try {
    RunForeignCode(loaded_.types, [&] { suits = ChooseIntegrator(built_.scene, settings_, report_.threads); });
  } catch (const Error&) {
    return;  // of a light that the render may not even use
  }
  constexpr double kWorthTelling = 1.1;
  if (suits.decision.choice == settings_.namedIntegrator && suits.gainOfCounts < kWorthTelling) return;
  std::fprintf(stderr, "hint: the scene names %s; --integrator auto would render with %s: %s\n",
               settings_.namedIntegrator.c_str(), suits.decision.choice.c_str(), suits.decision.reason.c_str());
}

void RenderJob::AddLayers(Image layers) {
  if (layers_.channels.empty()) {
    layers_ = std::move(layers);
  } else {
    AppendChannels(layers_, layers);
  }
}

void RenderJob::MakeFirstHitLayers() {
  Image layers;
  RunForeignCode(loaded_.types, [&] { layers = FirstHitLayers(built_, report_.threads, FinishOnInterrupt()); });
  if (layers.channels.empty()) {
    std::fprintf(stderr,
                 "warning: stopped before the layers of what is seen first were made: the picture is without them\n");
    return;
  }
  AddLayers(std::move(layers));
}

void RenderJob::MakeFeatureLayers() {
  Image layers;
  RunForeignCode(loaded_.types, [&] { layers = FeatureLayers(built_, report_.threads, FinishOnInterrupt()); });
  if (layers.channels.empty()) {
    std::fprintf(stderr, "warning: stopped before the features for denoising were made: the picture is without them\n");
    return;
  }
  AddLayers(std::move(layers));
}

// Denoises the picture that was written.
void RenderJob::DenoisePicture() const {
  const Image noisy = ReadImage(path_);
  if (IsOfOneSample(noisy)) {
    std::fprintf(stderr, "warning: not denoised: one sample per pixel has no known variance\n");
    return;
  }
  const Image image = DenoiseForUser(noisy, report_.threads, FinishOnInterrupt(), options_.quiet);
  if (image.channels.empty()) {
    std::fprintf(stderr, "warning: interrupted: \"%s\" is not denoised; `lampyr denoise` does it\n", path_.c_str());
    return;
  }
  WriteExr(path_, image, settings_.halfPrecision ? ExrPrecision::Half : ExrPrecision::Float);
  if (options_.png) WritePngBeside(path_, image, options_.exposure, options_.clipPng);
}

int RenderJob::Run() {
  auto lock = std::make_unique<OutputLock>(path_);
  Film film = header_.MakeFilm();
  if (!options_.quiet) PrintHints();
  if (settings_.WantsFirstHit()) MakeFirstHitLayers();
  if (options_.denoise) MakeFeatureLayers();
  if (options_.autoLayers) AddLayers(AutoLayers(settings_));
  ProgressiveRender render(built_.scene, *integrator_, settings_, report_.threads, film, shard_.first);
  if (options_.resume) GoOn(render);
  std::optional<Checkpoints> checkpoints;
  if (options_.checkpointSeconds) {
    checkpoints.emplace(checkpointPath_, *options_.checkpointSeconds, header_, render, [&](const RenderOutcome& soFar) {
      RenderOutcome unfinished = soFar;
      unfinished.interrupted = true;
      WriteImage(path_, options_, header_, film, layers_, unfinished);
    });
  }
  Checkpoints* const written = checkpoints ? &*checkpoints : nullptr;
  Trace(render, written);
  report_.rejectedRays = built_.scene.geometry->RejectedRays();
  return FinishRendering([&] {
    const std::unique_ptr<OutputLock> held = std::move(lock);
    return Finish(render, written);
  });
}

// Writes the results of the render.
int RenderJob::Finish(ProgressiveRender& render, Checkpoints* checkpoints) {
  const Progress clock(true);
  const Film& film = render.Picture();
  const bool isPartial = report_.outcome.isPartial;
  const std::string partialPicture =
      isPartial ? DescribePartialPicture(options_, film, settings_, integrator_->Paths()) : "";
  // The sums in the image of a part require whole samples.
  if (options_.shard) render.DropPartialPass();
  Outputs outputs;
  outputs.Write([&] { WriteImageOrKeepIt(path_, options_, header_, film, layers_, report_.outcome); });
  const bool isWritten = !outputs.HasFailed();
  if (options_.strategyImages) outputs.Write([&] { WriteStrategies(options_, settings_, film.Develop()); });
  if (options_.png || options_.previewSeconds)
    outputs.Write([&] { WritePngBeside(path_, film.Develop(), options_.exposure, options_.clipPng); });
  if (options_.denoise && !options_.shard && !isPartial && isWritten) outputs.Write([&] { DenoisePicture(); });
  render.DropPartialPass();
  if (checkpoints) outputs.Write([&] { checkpoints->Finish(report_.outcome); });
  report_.writeSeconds = clock.Seconds();
  if (settings_.adaptive) {
    report_.adaptive = RenderReport::Adaptive{settings_.adaptive->share, film.Samples(0), film.Samples(0)};
    for (size_t i = 0; i < film.Pixels(); ++i) {
      report_.adaptive->fewestSamples = std::min(report_.adaptive->fewestSamples, film.Samples(i));
      report_.adaptive->mostSamples = std::max(report_.adaptive->mostSamples, film.Samples(i));
    }
  }
  if (options_.stats) outputs.Write([&] { WriteText(*options_.stats, ToJson(report_)); });
  if (!options_.quiet) PrintSummary(report_, settings_.crop, path_, options_);
  outputs.ThrowFailure();
  return ExitCode(partialPicture);
}

// `partialPicture`: description of a picture with less than one sample per pixel.
int RenderJob::ExitCode(const std::string& partialPicture) const {
  const RenderOutcome& outcome = report_.outcome;
  const DroppedReport dropped = DescribeDropped(outcome, built_);
  const bool isWrong = outcome.droppedFraction > kMostDropped && !outcome.interrupted;
  if (isWrong) throw Error(dropped.where, dropped.text);
  const auto rays = static_cast<double>(outcome.counts.Rays());
  if (static_cast<double>(report_.rejectedRays) > kMostDropped * rays && !outcome.interrupted)
    throw Error(std::to_string(report_.rejectedRays) +
                " rays were rejected (not finite): the picture is wrong, and its error is unknown");
  if (!dropped.text.empty() && !options_.quiet) {
    const std::string where = dropped.where.ToString();
    std::fprintf(stderr, "%s%swarning: %s\n", where.c_str(), where.empty() ? "" : ": ", dropped.text.c_str());
  }
  if (outcome.interrupted) {
    if (outcome.isPartial && !options_.quiet)
      std::fprintf(stderr, "warning: interrupted: %s\n", partialPicture.c_str());
    return InterruptExitCode();
  }
  if (outcome.isPartial) throw Error("no sample of every pixel was done in the time (--time): " + partialPicture);
  return kExitDone;
}

}  // namespace

int RunRender(const RenderOptions& options) {
  OutliveSurroundings();
  RenderOverrides overrides = options.overrides;
  overrides.threads = options.threads;
  if (options.strategyImages) overrides.layers.emplace_back(kStrategies);
  const LoadedScene loaded = LoadScene(
      options.scene, options.plugins, overrides, options.strict, options.robust, KeepsState(options),
      [&](const SceneDescription& scene, const RenderSettings& settings) { CheckOutputs(options, scene, settings); });
  int exitCode = kExitFailed;
  RunForeignCode(loaded.types, [&] { exitCode = RenderJob(options, loaded).Run(); });
  return exitCode;
}

}  // namespace lampyr
