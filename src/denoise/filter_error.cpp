#include "denoise/filter_error.h"

#include <algorithm>
#include <cmath>

namespace lampyr {

namespace {

constexpr int kBlock = 16;

// The correlation between the residuals of the halves in a block of pixels, relative to their values; 0: no residuals.
float BlockCorrelation(const NoisyPicture& picture, const Halves& halves, int x0, int y0) {
  double product = 0, squares[2] = {0, 0};
  for (int y = y0; y < std::min(y0 + kBlock, picture.noiseScale.height); ++y) {
    for (int x = x0; x < std::min(x0 + kBlock, picture.noiseScale.width); ++x) {
      for (size_t c = 0; c < 3; ++c) {
        const auto scale = static_cast<double>(halves[0][c].At(x, y) + halves[1][c].At(x, y));
        if (!(scale > 0)) continue;
        const auto residual = [&](size_t half) {
          return static_cast<double>(halves[half][c].At(x, y) - picture.halves[half][c].At(x, y)) / scale;
        };
        product += residual(0) * residual(1);
        squares[0] += residual(0) * residual(0);
        squares[1] += residual(1) * residual(1);
      }
    }
  }
  const double both = squares[0] * squares[1];
  return both > 0 ? static_cast<float>(product / std::sqrt(both)) : 0;
}

float CorrelationOf(const NoisyPicture& picture, const Halves& halves) {
  std::vector<float> correlations;
  for (int y0 = 0; y0 < picture.noiseScale.height; y0 += kBlock) {
    for (int x0 = 0; x0 < picture.noiseScale.width; x0 += kBlock)
      correlations.push_back(BlockCorrelation(picture, halves, x0, y0));
  }
  const auto middle = correlations.begin() + static_cast<ptrdiff_t>(correlations.size() / 2);
  std::nth_element(correlations.begin(), middle, correlations.end());
  return std::clamp(*middle, -0.9f, 0.0f);
}

// The standard error of MeanSquares, `means`, from the variation of `squares` around each pixel.
Plane ErrorOfMean(const Plane& squares, const Plane& means, const Plane& scale, int radius, int threads) {
  Plane products = squares;
  for (size_t i = 0; i < products.Size(); ++i) {
    const float relative = squares.values[i] / scale.values[i];
    products.values[i] = relative * relative;
  }
  products = BoxMeans(BoxMeans(products, radius, threads), radius, threads);
  // Σ w² of two means over 2 r + 1 pixels in a row is 2 / (3 (2 r + 1)), up to terms of higher order.
  const float independent = 1.5f * static_cast<float>(2 * radius + 1);
  for (size_t i = 0; i < products.Size(); ++i) {
    const float mean = means.values[i] / scale.values[i];
    products.values[i] = scale.values[i] * std::sqrt(std::max(products.values[i] - mean * mean, 0.0f)) / independent;
  }
  return products;
}

// The mean product of the residuals of the halves is the squared bias plus the covariance of their noise.
void EstimateError(const NoisyPicture& picture, const Halves& halves, const HalfStatistics& statistics, int radius,
                   int threads, Filtered& filtered) {
  const auto share = static_cast<float>(picture.shares[0] * picture.shares[1]) * statistics.varianceFactor;
  for (size_t c = 0; c < 3; ++c) {
    const Plane& value = filtered.value[c];
    Plane variance(value.width, value.height), bias = variance, scale = variance;
    const Plane mean = BoxMeans(value, radius, threads);
    for (size_t i = 0; i < value.Size(); ++i) {
      const float around = mean.values[i];
      scale.values[i] = value.values[i] * value.values[i] + 0.1f * around * around + 1e-12f;
      const float a = halves[0][c].values[i], b = halves[1][c].values[i];
      variance.values[i] = share * (a - b) * (a - b);
      if (!picture.isValid[i]) continue;
      const float noisyA = picture.halves[0][c].values[i], noisyB = picture.halves[1][c].values[i];
      bias.values[i] = (a - noisyA) * (b - noisyB) - statistics.covariance * (noisyA - noisyB) * (noisyA - noisyB);
    }
    filtered.variance[c] = MeanSquares(variance, scale, radius, threads);
    filtered.squaredBias[c] = MeanSquares(bias, scale, radius, threads);
    filtered.errorOfBias[c] = ErrorOfMean(bias, filtered.squaredBias[c], scale, radius, threads);
  }
}

ColorPlanes MeanOf(const NoisyPicture& picture, const Halves& halves) {
  ColorPlanes mean = halves[0];
  for (size_t c = 0; c < 3; ++c) {
    for (size_t i = 0; i < mean[c].Size(); ++i)
      mean[c].values[i] = static_cast<float>(picture.shares[0] * static_cast<double>(halves[0][c].values[i]) +
                                             picture.shares[1] * static_cast<double>(halves[1][c].values[i]));
  }
  return mean;
}

}  // namespace

HalfStatistics::HalfStatistics(const NoisyPicture& picture, const Halves& filtered) {
  // The variances of the halves are inverse to their shares.
  const float correlation = CorrelationOf(picture, filtered);
  const auto root = static_cast<float>(std::sqrt(picture.shares[0] * picture.shares[1]));
  varianceFactor = (1 + 2 * root * correlation) / (1 - 2 * root * correlation);
  covariance = correlation * root / (1 - 2 * root * correlation);
}

Plane MeanSquares(const Plane& squares, const Plane& scale, int radius, int threads) {
  Plane relative = squares;
  for (size_t i = 0; i < relative.Size(); ++i) relative.values[i] /= scale.values[i];
  relative = BoxMeans(BoxMeans(relative, radius, threads), radius, threads);
  for (size_t i = 0; i < relative.Size(); ++i) relative.values[i] *= scale.values[i];
  return relative;
}

Filtered FilteredOf(const NoisyPicture& picture, const Halves& halves, const HalfStatistics& statistics, int radius,
                    int threads) {
  Filtered filtered;
  filtered.value = MeanOf(picture, halves);
  EstimateError(picture, halves, statistics, radius, threads, filtered);
  return filtered;
}

}  // namespace lampyr
