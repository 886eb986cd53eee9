// The C interface of the image module, a shared library that is loaded when an image needs OpenImageIO
// (image_module.cpp: the module; image_module_loader.cpp: loading it). Private to film/.
#pragma once

#include <cstddef>

namespace lampyr {

inline constexpr int kImageModuleVersion = 3;

// Properties of an image, known before its pixels are read.
struct ImageModuleInfo {
  int width, height, channels;
  const char* const* channelNames;
  int integerBits;  // 0: floating point
  int saysSrgb;
  long long bytesPerPixel;  // uncompressed, in the file
};

// Returns memory for width·height·channels floats, or null to stop.
using ImageModuleAllocate = float* (*)(void* context, const ImageModuleInfo* info);

// Returns 0 on success, or 1 with a text in `error` (of `errorSize` characters, terminated by 0). `format`: the
// only reader to be tried.
using ImageModuleRead = int (*)(const char* path, const char* format, ImageModuleAllocate allocate, void* context,
                                char* error, size_t errorSize);
using ImageModuleVersion = int (*)();

}  // namespace lampyr
