#include "render/sample_image.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "render/output_files.h"
#include "render/settings/output_layers.h"

namespace lampyr {

namespace {

// The largest half is 65504; a brighter image is written in floats.
bool FitsHalves(const Image& image) {
  constexpr float largestHalf = 65504;
  return std::all_of(image.data.begin(), image.data.end(), [](float v) { return std::abs(v) <= largestHalf; });
}

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
// which bounds it.
Image ErrorOf(const Image& developed, const std::vector<double>& biasSquares) {
  Image image(developed.width, developed.height, {"relativeError"});
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      double luminance = 0, deviation = 0;
      for (size_t c = 0; c < 3; ++c) {
        luminance += Color::kLuminance[c] * static_cast<double>(developed.At(x, y, c));
        deviation += Color::kLuminance[c] * std::sqrt(static_cast<double>(developed.At(x, y, 3 + c)));
      }
      double half = 1.96 * deviation;
      if (!biasSquares.empty())
        half = std::hypot(half, std::sqrt(biasSquares[static_cast<size_t>(y * image.width + x)]));
      image.At(x, y, 0) = luminance > 0 ? static_cast<float>(half / luminance) : 0.0f;
    }
  }
  return image;
}

}  // namespace

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
  if (wants(kErrorLayer)) AppendChannels(image, ErrorOf(image, film.BiasSquares()));
  if (wants(kBiasLayer)) AppendChannels(image, BiasOf(film));
  for (const auto& [key, value] : header.metadata) image.metadata[key] = value;
  image.metadata["lampyr.samplesPerPixel"] = std::to_string(header.samples);
  // Identifiers in mattes are bits, not numbers.
  const bool hasMattes = std::any_of(image.channels.begin(), image.channels.end(),
                                     [](const std::string& channel) { return channel.starts_with("Crypto"); });
  const bool asHalves = header.halfPrecision && !hasMattes && FitsHalves(image);
  WriteExr(path, image, asHalves ? ExrPrecision::Half : ExrPrecision::Float, append);
}

void WritePngBeside(std::filesystem::path path, const Image& image, float exposureStops, bool clips) {
  WritePng(path.replace_extension(".png"), image, exposureStops, clips ? ToneMap::Clip : ToneMap::Filmic);
}

}  // namespace lampyr
