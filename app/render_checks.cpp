#include "app/render_checks.h"

#include <algorithm>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "app/command_support.h"
#include "base/memory.h"
#include "film/film.h"
#include "integrators/photon/photon_store.h"
#include "render/checkpoints.h"
#include "render/feature_layers.h"
#include "render/first_hit_layers.h"
#include "render/output_files.h"
#include "render/sample_image.h"
#include "render/settings/integrator_choice.h"
#include "scene/referenced_files.h"

namespace lampyr {

std::filesystem::path OutputPath(const RenderOptions& options, const RenderSettings& settings) {
  std::filesystem::path path;
  if (options.output) {
    path = *options.output;
  } else {
    path =
        settings.outputFile.empty() ? options.scene.filename() : std::filesystem::path(settings.outputFile).filename();
    // Only known extensions are removed: the number of frame.0001 is part of the name.
    if (path.extension() == ".gz") path.replace_extension();
    if (path.extension() == ".pbrt" || IsPictureEnding(path.extension().string())) path.replace_extension();
    if (options.shard)
      path += "." + std::to_string(options.shard->first) + "-of-" + std::to_string(options.shard->second);
    path += ".exr";
  }
  CheckImageOutput(path, "--output", options.png || options.previewSeconds);
  return path;
}

void CheckOutputs(const RenderOptions& options, const SceneDescription& scene, const RenderSettings& settings) {
  const std::filesystem::path image = OutputPath(options, settings);
  std::vector<std::pair<std::filesystem::path, const char*>> written = {{image, "--output"}};
  if (options.png || options.previewSeconds)
    written.emplace_back(std::filesystem::path(image).replace_extension(".png"), options.png ? "--png" : "--preview");
  if (options.stats) written.emplace_back(*options.stats, "--stats");
  if (options.checkpointSeconds) written.emplace_back(CheckpointPath(image), "--checkpoint");
  for (size_t i = 0; i < written.size(); ++i) {
    for (size_t k = 0; k < i; ++k) {
      if (!WouldBeSameFile(written[i].first, written[k].first)) continue;
      throw UsageError(std::string(written[i].second) + ": \"" + written[i].first.string() + "\" is what " +
                       written[k].second + " writes; write to another file");
    }
  }
  std::erase_if(written, [](const auto& file) {
    std::error_code ignored;
    return !std::filesystem::exists(file.first, ignored);
  });
  if (written.empty()) return;
  std::vector<std::string> read = ReferencedFiles(scene);
  read.insert(read.end(), scene.files.begin(), scene.files.end());
  for (const auto& [file, option] : written) {
    for (const std::string& part : read) {
      if (!IsSameFile(file, part)) continue;
      throw UsageError(std::string(option) + ": \"" + file.string() + "\" is a file that the scene reads, \"" + part +
                       "\": it would be lost; write to another file");
    }
  }
}

// The film is kept twice (render_backup.h).
void CheckRenderMemory(const RenderSettings& settings, const Integrator& integrator, size_t layers, bool denoises) {
  const bool withSplats = integrator.Paths() != TracedPaths::Camera, merges = integrator.Photons().has_value();
  layers += denoises ? 1 : 0;
  // Developed image: colour, variance, light groups and first-hit layers. The latter are also kept during the render.
  const uint64_t firstHit = FirstHitChannels(settings).size() + (denoises ? FeatureChannels().size() : 0);
  const uint64_t channels = 6 + 3 * layers + 2 * firstHit;
  const uint64_t ofFilm = Film::BytesPerPixel(layers, withSplats, settings.adaptive.has_value(), merges, merges);
  const uint64_t perPixel = 2 * ofFilm + 2 * channels * sizeof(float);
  const uint64_t needed = perPixel * settings.crop.Width() * settings.crop.Height();
  const uint64_t available = AvailableMemory();
  if (needed <= available) return;
  const auto gibibytes = [](uint64_t bytes) { return std::to_string((bytes >> 30) + 1) + " GiB"; };
  throw UsageError("an image of " + std::to_string(settings.crop.Width()) + "×" +
                   std::to_string(settings.crop.Height()) + " pixels takes " + gibibytes(needed) +
                   " of memory and there are " + gibibytes(available) + ": render it in parts with --crop");
}

void WarnOfPhotonMemory(const RenderSettings& settings, const PhotonSettings& photons) {
  const double paths = photons.lightPaths > 0
                           ? static_cast<double>(photons.lightPaths)
                           : static_cast<double>(settings.width) * static_cast<double>(settings.height) *
                                 (settings.counts ? settings.counts->LightPaths() : 1.0);
  const double most = paths * settings.MaxDepth() *
                      static_cast<double>(PhotonStore::BytesPerPhoton(true) + 2 * sizeof(SubpathDensities));
  const double needed = std::min(most, static_cast<double>(photons.mostBytes));
  const auto available = static_cast<double>(AvailableMemory());
  if (needed <= available) return;
  std::fprintf(stderr,
               "warning: the photons of a pass may take %s of memory and there are %s: set a lower limit with "
               "--photon-memory, the same on all machines that share the render\n",
               FormatBytes(needed).c_str(), FormatBytes(available).c_str());
}

int SamplesWanted(const RenderOptions& options, const RenderSettings& settings) {
  // With a stop by time or error alone, the scene's own sample count is ignored.
  const bool isOpen = (options.seconds || options.targetError) && !options.overrides.samplesPerPixel;
  return isOpen ? static_cast<int>(kOpenEnd) : settings.samplesPerPixel;
}

void CheckOptions(const RenderOptions& options, const RenderSettings& settings,
                  const std::filesystem::path& checkpoint) {
  if (options.stats) CheckWritable(*options.stats, "--stats");
  if (options.checkpointSeconds) CheckWritable(checkpoint, "--checkpoint");
  if (options.shard && GathersPhotons(settings) && SamplesWanted(options, settings) == static_cast<int>(kOpenEnd)) {
    throw UsageError("--shard with " + settings.integrator +
                     " needs --spp: each part has the radii of its own samples, whose numbers must be known");
  }
  if (options.autoLayers && settings.strategies)
    throw UsageError("--auto-layers goes without strategies: those are of all techniques, once for each sample");
  if (options.autoLayers && !settings.counts) {
    throw UsageError("--auto-layers: the integrator is named, " + settings.integrator +
                     ": auto decides nothing; --integrator auto lets it decide");
  }
  if (settings.strategies) StrategiesOf(settings);  // rejects an integrator without strategies
  if (!options.strategyImages) return;
  if (options.shard)
    throw UsageError("--strategy-images goes without --shard: with --layer strategies the merged picture has them");
  MakeFolder(*options.strategyImages, "--strategy-images");
}

}  // namespace lampyr
