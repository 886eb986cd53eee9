// Private to film/: the readers behind ReadImage, and their common checks.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "film/image.h"

namespace lampyr {

struct ImageKind {
  const char* format = "";  // OpenImageIO's name
  int64_t width = 0,
          height = 0;  // from the header, for formats whose readers allocate before they report a size; 0: unknown
};

// Throws an Error that lists the supported formats if the file is of none of them. Other formats of the image library
// are not offered: each further reader would have to withstand damaged files.
ImageKind FindImageKind(const std::filesystem::path& path);

Image ReadExr(const std::filesystem::path& path);

// An image with values as encoded in the file.
struct EncodedImage {
  Image image;
  int integerBits = 0;    // 8, 16, …; 0 for floating point
  bool saysSrgb = false;  // declared by the file or implied by its format
};
// PNG files, without the module.
EncodedImage ReadPng(const std::filesystem::path& path);
// Radiance pictures (hdr) of the usual kind, without the module. nullopt: another kind, or damaged.
std::optional<Image> ReadUsualRadiance(const std::filesystem::path& path);
EncodedImage ReadThroughModule(const std::filesystem::path& path, const ImageKind& kind);

struct JpegSize {
  int64_t width = 0, height = 0;
};
// Image size from the frame header. Throws an Error if the file ends before its end marker or has no frame.
JpegSize ReadJpegSize(const std::filesystem::path& path);

// Throws an Error if an attribute in the header of an OpenEXR file claims to be longer than the file.
void CheckExrHeader(const std::filesystem::path& path);

// Throws an Error for an image without pixels, or of an absurd size: more than 2^30 values, more than the available
// memory, or more than 2^27 values and far more than the file could hold compressed (a corrupt header must not claim
// the machine's memory). `bytesPerPixel`: in the file, uncompressed.
void CheckImageSize(const std::filesystem::path& path, int64_t width, int64_t height, int64_t channels,
                    int64_t bytesPerPixel);

// The order of channels as indices into `names`: R, G, B, A and the rest without a layer, then each layer,
// alphabetically, in the order R, G, B, A, rest.
std::vector<size_t> ChannelOrder(const std::vector<std::string>& names);

}  // namespace lampyr
