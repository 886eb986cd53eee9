// The film: sums of samples per pixel in double, their variance, and the image made of them.
#pragma once

#include <cstdint>
#include <vector>

#include "film/image.h"
#include "math/vec.h"

namespace lampyr {

struct PixelRect {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;  // half open
  int Width() const { return x1 - x0; }
  int Height() const { return y1 - y0; }
};

// Sums of one pixel. A sample with filter weight w and value L adds w·L; the pixel is Σ wL / Σ w.
struct PixelSums {
  double sum[3] = {0, 0, 0};
  double sumOfSquares[3] = {0, 0, 0};  // of w·L
  double weight = 0;
  uint64_t count = 0;

  void Add(const Color& value, float filterWeight);
};

class Film {
 public:
  // `crop` in pixels of the full image.
  Film(int fullWidth, int fullHeight, const PixelRect& crop);

  const PixelRect& Crop() const { return crop_; }
  // Pixels are independent: two threads may work on two pixels at once.
  PixelSums& Pixel(int x, int y) { return pixels_[static_cast<size_t>(y - crop_.y0) * crop_.Width() + (x - crop_.x0)]; }
  const PixelSums& Pixel(int x, int y) const { return const_cast<Film*>(this)->Pixel(x, y); }

  // R, G, B and variance.R, .G, .B: the variance of the pixel's mean (sample variance / n; an upper bound for
  // stratified samplers).
  Image Develop() const;

  // Estimated relative error of the image at 95 % confidence: 1.96 · sqrt(mean variance of the pixels' means) over
  // mean luminance. Infinite while there are fewer than 2 samples per pixel.
  double RelativeError() const;

 private:
  int fullWidth_, fullHeight_;
  PixelRect crop_;
  std::vector<PixelSums> pixels_;
};

}  // namespace lampyr
