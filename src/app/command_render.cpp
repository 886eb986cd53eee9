#include <algorithm>
#include <cmath>
#include <cstdio>

#include "app/command_line.h"
#include "app/command_support.h"
#include "app/commands.h"
#include "app/integrator_hints.h"
#include "app/json_report.h"
#include "app/render_run.h"
#include "app/unseen_samples.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "base/version.h"

namespace lampyr {

namespace {

std::filesystem::path OutputPath(const RenderOptions& options, const RenderSettings& settings) {
  std::filesystem::path path;
  if (options.output) {
    path = *options.output;
  } else {
    path = settings.outputFile.empty() ? options.scene.stem() : std::filesystem::path(settings.outputFile).filename();
    path.replace_extension(".exr");
  }
  if (path.extension() != ".exr") {
    throw UsageError("--output: \"" + path.string() + "\" must end in .exr (--png writes a PNG beside it)");
  }
  CheckWritable(path, "--output");
  if (options.png) CheckWritable(std::filesystem::path(path).replace_extension(".png"), "--png");
  return path;
}

// An image too large for the machine is told before the system ends the process for it.
void CheckMemory(const RenderSettings& settings, size_t layers, bool hasTechniques) {
  const uint64_t channels = 6 + 3 * layers;  // of the developed image: colour, variance and layers
  const uint64_t techniques = hasTechniques ? TechniqueImages::BytesPerPixel(settings.maxDepth) : 0;
  const uint64_t perPixel =
      Film::BytesPerPixel(layers, settings.integrator != "path") + techniques + 2 * channels * sizeof(float);
  const uint64_t needed = perPixel * settings.crop.Width() * settings.crop.Height();
  const uint64_t available = AvailableMemory();
  if (needed <= available) return;
  const auto gibibytes = [](uint64_t bytes) { return std::to_string((bytes >> 30) + 1) + " GiB"; };
  throw UsageError("an image of " + std::to_string(settings.crop.Width()) + "×" +
                   std::to_string(settings.crop.Height()) + " pixels takes " + gibibytes(needed) +
                   " of memory and there are " + gibibytes(available) + ": render it in parts with --crop");
}

std::string Percent(double fraction) {
  if (!std::isfinite(fraction)) return "unknown";
  char text[32];
  std::snprintf(text, sizeof text, "%.2g %%", 100 * fraction);
  return text;
}

std::string Joined(const std::vector<std::string>& names, const char* separator) {
  std::string all;
  for (const std::string& name : names) all += (all.empty() ? "" : separator) + name;
  return all;
}

Image DevelopWithMetadata(const Film& film, const RenderReport& report) {
  Image image = film.Develop();
  image.metadata = {{"lampyr.version", kVersion},
                    {"lampyr.sceneHash", report.sceneHash},
                    {"lampyr.integrator", report.integrator},
                    {"lampyr.samplesPerPixel", std::to_string(report.outcome.samplesPerPixel)},
                    {"lampyr.seed", std::to_string(report.seed)}};
  if (!report.lightGroups.empty()) image.metadata["lampyr.lightGroups"] = Joined(report.lightGroups, ",");
  return image;
}

// Halves end at 65504: an image that is brighter is kept in floats.
ExrPrecision PrecisionFor(const Image& image, const RenderSettings& settings) {
  constexpr float largestHalf = 65504;
  const bool fits =
      std::all_of(image.data.begin(), image.data.end(), [](float v) { return std::abs(v) <= largestHalf; });
  return settings.halfPrecision && fits ? ExrPrecision::Half : ExrPrecision::Float;
}

void PrintSummary(const RenderReport& report, const std::filesystem::path& path) {
  const RenderOutcome& outcome = report.outcome;
  std::fprintf(stderr, "%s: %d×%d, %d spp, %s, %.2f Mray/s, relative error %s (95 %%)\n", path.c_str(), report.width,
               report.height, outcome.samplesPerPixel, FormatDuration(outcome.seconds).c_str(),
               static_cast<double>(outcome.counts.Rays()) / (1e6 * std::max(outcome.seconds, 1e-9)),
               Percent(outcome.relativeError).c_str());
  if (outcome.counts.droppedSamples > 0 || report.rejectedRays > 0) {
    std::fprintf(stderr, "warning: %llu samples were dropped (not finite or negative) and %llu rays rejected\n",
                 static_cast<unsigned long long>(outcome.counts.droppedSamples),
                 static_cast<unsigned long long>(report.rejectedRays));
  }
}

StopConditions MakeStopConditions(const RenderOptions& options, const RenderSettings& settings) {
  StopConditions stop;
  stop.samplesPerPixel = settings.samplesPerPixel;
  // Asked to stop by time or error only: the scene's own sample count does not matter.
  if ((options.seconds || options.targetError) && !options.overrides.samplesPerPixel) stop.samplesPerPixel = 1 << 30;
  stop.seconds = options.seconds;
  stop.relativeError = options.targetError;
  return stop;
}

void WritePngOf(const Image& image, std::filesystem::path path, const RenderOptions& options) {
  WritePng(path.replace_extension(".png"), image, options.exposure, options.clipPng ? ToneMap::Clip : ToneMap::Filmic);
}

// weighted-s2-t3.exr, unweighted-s2-t3.exr, … in the folder, which is made.
void WriteTechniques(const RenderOptions& options, const std::vector<TechniqueImages::Picture>& pictures) {
  const std::filesystem::path& folder = *options.strategyImages;
  for (const TechniqueImages::Picture& picture : pictures) {
    for (const bool isWeighted : {true, false}) {
      const Image& image = isWeighted ? picture.weighted : picture.unweighted;
      const std::filesystem::path path = folder / ((isWeighted ? "weighted-" : "unweighted-") + picture.name + ".exr");
      WriteExr(path, image, ExrPrecision::Float);
      if (options.png) WritePngOf(image, path, options);
    }
  }
}

int RenderLoaded(const RenderOptions& options, const LoadedScene& loaded) {
  RenderReport report;
  const BuiltScene& built = loaded.built;
  const RenderSettings& settings = built.settings;
  const std::filesystem::path path = OutputPath(options, settings);
  if (options.stats) CheckWritable(*options.stats, "--stats");
  const std::vector<std::string>& layers = built.scene.lighting->Groups().Layers();
  CheckMemory(settings, layers.size(), options.strategyImages.has_value());

  report.scene = options.scene.string();
  report.sceneHash = loaded.hash;
  report.parseSeconds = loaded.parseSeconds;
  report.buildSeconds = loaded.buildSeconds;
  report.integrator = settings.integrator;
  report.seed = settings.seed;
  report.threads = options.threads > 0 ? options.threads : HardwareThreads();
  report.width = settings.width;
  report.height = settings.height;
  report.pixels = static_cast<int64_t>(settings.crop.Width()) * settings.crop.Height();
  report.primitives = built.scene.geometry->PrimitiveCount();
  report.lights = built.scene.lighting->Lights().size();
  report.lightGroups = layers;

  const AnyIntegrator integrator = MakeIntegrator(built.scene, settings);
  Film film(settings.width, settings.height, settings.crop, layers);
  std::unique_ptr<TechniqueImages> techniques;
  if (options.strategyImages) {
    if (settings.integrator != "bdpt")
      throw UsageError("--strategy-images: only bdpt has strategies; the integrator is " + settings.integrator);
    MakeFolder(*options.strategyImages, "--strategy-images");
    techniques = std::make_unique<TechniqueImages>(settings.width, settings.height, settings.crop, settings.maxDepth,
                                                   settings.imagingRatio);
  }
  if (!options.quiet) {
    for (const std::string& hint : IntegratorHints(built.scene, settings.integrator))
      std::fprintf(stderr, "hint: %s\n", hint.c_str());
  }
  StopConditions stop = MakeStopConditions(options, settings);
  stop.largestSample = LargestUnseenSample(built.scene, settings);
  stop.interrupted = &FinishOnInterrupt();
  {
    Progress progress(options.quiet);
    const auto afterPass = [&](const RenderOutcome& soFar, double fraction) {
      progress.Update(fraction, std::to_string(soFar.samplesPerPixel) + " spp, error " + Percent(soFar.relativeError));
    };
    report.outcome = Render(built.scene, integrator, settings, stop, report.threads, film, afterPass, techniques.get());
  }
  report.rejectedRays = built.scene.geometry->RejectedRays();

  const Progress clock(true);
  const Image image = DevelopWithMetadata(film, report);
  if (techniques) WriteTechniques(options, techniques->Develop(film));
  WriteExr(path, image, PrecisionFor(image, settings));
  if (options.png) {
    WritePngOf(image, path, options);
  }
  report.writeSeconds = clock.Seconds();
  if (options.stats) WriteText(*options.stats, ToJson(report));
  if (!options.quiet) PrintSummary(report, path);
  return report.outcome.interrupted ? kExitInterrupted : kExitDone;
}

}  // namespace

int RunRender(const RenderOptions& options) {
  OutliveReaders();
  const LoadedScene loaded =
      LoadScene(options.scene, options.plugins, options.overrides, options.strict, options.robust);
  int exitCode = kExitFailed;
  RunForeignCode(loaded.types, [&] { exitCode = RenderLoaded(options, loaded); });
  return exitCode;
}

}  // namespace lampyr
