// Sums per pixel in double and the image made of them. Radiance in W/(m² sr); a million samples do not drift.
#include "film/film.h"

#include <cmath>
#include <limits>
#include <string>

#include "base/error.h"

namespace lampyr {

namespace {

// What a pixel's sums are divided by. Filter weights have mean 1, so Σw is near n; filters with negative lobes can
// cancel it when there are few samples, and then n itself is used, which keeps the pixel finite and unbiased.
double Divisor(const PixelSums& pixel) {
  const double n = static_cast<double>(pixel.count);
  return pixel.weight > 0.1 * n ? pixel.weight : n;
}

// Variance of the pixel's mean: sample variance of w·L over n, in units of the mean weight. 0 below 2 samples.
double VarianceOfMean(const PixelSums& pixel, int channel) {
  if (pixel.count < 2) return 0;
  const double n = static_cast<double>(pixel.count);
  const double mean = pixel.sum[channel] / n;
  const double sampleVariance = std::max(0.0, pixel.sumOfSquares[channel] / n - mean * mean) * (n / (n - 1));
  const double scale = n / Divisor(pixel);
  return sampleVariance / n * scale * scale;
}

// Intensities of 1e30 have variances that leave float: the largest float stands for them.
float ToFiniteFloat(double value) {
  constexpr double largest = std::numeric_limits<float>::max();
  return static_cast<float>(std::clamp(value, -largest, largest));
}

}  // namespace

void PixelSums::Add(const Color& value, float filterWeight) {
  const double w = static_cast<double>(filterWeight);
  const double weighted[3] = {w * static_cast<double>(value.r), w * static_cast<double>(value.g),
                              w * static_cast<double>(value.b)};
  for (int c = 0; c < 3; ++c) {
    sum[c] += weighted[c];
    sumOfSquares[c] += weighted[c] * weighted[c];
  }
  weight += w;
  ++count;
}

Film::Film(int fullWidth, int fullHeight, const PixelRect& crop)
    : fullWidth_(fullWidth), fullHeight_(fullHeight), crop_(crop) {
  const bool inside = crop.x0 >= 0 && crop.y0 >= 0 && crop.x1 <= fullWidth && crop.y1 <= fullHeight;
  if (!inside || crop.Width() <= 0 || crop.Height() <= 0) {
    throw Error("the crop holds no pixel of the " + std::to_string(fullWidth) + " x " + std::to_string(fullHeight) +
                " image, or pixels outside of it");
  }
  pixels_.resize(static_cast<size_t>(crop.Width()) * static_cast<size_t>(crop.Height()));
}

Image Film::Develop() const {
  Image image(crop_.Width(), crop_.Height(), {"R", "G", "B", "variance.R", "variance.G", "variance.B"});
  image.offsetX = crop_.x0;
  image.offsetY = crop_.y0;
  image.fullWidth = fullWidth_;
  image.fullHeight = fullHeight_;
  float* out = image.data.data();
  for (const PixelSums& pixel : pixels_) {
    const double inverse = pixel.count > 0 ? 1.0 / Divisor(pixel) : 0.0;
    for (int c = 0; c < 3; ++c) *out++ = ToFiniteFloat(pixel.sum[c] * inverse);
    for (int c = 0; c < 3; ++c) *out++ = ToFiniteFloat(VarianceOfMean(pixel, c));
  }
  return image;
}

double Film::RelativeError() const {
  constexpr double luminance[3] = {0.2126390, 0.7151687, 0.0721923};  // as Color::Luminance
  double varianceSum = 0, luminanceSum = 0;
  for (const PixelSums& pixel : pixels_) {
    if (pixel.count < 2) return std::numeric_limits<double>::infinity();
    // The channels of a sample share its path: taken as fully correlated, which bounds the variance from above.
    double deviation = 0, value = 0;
    for (int c = 0; c < 3; ++c) {
      deviation += luminance[c] * std::sqrt(VarianceOfMean(pixel, c));
      value += luminance[c] * pixel.sum[c];
    }
    varianceSum += deviation * deviation;
    luminanceSum += value / Divisor(pixel);
  }
  if (varianceSum == 0) return 0;  // black or constant: nothing left to improve
  const double n = static_cast<double>(pixels_.size());
  const double meanLuminance = luminanceSum / n;
  if (!(meanLuminance > 0)) return std::numeric_limits<double>::infinity();
  return 1.959963984540054 * std::sqrt(varianceSum / n) / meanLuminance;
}

}  // namespace lampyr
