// PNG files: read as encoded, and written in 8 bits. The only file that includes libpng, which reports errors by
// longjmp: between setjmp and the calls that may jump there is no object with a destructor.
#include <png.h>

#include <cmath>
#include <csetjmp>
#include <cstdint>
#include <cstdio>
#include <new>
#include <string>
#include <vector>

#include "base/error.h"
#include "film/image_formats.h"

namespace lampyr {

namespace {

// State of a file that is being read. libpng's allocations are freed with it.
struct PngFile {
  std::FILE* file = nullptr;
  png_structp png = nullptr;
  png_infop info = nullptr;
  char error[256] = "";

  ~PngFile() {
    png_destroy_read_struct(&png, &info, nullptr);
    if (file) std::fclose(file);
  }
};

void Fail(png_structp png, png_const_charp message) {
  auto& error = static_cast<PngFile*>(png_get_error_ptr(png))->error;
  std::snprintf(error, sizeof error, "%s", message);
  png_longjmp(png, 1);
}

void Ignore(png_structp, png_const_charp) {}

// Properties of the rows after the conversions of BeginReading.
struct PngLayout {
  uint32_t width = 0, height = 0;
  int channels = 0, bits = 0, passes = 1;
  int storedBytesPerPixel = 1;  // in the file, rounded
  bool saysSrgb = false;
};

// Reads the header, and requests whole samples of 8 or 16 bits: no palette, no transparent colour. False: it failed.
bool BeginReading(PngFile& file, PngLayout& layout) {
  if (setjmp(png_jmpbuf(file.png))) return false;
  png_init_io(file.png, file.file);
  png_set_chunk_cache_max(file.png, 1);  // discards texts, which may unpack to gigabytes
  png_read_info(file.png, file.info);
  const int storedBits = png_get_channels(file.png, file.info) * png_get_bit_depth(file.png, file.info);
  layout.storedBytesPerPixel = std::max(storedBits / 8, 1);
  png_set_expand(file.png);
  layout.passes = png_set_interlace_handling(file.png);
  png_read_update_info(file.png, file.info);
  layout.width = png_get_image_width(file.png, file.info);
  layout.height = png_get_image_height(file.png, file.info);
  layout.channels = png_get_channels(file.png, file.info);
  layout.bits = png_get_bit_depth(file.png, file.info);
  // A PNG is sRGB if it is declared so, if its gamma is near that of sRGB, or if it declares neither.
  constexpr double kOfSrgb = 1 / 2.2, kTolerance = 0.01;
  double gamma = kOfSrgb;
  png_get_gAMA(file.png, file.info, &gamma);
  layout.saysSrgb = png_get_valid(file.png, file.info, PNG_INFO_sRGB) != 0 || std::abs(gamma - kOfSrgb) < kTolerance;
  return true;
}

// Reads the next row. False: it failed.
bool ReadRow(PngFile& file, unsigned char* row) {
  if (setjmp(png_jmpbuf(file.png))) return false;
  png_read_row(file.png, row, nullptr);
  return true;
}

// Values of a row in [0,1].
void Decode(const std::vector<unsigned char>& row, int bits, float* values, size_t count) {
  for (size_t i = 0; i < count; ++i) {
    values[i] = bits == 16 ? static_cast<float>(256 * row[2 * i] + row[2 * i + 1]) / 65535.0f
                           : static_cast<float>(row[i]) / 255.0f;
  }
}

EncodedImage ReadOrThrow(const std::filesystem::path& path) {
  const auto fail = [&path](const std::string& why) -> EncodedImage {
    throw Error("cannot read image \"" + path.string() + "\": " + (why.empty() ? "it is damaged" : why));
  };
  PngFile file;
  file.file = std::fopen(path.c_str(), "rb");
  if (!file.file) return fail("it cannot be opened");
  file.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &file, Fail, Ignore);
  file.info = file.png ? png_create_info_struct(file.png) : nullptr;
  if (!file.info) return fail("there is not enough memory for it");
  PngLayout layout;
  if (!BeginReading(file, layout)) return fail(file.error);
  // The rows of an interlaced picture are kept besides the values.
  CheckImageSize(path, layout.width, layout.height, (layout.passes > 1 ? 2 : 1) * layout.channels,
                 layout.storedBytesPerPixel);

  static const std::vector<std::string> kNames[] = {{"Y"}, {"Y", "A"}, {"R", "G", "B"}, {"R", "G", "B", "A"}};
  EncodedImage encoded;
  encoded.image = Image(static_cast<int>(layout.width), static_cast<int>(layout.height), kNames[layout.channels - 1]);
  encoded.integerBits = layout.bits;
  encoded.saysSrgb = layout.saysSrgb;
  const size_t values = static_cast<size_t>(layout.width) * static_cast<size_t>(layout.channels);
  const size_t rowBytes = png_get_rowbytes(file.png, file.info);
  // An interlaced picture is read in several passes over all of its rows.
  const bool isInterlaced = layout.passes > 1;
  std::vector<std::vector<unsigned char>> rows(isInterlaced ? layout.height : 1, std::vector<unsigned char>(rowBytes));
  for (int pass = 0; pass < layout.passes; ++pass) {
    for (uint32_t y = 0; y < layout.height; ++y) {
      std::vector<unsigned char>& row = rows[isInterlaced ? y : 0];
      if (!ReadRow(file, row.data())) return fail(file.error);
      if (pass + 1 == layout.passes) Decode(row, layout.bits, &encoded.image.data[y * values], values);
    }
  }
  return encoded;
}

}  // namespace

EncodedImage ReadPng(const std::filesystem::path& path) {
  try {
    return ReadOrThrow(path);
  } catch (const std::bad_alloc&) {
    throw Error("cannot read image \"" + path.string() + "\": there is not enough memory for it");
  }
}

std::vector<unsigned char> EncodePng(int width, int height, const std::vector<unsigned char>& rgb) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(width);
  image.height = static_cast<png_uint_32>(height);
  image.format = PNG_FORMAT_RGB;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
  std::vector<unsigned char> bytes(size);
  if (!png_image_write_to_memory(&image, bytes.data(), &size, 0, rgb.data(), 0, nullptr))
    throw Error(std::string("cannot encode PNG: ") + image.message);
  bytes.resize(size);
  return bytes;
}

}  // namespace lampyr
