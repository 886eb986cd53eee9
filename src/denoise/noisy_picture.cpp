#include "denoise/noisy_picture.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numbers>
#include <string>

#include "base/error.h"
#include "base/parallel.h"
#include "film/film.h"
#include "film/metrics.h"

namespace lampyr {

namespace {

constexpr const char* kColors[3] = {"R", "G", "B"};

// Planes of the channels PREFIX + R, G, B; empty planes if one of them is missing.
ColorPlanes ReadColors(const Image& image, const std::string& prefix) {
  ColorPlanes planes;
  for (size_t c = 0; c < 3; ++c) {
    const int channel = image.ChannelIndex(prefix + kColors[c]);
    if (channel < 0) return {};
    planes[c] = Plane(image.width, image.height);
    for (size_t i = 0; i < planes[c].Size(); ++i)
      planes[c].values[i] = image.data[i * image.channels.size() + static_cast<size_t>(channel)];
  }
  return planes;
}

int SamplesOf(const Image& image) {
  const auto found = image.metadata.find(kSamplesMetadata);
  return found == image.metadata.end() ? 0 : std::atoi(found->second.c_str());
}

void CheckChannels(const Image& image) {
  if (image.ChannelIndex("noisy.R") >= 0)
    throw Error("it has been denoised already: it has the layer \"noisy\", the picture as it was rendered");
  for (const char* channel : kColors) {
    if (image.ChannelIndex(channel) < 0) throw Error("it has no R, G and B channels");
  }
  if (ReadColors(image, "variance.")[0].Size() == 0) {
    throw Error(
        "it has no layers variance.R, .G and .B, which tell noise from detail: every picture of `lampyr render` has "
        "them, and --denoise adds features to it");
  }
  if (IsOfOneSample(image))
    throw Error("it has one sample per pixel, whose variance is unknown: render it with --spp 2 or more");
}

float Luminance(const ColorPlanes& color, size_t i) {
  return Color(color[0].values[i], color[1].values[i], color[2].values[i]).Luminance();
}

// Standard deviation of the luminance of a pixel, whose channels are taken as fully correlated.
float Deviation(const ColorPlanes& variance, size_t i) {
  return Color(std::sqrt(variance[0].values[i]), std::sqrt(variance[1].values[i]), std::sqrt(variance[2].values[i]))
      .Luminance();
}

// A power of two near the median luminance of the pixels that are not black; 1 in a black picture.
double UnitOf(const ColorPlanes& color) {
  std::vector<float> luminances;
  for (size_t i = 0; i < color[0].Size(); ++i) {
    const float luminance = Luminance(color, i);
    if (luminance > 0 && std::isfinite(luminance)) luminances.push_back(luminance);
  }
  if (luminances.empty()) return 1;
  const auto middle = luminances.begin() + static_cast<ptrdiff_t>(luminances.size() / 2);
  std::nth_element(luminances.begin(), middle, luminances.end());
  return std::exp2(std::round(std::log2(static_cast<double>(*middle))));
}

void Scale(double factor, ColorPlanes& planes) {
  for (Plane& plane : planes) {
    for (float& value : plane.values) value = static_cast<float>(factor * static_cast<double>(value));
  }
}

void FindValid(NoisyPicture& picture, DenoiseReport& report) {
  picture.isValid.assign(picture.color[0].Size(), 1);
  picture.isKept.assign(picture.color[0].Size(), 0);
  for (size_t i = 0; i < picture.isValid.size(); ++i) {
    bool isFinite = true;
    for (size_t c = 0; c < 3; ++c) {
      float& value = picture.color[c].values[i];
      float& variance = picture.variance[c].values[i];
      // Squares of larger values are not finite.
      constexpr float largest = 1e18f;
      if (std::abs(value) < largest && variance >= 0 && std::isfinite(variance)) continue;
      picture.isValid[i] = 0;
      isFinite = isFinite && std::isfinite(value) && variance >= 0;
    }
    if (picture.isValid[i]) continue;
    // Finite pixels that are too bright to be filtered are copied to the result.
    if (isFinite) picture.isKept[i] = 1;
    report.invalidPixels += isFinite ? 0 : 1;
    for (size_t c = 0; c < 3; ++c) picture.color[c].values[i] = picture.variance[c].values[i] = 0;
  }
}

// Replaces invalid pixels by the mean of the valid ones beside them, from the border of an invalid region to its
// middle.
void FillInvalid(NoisyPicture& picture) {
  const int width = picture.color[0].width, height = picture.color[0].height;
  const auto placeOf = [&](int x, int y) {
    return static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x);
  };
  // Calls visit(place) for the neighbours of a pixel.
  const auto forNeighbours = [&](size_t place, const auto& visit) {
    const auto x = static_cast<int>(place % static_cast<size_t>(width)),
               y = static_cast<int>(place / static_cast<size_t>(width));
    for (int j = std::max(y - 1, 0); j <= std::min(y + 1, height - 1); ++j) {
      for (int i = std::max(x - 1, 0); i <= std::min(x + 1, width - 1); ++i) visit(placeOf(i, j));
    }
  };
  const auto fill = [&](size_t place) {
    for (ColorPlanes* planes : {&picture.color, &picture.variance, &picture.halves[0], &picture.halves[1]}) {
      for (Plane& plane : *planes) {
        if (plane.Size() == 0) continue;
        float sum = 0, count = 0;
        forNeighbours(place, [&](size_t near) {
          if (!picture.isValid[near]) return;
          sum += plane.values[near];
          ++count;
        });
        plane.values[place] = sum / count;
      }
    }
  };
  std::vector<size_t> left, border;
  for (size_t place = 0; place < picture.isValid.size(); ++place) {
    if (!picture.isValid[place]) left.push_back(place);
  }
  while (!left.empty()) {
    border.clear();
    for (const size_t place : left) {
      bool hasValid = false;
      forNeighbours(place, [&](size_t near) { hasValid = hasValid || picture.isValid[near]; });
      if (hasValid) border.push_back(place);
    }
    if (border.empty()) throw Error("none of its pixels is finite");
    for (const size_t place : border) fill(place);
    for (const size_t place : border) picture.isValid[place] = 1;
    std::erase_if(left, [&](size_t place) { return picture.isValid[place]; });
  }
}

// The third largest luminance around a pixel, without the pixel itself; infinite in a picture of three pixels or fewer.
float ThirdAround(const Plane& luminance, int x, int y) {
  constexpr int radius = 3;
  if (luminance.Size() <= 3) return std::numeric_limits<float>::infinity();
  float largest[3] = {0, 0, 0};
  for (int j = std::max(y - radius, 0); j <= std::min(y + radius, luminance.height - 1); ++j) {
    for (int i = std::max(x - radius, 0); i <= std::min(x + radius, luminance.width - 1); ++i) {
      if (i == x && j == y) continue;
      float value = luminance.At(i, j);
      for (float& entry : largest) {
        if (value > entry) std::swap(value, entry);
      }
    }
  }
  return largest[2];
}

// Factors by which pixels are reduced; 1 for all but outliers.
Plane FindOutliers(const NoisyPicture& picture, int threads) {
  const int width = picture.color[0].width, height = picture.color[0].height;
  Plane luminance(width, height), factors(width, height, 1);
  for (size_t i = 0; i < luminance.Size(); ++i) luminance.values[i] = Luminance(picture.color, i);
  ParallelFor(height, threads, [&](int y) {
    for (int x = 0; x < width; ++x) {
      const size_t i = static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x);
      const float value = luminance.values[i];
      if (!(value > 0) || value > 4 * Deviation(picture.variance, i)) continue;
      const float limit = 2 * ThirdAround(luminance, x, y);
      if (value > limit) factors.values[i] = limit / value;
    }
  });
  return factors;
}

void RemoveOutliers(NoisyPicture& picture, int threads, DenoiseReport& report) {
  const Plane factors = FindOutliers(picture, threads);
  picture.excess.fill(Plane(factors.width, factors.height));
  double removed = 0, all = 0;
  for (size_t i = 0; i < factors.Size(); ++i) {
    const float factor = factors.values[i];
    const auto luminance = static_cast<double>(Luminance(picture.color, i));
    all += luminance;
    if (factor == 1) continue;
    ++report.outliers;
    removed += luminance * static_cast<double>(1 - factor);
    for (size_t c = 0; c < 3; ++c) {
      picture.excess[c].values[i] = (1 - factor) * picture.color[c].values[i];
      for (Plane* plane : {&picture.color[c], &picture.halves[0][c], &picture.halves[1][c]}) {
        if (plane->Size() > 0) plane->values[i] *= factor;
      }
      picture.variance[c].values[i] *= factor * factor;
    }
  }
  report.removed = all > 0 ? removed / all : 0;
}

// Reads the halves from the layer of half of the samples, which holds its share of the picture. False: no such layer.
bool ReadHalves(const Image& image, NoisyPicture& picture) {
  const ColorPlanes part = ReadColors(image, std::string(kHalfLayer) + ".");
  const int samples = SamplesOf(image);
  if (part[0].Size() == 0 || samples < 2) return false;
  const auto share = image.metadata.find(kHalfShareMetadata);
  picture.shares[0] = share != image.metadata.end()
                          ? std::atof(share->second.c_str())
                          : static_cast<double>(SamplesInHalf(static_cast<uint32_t>(samples))) / samples;
  // A picture of some parts of a render (merge --partial) may have samples of one half alone.
  if (!(picture.shares[0] > 0.01 && picture.shares[0] < 0.99)) return false;
  picture.shares[1] = 1 - picture.shares[0];
  const auto first = static_cast<float>(1 / picture.shares[0]), second = static_cast<float>(1 / picture.shares[1]);
  picture.halves[0] = picture.halves[1] = picture.color;
  for (size_t c = 0; c < 3; ++c) {
    for (size_t i = 0; i < part[c].Size(); ++i) {
      if (!picture.isValid[i]) continue;
      if (!std::isfinite(part[c].values[i])) return false;
      const auto of = static_cast<float>(static_cast<double>(part[c].values[i]) / picture.unit);
      picture.halves[0][c].values[i] = first * of;
      picture.halves[1][c].values[i] = second * (picture.color[c].values[i] - of);
    }
  }
  return true;
}

// A normally distributed number that depends on the position alone.
float NormalAt(size_t place) {
  const auto mix = [](uint64_t bits) {
    bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9;  // [Stafford11]
    bits = (bits ^ (bits >> 27)) * 0x94d049bb133111eb;
    return bits ^ (bits >> 31);
  };
  const auto unit = [](uint64_t bits) { return (static_cast<double>(bits >> 11) + 0.5) * 0x1p-53; };
  const uint64_t bits = mix(static_cast<uint64_t>(place) + 0x9e3779b97f4a7c15);
  const double radius = std::sqrt(-2 * std::log(unit(bits)));
  return static_cast<float>(radius * std::cos(2 * std::numbers::pi * unit(mix(bits))));
}

void MakeHalves(NoisyPicture& picture) {
  picture.shares = {0.5, 0.5};
  picture.halves[0] = picture.halves[1] = picture.color;
  for (size_t i = 0; i < picture.isValid.size(); ++i) {
    const float normal = NormalAt(i);  // one for all channels, whose noise is nearly the same
    for (size_t c = 0; c < 3; ++c) {
      const float noise = normal * std::sqrt(picture.variance[c].values[i]);
      picture.halves[0][c].values[i] += noise;
      picture.halves[1][c].values[i] -= noise;
    }
  }
}

// With stratified samples the noise is smaller than the variance, and splats are spread over several pixels: the size
// of the noise is estimated from the halves, its distribution over pixels from the variance, which is more precise.
Plane NoiseScale(const NoisyPicture& picture, bool hasHalves, int threads) {
  const int width = picture.color[0].width, height = picture.color[0].height;
  Plane seen(width, height), stated(width, height);
  if (!hasHalves) return Plane(width, height, 1);
  const auto scale = static_cast<float>(picture.shares[0] * picture.shares[1]);
  for (size_t i = 0; i < seen.Size(); ++i) {
    for (size_t c = 0; c < 3; ++c) {
      const float difference = picture.halves[0][c].values[i] - picture.halves[1][c].values[i];
      seen.values[i] += scale * difference * difference;
      stated.values[i] += picture.variance[c].values[i];
    }
  }
  constexpr int radius = 7;
  seen = BoxMeans(seen, radius, threads);
  stated = BoxMeans(stated, radius, threads);
  for (size_t i = 0; i < seen.Size(); ++i) {
    const float ratio = seen.values[i] / stated.values[i];
    seen.values[i] = stated.values[i] > 0 ? std::clamp(ratio, 0.1f, 2.0f) : 1;
  }
  return seen;
}

}  // namespace

NoisyPicture ReadNoisyPicture(const Image& image, int threads, DenoiseReport& report) {
  CheckChannels(image);
  NoisyPicture picture;
  picture.color = ReadColors(image, "");
  picture.variance = ReadColors(image, "variance.");
  picture.unit = UnitOf(picture.color);
  Scale(1 / picture.unit, picture.color);
  Scale(1 / (picture.unit * picture.unit), picture.variance);
  FindValid(picture, report);
  report.hasHalves = ReadHalves(image, picture);
  if (report.invalidPixels > 0) FillInvalid(picture);
  RemoveOutliers(picture, threads, report);
  if (!report.hasHalves) MakeHalves(picture);
  picture.noiseScale = NoiseScale(picture, report.hasHalves, threads);
  return picture;
}

}  // namespace lampyr
