#include "render/sample_image.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "render/output_files.h"

namespace lampyr {

namespace {

// The largest half is 65504; a brighter image is written in floats.
bool FitsHalves(const Image& image) {
  constexpr float largestHalf = 65504;
  return std::all_of(image.data.begin(), image.data.end(), [](float v) { return std::abs(v) <= largestHalf; });
}

}  // namespace

void CheckImageOutput(const std::filesystem::path& path, const char* option, bool withPng) {
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
  image.metadata = header.metadata;
  image.metadata["lampyr.samplesPerPixel"] = std::to_string(header.samples);
  const bool asHalves = header.halfPrecision && FitsHalves(image);
  WriteExr(path, image, asHalves ? ExrPrecision::Half : ExrPrecision::Float, append);
}

void WritePngBeside(std::filesystem::path path, const Image& image, float exposureStops, bool clips) {
  WritePng(path.replace_extension(".png"), image, exposureStops, clips ? ToneMap::Clip : ToneMap::Filmic);
}

}  // namespace lampyr
