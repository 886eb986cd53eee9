// Images in memory, and their input and output. OpenEXR and libpng are used directly, and the usual Radiance pictures
// are read here; all other formats go through OpenImageIO, which is loaded when such a file is first used
// (src/film/image_module.cpp).
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "math/vec.h"

namespace lampyr {

class AtomicFile;

// An image of interleaved float channels, row by row from the top.
struct Image {
  int width = 0, height = 0;
  std::vector<std::string> channels;  // "R", "G", "B", "variance.R", …
  std::vector<float> data;            // width · height · channels.size()
  std::map<std::string, std::string> metadata;
  int offsetX = 0, offsetY = 0;       // of the data window (a crop) in the full image
  int fullWidth = 0, fullHeight = 0;  // display window; 0: width and height
  // The decoding of the colours of the file (alpha is not decoded): 0: sRGB; 1: none; else the exponent.
  float colorGamma = 1;
  // Chromaticities x, y of the primaries red, green, blue and of the white. Absent: the file has none.
  std::optional<std::array<double, 8>> chromaticities;

  Image() = default;
  Image(int w, int h, std::vector<std::string> channelNames);

  float& At(int x, int y, size_t channel) {
    return data[(static_cast<size_t>(y) * width + x) * channels.size() + channel];
  }
  float At(int x, int y, size_t channel) const {
    return data[(static_cast<size_t>(y) * width + x) * channels.size() + channel];
  }
  // Index of a channel by name; -1 if absent.
  int ChannelIndex(const std::string& name) const;
  // R, G and B at a pixel; gray for an image with a single channel or a channel Y.
  Color RgbAt(int x, int y) const;
  bool HasRgb() const;  // or gray: RgbAt is meaningful
};

// Adds all channels of `more`, an image of the same size.
void AppendChannels(Image& image, const Image& more);
// The channels of those names, with the window of the image; an image without channels if it does not have all of them.
Image ChannelsOf(const Image& image, const std::vector<std::string>& names);

// Half applies to layers whose values it can hold. Layers with a finite value beyond its range, identifiers, variances
// and errors are written as float.
enum class ExrPrecision { Half, Float };

// Writes an OpenEXR file atomically (AtomicFile). Throws an Error (unwritable folder, full disk). `append`, if given,
// writes further bytes behind the image, which EXR readers ignore.
void WriteExr(const std::filesystem::path& path, const Image& image, ExrPrecision precision,
              const std::function<void(AtomicFile&)>& append = {});

// Writes an 8-bit sRGB PNG for display: exposure in stops, then a tone map: clipping at 1, or a filmic shoulder, which
// is x up to 0.6, then 0.6 + 0.4·(1 - exp(-(x - 0.6)/0.4)), per channel.
enum class ToneMap { Clip, Filmic };
// The sRGB value of a channel; `exposure`: its factor.
unsigned char ToDisplay(float linear, float exposure, ToneMap toneMap);
void WritePng(const std::filesystem::path& path, const Image& image, float exposureStops, ToneMap toneMap);
// The bytes of the file that WritePng writes.
std::vector<unsigned char> EncodeForDisplay(const Image& image, float exposureStops, ToneMap toneMap);
// Encodes 8-bit RGB pixels as PNG, unchanged.
std::vector<unsigned char> EncodePng(int width, int height, const std::vector<unsigned char>& rgb);

// Automatic: sRGB for 8-bit files, and for other integer files that declare it; linear otherwise.
enum class ImageEncoding { Automatic, Linear, Srgb };

// Reads an image of any format as linear floats. Throws an Error that names the file and its defect. `encoding` applies
// only to integer formats (floating-point files are linear), and never to alpha, which is channel "A" and not
// multiplied into the colour. Channels are in the order R, G, B, A, then the layers in alphabetical order.
Image ReadImage(const std::filesystem::path& path, ImageEncoding encoding = ImageEncoding::Automatic);
// Variant of ReadImage with a power law for integer formats: linear = encoded^gamma.
Image ReadImageWithGamma(const std::filesystem::path& path, float gamma);

}  // namespace lampyr
