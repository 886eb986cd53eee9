// The image module: the formats read through OpenImageIO. It is a separate shared library because
// OpenImageIO costs every process that links it 0.3 s and 127 MiB at start. No exception leaves it.
#include "film/image_module.h"

#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cstring>
#include <exception>
#include <memory>
#include <new>
#include <string>
#include <string_view>
#include <vector>

namespace {

void SetError(char* error, size_t errorSize, std::string text) {
  while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
  if (errorSize == 0) return;
  const size_t length = std::min(text.size(), errorSize - 1);
  std::memcpy(error, text.data(), length);
  error[length] = '\0';
}

int IntegerBits(const OIIO::TypeDesc& format) {
  const bool isFloat = format.basetype == OIIO::TypeDesc::HALF || format.basetype == OIIO::TypeDesc::FLOAT ||
                       format.basetype == OIIO::TypeDesc::DOUBLE;
  return isFloat ? 0 : static_cast<int>(8 * format.basesize());
}

std::string ErrorOf(const OIIO::ImageInput& input) {
  const std::string text = input.geterror();
  return text.empty() ? "it is damaged" : text;
}

// Returns "" on success, otherwise the error.
std::string Read(const char* path, const char* format, lampyr::ImageModuleAllocate allocate, void* context) {
  OIIO::attribute("limits:imagesize_MB", 1 << 30);  // `allocate` decides what is too large
  OIIO::ImageSpec configuration, opened;
  configuration.attribute("oiio:UnassociatedAlpha", 1);  // colours as stored, not multiplied by alpha
  const auto input = OIIO::ImageInput::create(format);
  if (!input) return OIIO::geterror();
  if (!input->open(path, opened, configuration)) return ErrorOf(*input);
  const OIIO::ImageSpec& spec = input->spec();
  if (spec.depth > 1) return "it is a volume";
  // A Radiance file may store its rows from below, or columns first.
  if (std::string_view(format) == "hdr" && spec.get_int_attribute("Orientation", 1) != 1)
    return "its rows do not begin at the top left: \"-Y … +X …\" is read";
  // A reader allocates a whole tile.
  constexpr auto largestTile = OIIO::imagesize_t{1} << 24;
  if (spec.tile_width > 0 && spec.tile_pixels() > std::max(largestTile, spec.image_pixels())) {
    return "its tiles are larger than the image";
  }

  std::vector<const char*> names;
  for (const std::string& name : spec.channelnames) names.push_back(name.c_str());
  lampyr::ImageModuleInfo info{};
  info.width = spec.width;
  info.height = spec.height;
  info.channels = spec.nchannels;
  info.channelNames = names.data();
  info.integerBits = IntegerBits(spec.format);
  info.saysSrgb = spec.get_string_attribute("oiio:ColorSpace") == "sRGB" ? 1 : 0;
  info.bytesPerPixel = static_cast<long long>(spec.pixel_bytes(true));
  float* pixels = allocate(context, &info);
  if (!pixels) return "it is too large";
  if (!input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, pixels)) {
    return ErrorOf(*input);
  }
  return "";
}

template <class Work>
int Guarded(char* error, size_t errorSize, Work work) {
  std::string text;
  try {
    text = work();
    if (text.empty()) return 0;
  } catch (const std::bad_alloc&) {
    text = "there is not enough memory for it";
  } catch (const std::exception& e) {
    text = e.what();
  } catch (...) {
    text = "unknown failure";
  }
  SetError(error, errorSize, text.empty() ? "unknown failure" : text);
  return 1;
}

}  // namespace

extern "C" {

int lampyr_image_module_version() {
  return lampyr::kImageModuleVersion;
}

int lampyr_read_image(const char* path, const char* format, lampyr::ImageModuleAllocate allocate, void* context,
                      char* error, size_t errorSize) {
  return Guarded(error, errorSize, [&] { return Read(path, format, allocate, context); });
}

}  // extern "C"
