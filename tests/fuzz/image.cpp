#include "film/image.h"
#include "fuzz/target_support.h"

namespace lampyr::fuzz {

bool ReadImageFile(std::string_view bytes) {
  if (bytes.empty()) return false;
  const size_t format = static_cast<unsigned char>(bytes.front()) % std::size(kImageExtensions);
  return AcceptErrors([&] {
    const Image image = ReadImage(AsFile(bytes.substr(1), kImageExtensions[format]));
    const size_t values = static_cast<size_t>(image.width) * static_cast<size_t>(image.height) * image.channels.size();
    if (image.width <= 0 || image.height <= 0 || image.channels.empty()) Fail("an image without pixels");
    if (image.data.size() != values) Fail("an image with another number of pixels than it says");
    if (image.HasRgb()) image.RgbAt(image.width - 1, image.height - 1);
  });
}

}  // namespace lampyr::fuzz
