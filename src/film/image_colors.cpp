#include "film/image_colors.h"

#include <algorithm>

namespace lampyr {

namespace {

bool HasRgbChannels(const Image& image) {
  return image.ChannelIndex("R") >= 0 && image.ChannelIndex("G") >= 0 && image.ChannelIndex("B") >= 0;
}

}  // namespace

bool NeedsConversion(const Image& image, WhiteHandling white) {
  return image.chromaticities && HasRgbChannels(image) && MatrixToRec709(*image.chromaticities, white);
}

Image InRec709(Image image, WhiteHandling white, GamutHandling gamut) {
  if (!NeedsConversion(image, white)) return image;
  const auto matrix = *MatrixToRec709(*image.chromaticities, white);
  image.chromaticities.reset();
  const int channels[] = {image.ChannelIndex("R"), image.ChannelIndex("G"), image.ChannelIndex("B")};
  for (size_t first = 0; first < image.data.size(); first += image.channels.size()) {
    const auto channel = [&](int i) -> float& { return image.data[first + static_cast<size_t>(channels[i])]; };
    const Vector3d rgb(channel(0), channel(1), channel(2));
    if (!IsFinite(rgb)) continue;
    const Vector3d linear = matrix * (gamut == GamutHandling::Limit ? glm::max(rgb, Vector3d(0.0)) : rgb);
    const Color color =
        gamut == GamutHandling::Limit
            ? ClampToGamut(linear)
            : Color(static_cast<float>(linear.x), static_cast<float>(linear.y), static_cast<float>(linear.z));
    channel(0) = color.r;
    channel(1) = color.g;
    channel(2) = color.b;
  }
  return image;
}

}  // namespace lampyr
