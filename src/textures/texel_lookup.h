// Image lookups by texture coordinates: (0,0) is the lower left corner, texel centres are at half-integer texel
// positions. No MIP maps: the samples of a pixel do the filtering.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <type_traits>

#include "film/image.h"
#include "math/vec.h"

namespace lampyr {

enum class WrapMode { Repeat, Black, Clamp, OctahedralSphere };

class TexelLookup {
 public:
  TexelLookup(std::shared_ptr<const Image> image, WrapMode wrap, bool bilinear);

  // A float is the mean of R, G and B; for an image whose alpha is not 1 everywhere it is the alpha, as in pbrt-v4.
  // Coordinates that are huge or not finite are clamped to ±2^30 texels (NaN to -2^30) before wrapping.
  Color LookupColor(const Point2& st) const { return Lookup<Color>(st); }
  float LookupFloat(const Point2& st) const { return Lookup<float>(st); }

 private:
  // Integer texel and fraction along one axis. Extreme coordinates are clamped, so that the cast is defined.
  struct Texel {
    int index;
    float fraction;
  };
  static Texel Split(float x) {
    const float bounded = x > -0x1p30f ? std::min(x, 0x1p30f) : -0x1p30f;  // -2^30 for NaN
    const float whole = std::floor(bounded);
    return {static_cast<int>(whole), bounded - whole};
  }

  template <class Value>
  Value Lookup(Point2 st) const {
    // Whole repetitions are removed first, so that only the border needs the slower WrapInside.
    if (wrap_ == WrapMode::Repeat) st -= Point2(std::floor(st.x), std::floor(st.y));
    const float x = st.x * static_cast<float>(width_), y = (1 - st.y) * static_cast<float>(height_);
    if (!bilinear_) return At<Value>(Split(x).index, Split(y).index);
    const Texel u = Split(x - 0.5f), v = Split(y - 0.5f);
    const auto row = [&](int j) {
      return At<Value>(u.index, j) * (1 - u.fraction) + At<Value>(u.index + 1, j) * u.fraction;
    };
    return row(v.index) * (1 - v.fraction) + row(v.index + 1) * v.fraction;
  }

  template <class Value>
  Value At(int x, int y) const {
    const bool inside = static_cast<unsigned>(x) < static_cast<unsigned>(width_) &&
                        static_cast<unsigned>(y) < static_cast<unsigned>(height_);
    if (!inside && !WrapInside(x, y)) return Value{};
    const float* texel =
        data_ + (static_cast<size_t>(y) * static_cast<size_t>(width_) + static_cast<size_t>(x)) * stride_;
    if constexpr (std::is_same_v<Value, float>) {
      return isMean_ ? (texel[red_] + texel[green_] + texel[blue_]) * (1.0f / 3) : texel[float_];
    } else {
      return Value(texel[red_], texel[green_], texel[blue_]);
    }
  }

  // Maps a texel outside of the image into it by the wrap mode; false if it is black.
  bool WrapInside(int& x, int& y) const;

  std::shared_ptr<const Image> image_;  // owns what data_ points to
  const float* data_;
  int width_, height_;
  size_t stride_, red_, green_, blue_;
  size_t float_;  // the channel of floats, if they are not means
  bool isMean_;
  WrapMode wrap_;
  bool bilinear_;
};

}  // namespace lampyr
