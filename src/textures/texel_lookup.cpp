// Wrap modes. The octahedral mode continues across the edges of the equal-area square map of the sphere ([Clarberg08]):
// beyond an edge, the image is mirrored about the midpoint of the edge.
#include "textures/texel_lookup.h"

#include <algorithm>

namespace lampyr {

namespace {

int Modulo(int a, int n) {
  const int r = a % n;
  return r < 0 ? r + n : r;
}

// Alpha that is 1 everywhere does not count.
bool HasAlpha(const Image& image) {
  const int alpha = image.ChannelIndex("A");
  for (size_t i = static_cast<size_t>(alpha); alpha >= 0 && i < image.data.size(); i += image.channels.size()) {
    if (image.data[i] != 1) return true;
  }
  return false;
}

}  // namespace

TexelLookup::TexelLookup(std::shared_ptr<const Image> image, WrapMode wrap, bool bilinear)
    : image_(std::move(image)),
      data_(image_->data.data()),
      width_(image_->width),
      height_(image_->height),
      stride_(image_->channels.size()),
      wrap_(wrap),
      bilinear_(bilinear) {
  const int r = image_->ChannelIndex("R"), g = image_->ChannelIndex("G"), b = image_->ChannelIndex("B");
  const bool isColor = r >= 0 && g >= 0 && b >= 0;
  const int gray = std::max(0, image_->ChannelIndex("Y"));
  red_ = static_cast<size_t>(isColor ? r : gray);
  green_ = static_cast<size_t>(isColor ? g : gray);
  blue_ = static_cast<size_t>(isColor ? b : gray);
  const bool hasAlpha = isColor && HasAlpha(*image_);
  float_ = hasAlpha ? static_cast<size_t>(image_->ChannelIndex("A")) : red_;
  isMean_ = isColor && !hasAlpha;
}

bool TexelLookup::WrapInside(int& x, int& y) const {
  switch (wrap_) {
    case WrapMode::Black:
      return false;
    case WrapMode::Clamp:
      x = std::clamp(x, 0, width_ - 1);
      y = std::clamp(y, 0, height_ - 1);
      return true;
    case WrapMode::OctahedralSphere: {
      // Whole periods first (a period is two images along an axis), so that coordinates of any size end inside.
      x = Modulo(x, 2 * width_);
      y = Modulo(y, 2 * height_);
      if (x >= width_) {
        x = 2 * width_ - 1 - x;
        y = Modulo(height_ - 1 - y, 2 * height_);
      }
      if (y >= height_) {
        x = width_ - 1 - x;
        y = 2 * height_ - 1 - y;
      }
      return true;
    }
    default:
      x = Modulo(x, width_);
      y = Modulo(y, height_);
      return true;
  }
}

}  // namespace lampyr
