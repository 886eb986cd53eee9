#include "denoise/denoise.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/error.h"
#include "denoise/clean_features.h"
#include "denoise/noisy_picture.h"
#include "denoise/window_regression.h"

namespace lampyr {

namespace {

constexpr size_t kChoices = kWidths.size();
using Halves = std::array<ColorPlanes, 2>;
using Shares = std::array<Plane, kChoices>;

RegressionInput MakeInput(const NoisyPicture& picture, std::vector<CleanFeature> features, int threads) {
  RegressionInput input;
  input.halves = picture.halves;
  input.isValid = picture.isValid;
  input.features = std::move(features);
  for (size_t half = 0; half < 2; ++half) {
    for (size_t c = 0; c < 3; ++c) {
      // Means over neighbours: the variance of a pixel follows its own noise.
      Plane variance = BoxMeans(picture.variance[c], 1, threads);
      const Plane value = BoxMeans(picture.color[c], 1, threads);
      for (size_t i = 0; i < variance.Size(); ++i) {
        // Differences below this fraction of the value are not seen.
        const float unseen = 0.002f * value.values[i];
        variance.values[i] = variance.values[i] * picture.noiseScale.values[i] / static_cast<float>(picture.shares[half]) +
                             unseen * unseen;
      }
      input.guides[half].values.push_back(picture.halves[half][c]);
      input.guides[half].variances.push_back(std::move(variance));
    }
  }
  return input;
}

// A filtered picture and its error: of R, G, B.
struct Filtered {
  ColorPlanes value, variance, squaredBias;  // the latter two as means over neighbours
};

constexpr int kErrorRadius = 4;

// The mean of a quantity with the dimension of a square over neighbours, relative to the squared value: errors vary less
// in proportion to the value than as they are.
Plane MeanSquares(const Plane& squares, const Plane& scale, int threads) {
  Plane relative = squares;
  for (size_t i = 0; i < relative.Size(); ++i) relative.values[i] /= scale.values[i];
  relative = BoxMeans(BoxMeans(relative, kErrorRadius, threads), kErrorRadius, threads);
  for (size_t i = 0; i < relative.Size(); ++i) relative.values[i] *= scale.values[i];
  return relative;
}

// The correlation between the noise of the halves. It is below 0 where samples are stratified: those of one half fill
// the gaps of the other. It is that of the residuals of most blocks of pixels, which have no bias; their median.
float CorrelationOf(const NoisyPicture& picture, const Halves& halves) {
  constexpr int side = 16;
  const int width = picture.noiseScale.width, height = picture.noiseScale.height;
  std::vector<float> correlations;
  for (int y0 = 0; y0 < height; y0 += side) {
    for (int x0 = 0; x0 < width; x0 += side) {
      double product = 0, squares[2] = {0, 0};
      for (int y = y0; y < std::min(y0 + side, height); ++y) {
        for (int x = x0; x < std::min(x0 + side, width); ++x) {
          for (size_t c = 0; c < 3; ++c) {
            const auto scale = static_cast<double>(halves[0][c].At(x, y) + halves[1][c].At(x, y));
            if (!(scale > 0)) continue;
            const double a = static_cast<double>(halves[0][c].At(x, y) - picture.halves[0][c].At(x, y)) / scale;
            const double b = static_cast<double>(halves[1][c].At(x, y) - picture.halves[1][c].At(x, y)) / scale;
            product += a * b;
            squares[0] += a * a;
            squares[1] += b * b;
          }
        }
      }
      if (squares[0] * squares[1] > 0)
        correlations.push_back(static_cast<float>(product / std::sqrt(squares[0] * squares[1])));
    }
  }
  if (correlations.empty()) return 0;
  const auto middle = correlations.begin() + static_cast<ptrdiff_t>(correlations.size() / 2);
  std::nth_element(correlations.begin(), middle, correlations.end());
  return std::clamp(*middle, -0.9f, 0.0f);
}

// Of what is measured by the difference of the halves, as if they were independent.
struct HalfStatistics {
  float varianceFactor = 1;  // variance of their mean over what the difference tells
  float covariance = 0;      // over the square of the difference

  HalfStatistics(const NoisyPicture& picture, float correlation) {
    const auto root = static_cast<float>(std::sqrt(picture.shares[0] * picture.shares[1]));
    varianceFactor = (1 + 2 * root * correlation) / (1 - 2 * root * correlation);
    covariance = correlation * root / (1 - 2 * root * correlation);
  }
};

// The mean product of the residuals of the halves is the squared bias, and the covariance of their noise.
void EstimateError(const NoisyPicture& picture, const Halves& halves, const HalfStatistics& statistics, int threads,
                   Filtered& filtered) {
  const auto share = static_cast<float>(picture.shares[0] * picture.shares[1]) * statistics.varianceFactor;
  for (size_t c = 0; c < 3; ++c) {
    const Plane& value = filtered.value[c];
    Plane variance(value.width, value.height), bias = variance, scale = variance;
    const Plane mean = BoxMeans(value, kErrorRadius, threads);
    for (size_t i = 0; i < value.Size(); ++i) {
      const float around = mean.values[i];
      scale.values[i] = value.values[i] * value.values[i] + 0.1f * around * around + 1e-12f;
      const float a = halves[0][c].values[i], b = halves[1][c].values[i];
      variance.values[i] = share * (a - b) * (a - b);
      if (!picture.isValid[i]) continue;
      const float noisyA = picture.halves[0][c].values[i], noisyB = picture.halves[1][c].values[i];
      bias.values[i] = (a - noisyA) * (b - noisyB) - statistics.covariance * (noisyA - noisyB) * (noisyA - noisyB);
    }
    filtered.variance[c] = MeanSquares(variance, scale, threads);
    filtered.squaredBias[c] = MeanSquares(bias, scale, threads);
  }
}

ColorPlanes Mean(const NoisyPicture& picture, const Halves& halves) {
  ColorPlanes mean = halves[0];
  for (size_t c = 0; c < 3; ++c) {
    for (size_t i = 0; i < mean[c].Size(); ++i)
      mean[c].values[i] = static_cast<float>(picture.shares[0] * static_cast<double>(halves[0][c].values[i]) +
                                             picture.shares[1] * static_cast<double>(halves[1][c].values[i]));
  }
  return mean;
}

Filtered FilteredOf(const NoisyPicture& picture, const Halves& halves, const HalfStatistics& statistics, int threads) {
  Filtered filtered;
  filtered.value = Mean(picture, halves);
  EstimateError(picture, halves, statistics, threads, filtered);
  return filtered;
}

// The shares of the widths at each pixel: the one of the smallest error, blended so that no seam shows.
Shares ShareByError(const std::array<Filtered, kChoices>& filtered, int threads) {
  const int width = filtered[0].value[0].width, height = filtered[0].value[0].height;
  Shares shares;
  shares.fill(Plane(width, height));
  for (size_t i = 0; i < shares[0].Size(); ++i) {
    std::array<float, kChoices> errors{};
    for (size_t k = 0; k < kChoices; ++k) {
      for (size_t c = 0; c < 3; ++c)
        errors[k] += filtered[k].variance[c].values[i] + filtered[k].squaredBias[c].values[i];
    }
    const auto best = std::min_element(errors.begin(), errors.end()) - errors.begin();
    shares[static_cast<size_t>(best)].values[i] = 1;
  }
  for (Plane& share : shares) share = BoxMeans(share, 2, threads);
  return shares;
}

Halves Blend(const std::array<Halves, kChoices>& choices, const Shares& shares) {
  Halves halves;
  for (size_t half = 0; half < 2; ++half) {
    for (size_t c = 0; c < 3; ++c) {
      Plane& blended = halves[half][c] = Plane(shares[0].width, shares[0].height);
      for (size_t k = 0; k < kChoices; ++k) {
        const Plane& value = choices[k][half][c];
        for (size_t i = 0; i < blended.Size(); ++i) blended.values[i] += shares[k].values[i] * value.values[i];
      }
    }
  }
  return halves;
}

// Takes as much of the residual back as minimises the error where the filter has a bias b and the picture the variance
// σ²: b² / (b² + σ²).
void KeepDetail(const NoisyPicture& picture, const Filtered& filtered, const HalfStatistics& statistics, int threads,
                Halves& halves) {
  Plane noise(picture.noiseScale.width, picture.noiseScale.height);
  for (size_t c = 0; c < 3; ++c) {
    for (size_t i = 0; i < noise.Size(); ++i) noise.values[i] += picture.variance[c].values[i];
  }
  noise = BoxMeans(noise, 1, threads);
  for (size_t i = 0; i < noise.Size(); ++i) {
    if (!picture.isValid[i]) continue;
    const float variance = noise.values[i] * picture.noiseScale.values[i] * statistics.varianceFactor;
    // What is below the standard error of the squared bias is taken for none.
    constexpr float uncertain = 0.15f;
    float bias = -uncertain * variance;
    for (size_t c = 0; c < 3; ++c) bias += filtered.squaredBias[c].values[i];
    if (!(bias > 0)) continue;
    const float kept = bias / (bias + variance);
    for (size_t half = 0; half < 2; ++half) {
      for (size_t c = 0; c < 3; ++c) {
        float& value = halves[half][c].values[i];
        value += kept * (picture.halves[half][c].values[i] - value);
      }
    }
  }
}

// The light that outliers had is missing around them, nobody knows where exactly.
void AddMissing(const NoisyPicture& picture, int threads, Filtered& filtered) {
  constexpr int radius = 9;
  for (size_t c = 0; c < 3; ++c) {
    const Plane missing = BoxMeans(picture.excess[c], radius, threads);
    for (size_t i = 0; i < missing.Size(); ++i)
      filtered.squaredBias[c].values[i] += missing.values[i] * missing.values[i];
  }
}

Image MakeImage(const Image& noisy, const NoisyPicture& picture, const Filtered& filtered,
                const std::array<Plane, 2>& weights) {
  const std::vector<std::string> front = {"R", "G", "B", "variance.R", "variance.G", "variance.B"};
  std::vector<std::string> channels = front;
  std::vector<size_t> copied;  // channels of `noisy`
  for (const std::string& name : front) {
    channels.push_back("noisy." + name);
    copied.push_back(static_cast<size_t>(noisy.ChannelIndex(name)));
  }
  for (size_t c = 0; c < noisy.channels.size(); ++c) {
    if (std::find(front.begin(), front.end(), noisy.channels[c]) != front.end()) continue;
    channels.push_back(noisy.channels[c]);
    copied.push_back(c);
  }
  Image image(noisy.width, noisy.height, std::move(channels));
  image.metadata = noisy.metadata;
  image.offsetX = noisy.offsetX;
  image.offsetY = noisy.offsetY;
  image.fullWidth = noisy.fullWidth;
  image.fullHeight = noisy.fullHeight;
  for (size_t i = 0; i < picture.isValid.size(); ++i) {
    const float* in = noisy.data.data() + i * noisy.channels.size();
    float* out = image.data.data() + i * image.channels.size();
    for (size_t k = 0; k < copied.size(); ++k) out[front.size() + k] = in[copied[k]];
    for (size_t c = 0; c < 3; ++c) {
      const bool isKnown = weights[0].values[i] > 0 && weights[1].values[i] > 0;
      if (!isKnown) {  // no valid pixel is near
        out[c] = picture.color[c].values[i];
        out[3 + c] = picture.variance[c].values[i];
        continue;
      }
      // A regression may undershoot 0 beside something bright.
      out[c] = std::max(filtered.value[c].values[i], std::min(picture.color[c].values[i], 0.0f));
      out[3 + c] = filtered.variance[c].values[i] + std::max(filtered.squaredBias[c].values[i], 0.0f);
    }
  }
  return image;
}

}  // namespace

Image Denoise(const Image& noisy, int threads, const std::atomic<bool>& interrupted,
              const std::function<void(double)>& progress, DenoiseReport& report) {
  const NoisyPicture picture = ReadNoisyPicture(noisy, threads, report);
  std::vector<CleanFeature> features = CleanFeatures(noisy, threads, interrupted);
  report.hasFeatures = !features.empty();
  const RegressionInput input = MakeInput(picture, std::move(features), threads);
  const auto outputs = RegressInWindows(input, threads, interrupted, progress);
  if (interrupted.load()) return {};
  std::array<Halves, kChoices> choices;
  for (size_t k = 0; k < kChoices; ++k) choices[k] = outputs[k].halves;
  const HalfStatistics statistics(picture, CorrelationOf(picture, choices.back()));
  if (getenv("DBG")) fprintf(stderr, "corr %g\n", (double)CorrelationOf(picture, choices.back()));
  std::array<Filtered, kChoices> filtered;
  for (size_t k = 0; k < kChoices; ++k) filtered[k] = FilteredOf(picture, choices[k], statistics, threads);
  Halves halves = Blend(choices, ShareByError(filtered, threads));
  KeepDetail(picture, FilteredOf(picture, halves, statistics, threads), statistics, threads, halves);
  Filtered blended = FilteredOf(picture, halves, statistics, threads);
  AddMissing(picture, threads, blended);
  return MakeImage(noisy, picture, blended, outputs[0].weights);
}

}  // namespace lampyr
