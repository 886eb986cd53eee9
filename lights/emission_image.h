// An image as a light uses it: radiance per texel, with NaN, infinite and negative texels read as 0 (warned about
// once).
#pragma once

#include <memory>
#include <string>

#include "film/image.h"
#include "lights/light_type.h"

namespace lampyr {

class EmissionImage {
 public:
  EmissionImage() = default;
  // The file that the parameter `name` ("filename", "texture:file") gives; an empty image when there is none. Throws
  // located Errors.
  EmissionImage(const ParameterList& parameters, const std::string& name, const LightBuildContext& build);
  // `name` is for messages.
  EmissionImage(std::shared_ptr<const Image> image, const std::string& name, const FileLocation& where,
                Diagnostics* diagnostics);

  bool IsEmpty() const { return !image_; }
  int Width() const { return image_->width; }
  int Height() const { return image_->height; }

  Color Texel(int x, int y) const { return TexelAt(data_ + (static_cast<size_t>(y) * width_ + x) * stride_); }
  // Radiance of the texel that contains uv in [0,1)²; v counts down from the image's top row.
  Color Nearest(const Point2& uv) const { return TexelAt(NearestTexel(uv)); }
  // Bilinear between texel middles, clamped at the edges; v counts up from the image's lowest row, as on surfaces.
  Color OnSurface(const Point2& uv) const;

  Color Mean() const { return mean_; }

 private:
  const float* NearestTexel(const Point2& uv) const {
    // In double, like the lookup of a cell in the sampling table: both must find the same texel.
    const int x = std::clamp(static_cast<int>(static_cast<double>(uv.x) * width_), 0, width_ - 1);
    const int y = std::clamp(static_cast<int>(static_cast<double>(uv.y) * height_), 0, height_ - 1);
    return data_ + (static_cast<size_t>(y) * width_ + x) * stride_;
  }
  Color TexelAt(const float* texel) const { return {Clean(texel[r_]), Clean(texel[g_]), Clean(texel[b_])}; }

  // Texels from this value on are read as 0, so that scaled texels and sums of a few texels stay finite.
  static constexpr float kBrightestTexel = 1e37f;
  static float Clean(float value) { return value > 0 && value < kBrightestTexel ? value : 0.0f; }

  std::shared_ptr<const Image> image_;
  const float* data_ = nullptr;
  int width_ = 0, height_ = 0;
  size_t stride_ = 0, r_ = 0, g_ = 0, b_ = 0;
  Color mean_;
};

}  // namespace lampyr
