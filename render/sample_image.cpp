#include "render/sample_image.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "render/output_files.h"
#include "render/settings/output_layers.h"

namespace lampyr {

namespace {

Image SamplesOf(const Film& film) {
  Image image(film.Crop().Width(), film.Crop().Height(), {"samples"});
  for (size_t i = 0; i < film.Pixels(); ++i) image.data[i] = static_cast<float>(film.Samples(i));
  return image;
}

Image BiasOf(const Film& film) {
  Image image(film.Crop().Width(), film.Crop().Height(), FindPixelLayer(kBiasLayer)->channels);
  for (size_t i = 0; i < film.Pixels(); ++i) {
    for (size_t c = 0; c < 3; ++c) image.data[3 * i + c] = static_cast<float>(film.Bias(i, static_cast<int>(c)));
  }
  return image;
}

// Half the width of the 95 % interval of a pixel's luminance, relative to it. Channels are taken as fully correlated,
// which bounds it. Infinite where it is not known, as in Film::PixelErrors.
Image ErrorOf(const Film& film, const Image& developed) {
  const std::vector<double> biasSquares = film.BiasSquares();
  Image image(developed.width, developed.height, {"relativeError"});
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      double luminance = 0, deviation = 0;
      for (size_t c = 0; c < 3; ++c) {
        luminance += Color::kLuminance[c] * static_cast<double>(developed.At(x, y, c));
        deviation += Color::kLuminance[c] * std::sqrt(static_cast<double>(developed.At(x, y, 3 + c)));
      }
      double half = 1.96 * deviation;
      const auto i = static_cast<size_t>(y * image.width + x);
      if (!biasSquares.empty()) half = std::hypot(half, std::sqrt(biasSquares[i]));
      const bool isUnknown = film.Samples(i) < 2 && (film.Samples(i) == 1 || film.LightPaths() < 2);
      image.At(x, y, 0) = isUnknown || (half > 0 && !(luminance > 0)) ? std::numeric_limits<float>::infinity()
                          : half > 0                                  ? static_cast<float>(half / luminance)
                                                                      : 0.0f;
    }
  }
  return image;
}

}  // namespace

void SetHalfShare(std::span<const PartHeader> parts, std::map<std::string, std::string>& metadata) {
  uint64_t all = 0, inHalf = 0;
  bool areFirst = true;
  for (const PartHeader& part : parts) {
    areFirst = areFirst && part.shard.first == all;
    all += part.samples;
    inHalf += SamplesInHalf(part.shard.first + part.samples) - SamplesInHalf(part.shard.first);
  }
  if (areFirst || all == 0) return;
  metadata.try_emplace(kHalfShareMetadata, std::to_string(static_cast<double>(inHalf) / static_cast<double>(all)));
}

void CheckImageOutput(const std::filesystem::path& path, const char* option, bool withPng) {
  if (path.filename() == ".exr") throw UsageError(std::string(option) + ": \".exr\" has no name before its ending");
  if (path.extension() != ".exr") {
    throw UsageError(std::string(option) + ": \"" + path.string() +
                     "\" must end in .exr (--png writes a PNG beside it)");
  }
  CheckWritable(path, option);
  if (withPng) CheckWritable(std::filesystem::path(path).replace_extension(".png"), "--png");
}

void WriteSamples(const std::filesystem::path& path, const PartHeader& header, const Film& film, const Image& layers,
                  const std::function<void(AtomicFile&)>& append) {
  Image image = film.Develop();
  if (!layers.channels.empty()) AppendChannels(image, layers);
  const auto wants = [&](const char* layer) {
    return header.metadata.contains(std::string(kSampleLayerMetadata) + layer);
  };
  if (wants(kSamplesLayer)) AppendChannels(image, SamplesOf(film));
  if (wants(kErrorLayer)) AppendChannels(image, ErrorOf(film, image));
  if (wants(kBiasLayer)) AppendChannels(image, BiasOf(film));
  for (const auto& [key, value] : header.metadata) image.metadata[key] = value;
  if (film.HasHalf()) SetHalfShare(std::span(&header, 1), image.metadata);
  if (image.ChannelIndex(kSplatShareChannel) < 0) image.metadata.erase(kSplatCountMetadata);
  image.metadata["lampyr.samplesPerPixel"] = std::to_string(header.samples);
  WriteExr(path, image, header.halfPrecision ? ExrPrecision::Half : ExrPrecision::Float, append);
}

void WritePngBeside(std::filesystem::path path, const Image& image, float exposureStops, bool clips) {
  WritePng(path.replace_extension(".png"), image, exposureStops, clips ? ToneMap::Clip : ToneMap::Filmic);
}

}  // namespace lampyr
