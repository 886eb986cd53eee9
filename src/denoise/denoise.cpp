#include "denoise/denoise.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/error.h"
#include "base/parallel.h"
#include "denoise/clean_features.h"
#include "denoise/filter_error.h"
#include "denoise/noisy_picture.h"
#include "denoise/window_regression.h"

namespace lampyr {

namespace {

// Radii, in pixels, of the means of errors.
constexpr int kNear = 4, kFar = 12;

constexpr size_t kChoices = kWidths.size();
using Shares = std::array<Plane, kChoices>;

// Local means of variances: of a near or a wide neighbourhood, whichever is larger. The variance of a pixel is
// correlated with its own noise: a pixel that has missed the bright samples seems to have no noise, and would be
// averaged only with pixels like itself. The variance of rare contributions is proportional to the value.
Plane VarianceAround(const Plane& variance, const Plane& value, int threads) {
  constexpr int near = 1, far = 2;
  const Plane mean = BoxMeans(value, far, threads);
  Plane scale = mean;
  for (size_t i = 0; i < scale.Size(); ++i) {
    const float around = std::abs(mean.values[i]);
    scale.values[i] = around * (std::abs(value.values[i]) + 0.1f * around) + 1e-12f;
  }
  const Plane usual = MeanSquares(variance, scale, far, threads);
  Plane all = BoxMeans(variance, near, threads);
  for (size_t i = 0; i < all.Size(); ++i) all.values[i] = std::max(all.values[i], usual.values[i]);
  return all;
}

RegressionInput MakeInput(const NoisyPicture& picture, std::vector<CleanFeature> features, int threads) {
  RegressionInput input;
  input.halves = picture.halves;
  input.isValid = picture.isValid;
  input.features = std::move(features);
  for (size_t c = 0; c < 3; ++c) {
    const Plane around = VarianceAround(picture.variance[c], picture.color[c], threads);
    const Plane value = BoxMeans(picture.color[c], 1, threads);
    for (size_t half = 0; half < 2; ++half) {
      Plane variance = around;
      for (size_t i = 0; i < variance.Size(); ++i) {
        // Differences below this fraction of the value are invisible.
        const float unseen = 0.002f * value.values[i];
        variance.values[i] =
            variance.values[i] * picture.noiseScale.values[i] / static_cast<float>(picture.shares[half]) +
            unseen * unseen;
      }
      input.guides[half].values.push_back(picture.halves[half][c]);
      input.guides[half].variances.push_back(std::move(variance));
    }
  }
  return input;
}

// Limits the filtered halves to the values of the picture around each pixel: a regression rings beside a region that is
// much brighter than its surroundings.
void LimitToSurroundings(const NoisyPicture& picture, int threads, Halves& halves) {
  constexpr int radius = 2;
  const int width = picture.color[0].width, height = picture.color[0].height;
  ParallelFor(height, threads, [&](int y) {
    for (int x = 0; x < width; ++x) {
      for (size_t c = 0; c < 3; ++c) {
        const Plane& color = picture.color[c];
        float low = color.At(x, y), high = low;
        for (int j = std::max(y - radius, 0); j <= std::min(y + radius, height - 1); ++j) {
          for (int i = std::max(x - radius, 0); i <= std::min(x + radius, width - 1); ++i) {
            low = std::min(low, color.At(i, j));
            high = std::max(high, color.At(i, j));
          }
        }
        for (ColorPlanes& half : halves) half[c].At(x, y) = std::clamp(half[c].At(x, y), low, high);
      }
    }
  });
}

// The shares of the widths at each pixel: mainly the width of the smallest error, blended to avoid seams.
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

// Adds back the fraction of the residual that minimises the error if the filter has a bias b and the picture the
// variance σ²: b² / (b² + σ²). Residuals that are not significant are omitted, because they would return as a patch of
// noise.
void KeepDetail(const NoisyPicture& picture, const Filtered& filtered, const HalfStatistics& statistics, int threads,
                Halves& halves) {
  constexpr float kUnsure = 1, kSure = 4;  // standard errors of the squared bias
  Plane noise(picture.noiseScale.width, picture.noiseScale.height), scale = noise;
  for (size_t i = 0; i < noise.Size(); ++i) {
    for (size_t c = 0; c < 3; ++c) {
      noise.values[i] += picture.variance[c].values[i];
      scale.values[i] += filtered.value[c].values[i] * filtered.value[c].values[i];
    }
  }
  scale = BoxMeans(scale, 1, threads);
  for (float& value : scale.values) value += 1e-12f;
  // A pixel that has missed the bright samples seems to have no noise: the local mean limits its variance from below.
  const Plane usual = MeanSquares(noise, scale, kNear, threads);
  noise = BoxMeans(noise, 1, threads);
  for (size_t i = 0; i < noise.Size(); ++i) noise.values[i] = std::max(noise.values[i], usual.values[i]);
  for (size_t i = 0; i < noise.Size(); ++i) {
    if (!picture.isValid[i]) continue;
    const float variance = noise.values[i] * picture.noiseScale.values[i] * statistics.varianceFactor;
    float bias = 0, error = 0;
    for (size_t c = 0; c < 3; ++c) {
      bias += filtered.squaredBias[c].values[i];
      error += filtered.errorOfBias[c].values[i];
    }
    bias *= std::clamp((bias / error - kUnsure) / (kSure - kUnsure), 0.0f, 1.0f);
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

// States the larger one of the errors in a near and a wide neighbourhood: the remaining noise is smooth, so that a few
// pixels do not determine its size.
void StateMore(const Filtered& far, Filtered& near) {
  for (size_t c = 0; c < 3; ++c) {
    for (size_t i = 0; i < far.value[c].Size(); ++i) {
      float &variance = near.variance[c].values[i], &bias = near.squaredBias[c].values[i];
      bias = std::max({bias, far.squaredBias[c].values[i], 0.0f});
      variance = std::max(variance, far.variance[c].values[i]);
    }
  }
}

// Adds the light of outliers to the error around them: it is missing there, at unknown places.
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
    if (picture.isKept[i]) {
      for (size_t c = 0; c < front.size(); ++c) out[c] = in[copied[c]];
      continue;
    }
    const bool isKnown = weights[0].values[i] > 0 && weights[1].values[i] > 0;
    for (size_t c = 0; c < 3; ++c) {
      float value = picture.color[c].values[i], variance = picture.variance[c].values[i];
      if (isKnown) {
        // A regression may undershoot 0 beside a bright region.
        value = std::max(filtered.value[c].values[i], std::min(value, 0.0f));
        variance = filtered.variance[c].values[i] + std::max(filtered.squaredBias[c].values[i], 0.0f);
      }
      out[c] = static_cast<float>(picture.unit * static_cast<double>(value));
      out[3 + c] = static_cast<float>(picture.unit * picture.unit * static_cast<double>(variance));
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
  for (size_t k = 0; k < kChoices; ++k) {
    choices[k] = outputs[k].halves;
    LimitToSurroundings(picture, threads, choices[k]);
  }
  const HalfStatistics statistics(picture, choices.back());
  std::array<Filtered, kChoices> filtered;
  for (size_t k = 0; k < kChoices; ++k) filtered[k] = FilteredOf(picture, choices[k], statistics, kNear, threads);
  Halves halves = Blend(choices, ShareByError(filtered, threads));
  // The covariance of the halves is that of the median block. In blocks where samples are less stratified, it would be
  // mistaken for a bias.
  HalfStatistics uncorrelated = statistics;
  uncorrelated.covariance = 0;
  KeepDetail(picture, FilteredOf(picture, halves, uncorrelated, kNear, threads), statistics, threads, halves);
  Filtered result = FilteredOf(picture, halves, statistics, kNear, threads);
  StateMore(FilteredOf(picture, halves, statistics, kFar, threads), result);
  AddMissing(picture, threads, result);
  return MakeImage(noisy, picture, result, outputs[0].weights);
}

}  // namespace lampyr
