// Images in memory, and reading and writing them. OpenEXR is used directly; every other format goes through
// OpenImageIO, which is loaded only when such a file is met (src/film/image_module.cpp).
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "math/vec.h"

namespace lampyr {

class AtomicFile;

// Interleaved float channels, row by row from the top.
struct Image {
  int width = 0, height = 0;
  std::vector<std::string> channels;  // "R", "G", "B", "variance.R", …
  std::vector<float> data;            // width · height · channels.size()
  std::map<std::string, std::string> metadata;
  int offsetX = 0, offsetY = 0;       // of the data window (a crop) within the full image
  int fullWidth = 0, fullHeight = 0;  // display window; 0: the same as width and height

  Image() = default;
  Image(int w, int h, std::vector<std::string> channelNames);

  float& At(int x, int y, size_t channel) {
    return data[(static_cast<size_t>(y) * width + x) * channels.size() + channel];
  }
  float At(int x, int y, size_t channel) const {
    return data[(static_cast<size_t>(y) * width + x) * channels.size() + channel];
  }
  // Index of a channel by name, -1 when absent.
  int ChannelIndex(const std::string& name) const;
  // R, G and B at a pixel; a single-channel image, or one with a Y channel, is gray.
  Color RgbAt(int x, int y) const;
  bool HasRgb() const;  // or gray: RgbAt has an answer
};

enum class ExrPrecision { Half, Float };

// Written to a temporary name in the same folder, then renamed: the file is whole or it is not there.
// Throws Error (unwritable folder, full disk).
// `append`, if any, writes more behind the image, which readers of EXR files do not look at.
void WriteExr(const std::filesystem::path& path, const Image& image, ExrPrecision precision,
              const std::function<void(AtomicFile&)>& append = {});

// 8-bit sRGB with tone mapping for pictures to look at: exposure in stops, then clipping at 1, or a filmic shoulder:
// x up to 0.6, then 0.6 + 0.4·(1 - exp(-(x - 0.6)/0.4)) per channel.
enum class ToneMap { Clip, Filmic };
void WritePng(const std::filesystem::path& path, const Image& image, float exposureStops, ToneMap toneMap);
// The bytes of such a file.
std::vector<unsigned char> EncodeForDisplay(const Image& image, float exposureStops, ToneMap toneMap);
// PNG bytes of 8-bit RGB pixels, as they are.
std::vector<unsigned char> EncodePng(int width, int height, const std::vector<unsigned char>& rgb);

enum class ImageEncoding { Automatic, Linear, Srgb };  // Automatic: sRGB for 8-bit files, linear otherwise

// Any image, as linear floats. EXR by OpenEXR, the rest by OpenImageIO. Throws Error naming the file and what is wrong.
// The encoding concerns integer formats only (floating point files are linear) and never alpha, which is channel "A"
// and not multiplied into the colour. Channels come as R, G, B, A, then the layers in alphabetical order.
Image ReadImage(const std::filesystem::path& path, ImageEncoding encoding = ImageEncoding::Automatic);
// The same with a power law for integer formats: linear = encoded^gamma.
Image ReadImageWithGamma(const std::filesystem::path& path, float gamma);

}  // namespace lampyr
