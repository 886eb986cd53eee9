// Loads the image module on first use: from the folder of the executable, from ../lib/lampyr relative to it, or from
// the build folder. It stays loaded until the process ends.
#include <dlfcn.h>

#include <algorithm>
#include <array>
#include <exception>
#include <system_error>

#include "base/error.h"
#include "film/image_formats.h"
#include "film/image_module.h"

namespace lampyr {

namespace {

struct ImageModule {
  ImageModuleRead read = nullptr;
};

std::vector<std::filesystem::path> ModulePlaces() {
  const char* name = "lampyr_image_module.so";
  std::vector<std::filesystem::path> places;
  std::error_code code;
  const std::filesystem::path executable = std::filesystem::read_symlink("/proc/self/exe", code);
  if (!code) {
    places.push_back(executable.parent_path() / name);
    places.push_back(executable.parent_path().parent_path() / "lib" / "lampyr" / name);
  }
  places.emplace_back(LAMPYR_IMAGE_MODULE_BUILD_PATH);
  return places;
}

template <class Function>
Function Symbol(void* library, const std::filesystem::path& place, const char* name) {
  const auto function = reinterpret_cast<Function>(dlsym(library, name));
  if (!function) throw Error("the image module " + place.string() + " has no " + name);
  return function;
}

ImageModule LoadImageModule() {
  std::string tried;
  for (const auto& place : ModulePlaces()) {
    tried += (tried.empty() ? "" : ", ") + place.string();
    std::error_code code;
    if (!std::filesystem::exists(place, code)) continue;
    void* library = dlopen(place.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (!library) throw Error(std::string("the image module cannot be loaded: ") + dlerror());
    if (Symbol<ImageModuleVersion>(library, place, "lampyr_image_module_version")() != kImageModuleVersion) {
      throw Error("the image module " + place.string() + " is of another version of lampyr");
    }
    return {Symbol<ImageModuleRead>(library, place, "lampyr_read_image")};
  }
  throw Error("this image format needs the image module, which was not found (looked for " + tried +
              "); OpenEXR and PNG files need no module");
}

const ImageModule& GetImageModule() {
  static const ImageModule module = LoadImageModule();  // retried at the next call if it throws
  return module;
}

// State that ReadThroughModule passes through the C interface of the module.
struct ReadContext {
  const std::filesystem::path& path;
  EncodedImage encoded;
  std::exception_ptr failure;
};

float* AllocateImage(void* opaque, const ImageModuleInfo* info) {
  auto& context = *static_cast<ReadContext*>(opaque);
  try {
    CheckImageSize(context.path, info->width, info->height, info->channels, info->bytesPerPixel);
    std::vector<std::string> names(info->channelNames, info->channelNames + info->channels);
    context.encoded.image = Image(info->width, info->height, std::move(names));
    context.encoded.integerBits = info->integerBits;
    context.encoded.saysSrgb = info->saysSrgb != 0;
    return context.encoded.image.data.data();
  } catch (...) {
    context.failure = std::current_exception();
    return nullptr;
  }
}

}  // namespace

EncodedImage ReadThroughModule(const std::filesystem::path& path, const ImageKind& kind) {
  constexpr int64_t channels = 4, bytesPerPixel = 4;  // memory of readers that allocate the whole image
  if (kind.width > 0 && kind.height > 0) CheckImageSize(path, kind.width, kind.height, channels, bytesPerPixel);
  std::array<char, 512> error{};
  ReadContext context{path, {}, nullptr};
  if (GetImageModule().read(path.c_str(), kind.format, AllocateImage, &context, error.data(), error.size()) != 0) {
    if (!context.failure) {
      std::string text = error.data();  // several lines for several errors
      std::replace(text.begin(), text.end(), '\n', ' ');
      throw Error("cannot read image \"" + path.string() + "\": " + text);
    }
    try {
      std::rethrow_exception(context.failure);
    } catch (const Error&) {
      throw;
    } catch (const std::bad_alloc&) {
      throw Error("cannot read image \"" + path.string() + "\": there is not enough memory for it");
    } catch (const std::exception& e) {
      throw Error("cannot read image \"" + path.string() + "\": " + e.what());
    }
  }
  return std::move(context.encoded);
}

}  // namespace lampyr
