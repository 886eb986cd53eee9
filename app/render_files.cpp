#include "app/render_files.h"

#include <unistd.h>

#include <algorithm>
#include <string>

#include "app/command_support.h"
#include "app/render_checks.h"
#include "base/version.h"
#include "integrators/registry.h"
#include "render/feature_layers.h"
#include "render/first_hit_layers.h"
#include "render/output_files.h"
#include "render/sample_image.h"
#include "render/settings/integrator_choice.h"

namespace lampyr {

PartHeader MakeHeader(const RenderOptions& options, const LoadedScene& loaded, const Shard& shard) {
  const RenderSettings& settings = loaded.built.settings;
  PartHeader header;
  header.shard = shard;
  header.width = settings.width;
  header.height = settings.height;
  header.crop = settings.crop;
  header.layers = loaded.built.FilmLayers();
  header.halfPrecision = settings.halfPrecision;
  header.metadata = {{"lampyr.version", kVersion},
                     {"lampyr.sceneHash", loaded.hash},
                     {"lampyr.integrator", settings.integrator},
                     {"lampyr.seed", std::to_string(settings.seed)}};
  const std::vector<std::string>& groups = loaded.built.scene.lighting->Groups().Layers();
  if (!groups.empty()) header.metadata["lampyr.lightGroups"] = Joined(groups, ",");
  for (const OutputLayer& layer : loaded.built.scene.outputs->Layers()) {
    if (!layer.text.empty()) header.metadata["lampyr.layer." + layer.name] = layer.text;
  }
  header.metadata[kSplatCountMetadata] = std::to_string(PixelFilter(settings.filter).SplatCount());
  header.metadata.merge(FirstHitMetadata(loaded.built));
  for (const char* layer : {kSamplesLayer, kErrorLayer, kBiasLayer}) {
    if (settings.Wants(layer)) header.metadata[std::string(kSampleLayerMetadata) + layer] = "1";
  }
  if (settings.bands) {
    header.metadata["spectralLayoutVersion"] = "1.0";
    header.metadata["emissiveUnits"] = "W.m^-2.sr^-1";
  }
  if (options.autoLayers) header.metadata[kAutoLayersMetadata] = "yes";
  if (options.denoise) {
    header.layers.emplace_back(kHalfLayer);
    header.metadata[kFeaturesMetadata] = "yes";
  }
  if (options.shard || options.resume || options.checkpointSeconds) {
    header.identity = IdentityOf(loaded, options.robust);
    header.identity.emplace_back("--denoise", options.denoise ? "on" : "off");
  }
  return header;
}

void WriteStrategies(const RenderOptions& options, const RenderSettings& settings, const Image& image) {
  for (const std::string& layer : StrategiesOf(settings).Names()) {
    Image picture = ChannelsOf(image, {layer + ".R", layer + ".G", layer + ".B"});
    picture.channels = {"R", "G", "B"};
    std::string name = layer;
    std::replace(name.begin(), name.end(), '.', '-');
    const std::filesystem::path path = *options.strategyImages / (name + ".exr");
    WriteExr(path, picture, ExrPrecision::Float);
    if (options.png) WritePngBeside(path, picture, options.exposure, options.clipPng);
  }
}

void WriteImage(const std::filesystem::path& path, const RenderOptions& options, const PartHeader& ofAll,
                const Film& film, const Image& layers, const RenderOutcome& outcome) {
  PartHeader header = ofAll;
  header.samples = static_cast<uint32_t>(outcome.samplesPerPixel);
  // Without a wanted number of samples, the picture is complete with those until the stop by time or error.
  const bool isOpen = header.shard.whole == kOpenEnd;
  const bool wasCut = outcome.interrupted || outcome.isPartial;
  header.isFinished = header.samples == header.shard.end - header.shard.first || (isOpen && !wasCut);
  if (!options.shard) {
    WriteSamples(path, header, film, layers);
    return;
  }
  WriteSamples(path, header, film, layers, [&](AtomicFile& file) {
    AppendPart(file, PartKind::Picture, header, [&film](ByteWriter& bytes) { film.Save(bytes); });
  });
}

void WriteImageOrKeepIt(const std::filesystem::path& path, const RenderOptions& options, const PartHeader& header,
                        const Film& film, const Image& layers, const RenderOutcome& outcome) {
  try {
    WriteImage(path, options, header, film, layers, outcome);
  } catch (const Error& error) {
    std::error_code isMissing;  // TMPDIR may name a folder that is gone
    std::filesystem::path folder = std::filesystem::temp_directory_path(isMissing);
    if (isMissing) folder = "/tmp";
    const std::filesystem::path refuge =
        folder / (path.stem().string() + "-" + std::to_string(getpid()) + path.extension().string());
    try {
      WriteImage(refuge, options, header, film, layers, outcome);
    } catch (const Error&) {
      throw error;
    }
    throw Error(error.Text() + "; the picture is kept as \"" + refuge.string() + "\"");
  }
}

Image AutoLayers(const RenderSettings& settings) {
  const TechniqueCounts& counts = *settings.counts;
  const CountedTechniques techniques = CountedTechniquesOf(settings.integrator, settings.values);
  const PixelRect& crop = settings.crop;
  Image image(crop.Width(), crop.Height(), AutoChannels());
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const Point2 center(static_cast<float>(crop.x0 + x) + 0.5f, static_cast<float>(crop.y0 + y) + 0.5f);
      const UsedCounts used = counts.At(center, techniques);
      image.At(x, y, 0) = static_cast<float>(used.lightPaths);
      image.At(x, y, 1) = static_cast<float>(used.connecting);
      image.At(x, y, 2) = static_cast<float>(used.merging);
      image.At(x, y, 3) = static_cast<float>(used.continuing);
    }
  }
  return image;
}

}  // namespace lampyr
