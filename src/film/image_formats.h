// Private to the film room: the readers behind ReadImage, and what they check alike.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "film/image.h"
#include "film/image_kind.h"

namespace lampyr {

Image ReadExr(const std::filesystem::path& path);

// An image as OpenImageIO gives it: values as encoded in the file.
struct EncodedImage {
  Image image;
  int integerBits = 0;     // 8, 16, …; 0 for floating point
  bool saysSrgb = false;   // the file (or its format's rule) says that it is sRGB
};
EncodedImage ReadThroughModule(const std::filesystem::path& path, const ImageKind& kind);

struct JpegSize {
  int64_t width = 0, height = 0;
};
// Of the frame header. Throws Error when the file ends before its end marker or has no frame.
JpegSize ReadJpegSize(const std::filesystem::path& path);

// Throws Error when an attribute of an OpenEXR file's header is longer than the file.
void CheckExrHeader(const std::filesystem::path& path);

// Throws Error when the size is absurd: more than 2^30 values, or more than 2^27 and far more than the file could hold
// compressed (a corrupt header must not claim the machine's memory). `bytesPerPixel` in the file, uncompressed.
void CheckImageSize(const std::filesystem::path& path, int64_t width, int64_t height, int64_t channels,
                    int64_t bytesPerPixel);

// R, G, B, A first, then the other layers, each in the order R, G, B, A, rest. Returns the new order as indices.
std::vector<size_t> ChannelOrder(const std::vector<std::string>& names);

}  // namespace lampyr
