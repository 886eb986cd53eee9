// Reconstruction filters by filter importance sampling ([Ernst06]): a sample belongs to one pixel only, so that
// pixels are independent, a crop of a render equals a cropped render, and threads never share a pixel.
#pragma once

#include <memory>
#include <string>

#include "math/vec.h"
#include "sampling/tables.h"

namespace lampyr {

struct PixelFilterSettings {
  enum class Kind { Box, Triangle, Gaussian, Mitchell, Sinc };
  Kind kind = Kind::Gaussian;
  float radiusX = 1.5f, radiusY = 1.5f;  // pixels
  float sigma = 0.5f;                    // gaussian
  float b = 1.0f / 3, c = 1.0f / 3;      // mitchell
  float tau = 3;                         // sinc
};

class PixelFilter {
 public:
  explicit PixelFilter(const PixelFilterSettings& settings);

  struct Offset {
    Vector2 offset;    // from the pixel's centre, pixels
    float weight = 1;  // sign and magnitude of f/p, normalised to mean 1
  };
  // u in [0,1)².
  Offset Sample(const Point2& u) const;
  // The filter's value at an offset, normalised to ∫ = 1 (for splats).
  float Evaluate(const Vector2& offset) const;

 private:
  float Raw(const Vector2& offset) const;  // not normalised
  PixelFilterSettings settings_;
  float integral_ = 1;
  std::shared_ptr<const Distribution2D> table_;  // of |f|, for filters that have no closed inversion
};

}  // namespace lampyr
