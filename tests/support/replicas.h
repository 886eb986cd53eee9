// Comparing two ways of rendering a scene by independent replicas: the same picture with other seeds, some times each.
//
// The spread of a block's mean over the replicas is its error, whatever correlates the pixels of one picture (a splat
// covers as many pixels as the filter does) and however well its samples are stratified. Differences of block means are
// Student-distributed; they are turned into normal deviates by Wallace's formula ([Wallace59 eq. 4.2]), good to 1e-2
// deviates for the degrees of freedom here, and judged at a family-wise rate ([Šidák67]).
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "film/metrics.h"
#include "support/render_scene.h"

namespace lampyr::test {

struct Replicas {
  std::vector<Image> images;
  uint64_t faults = 0;  // dropped samples and rejected rays
};

inline Replicas RenderReplicas(const SceneDescription& description, const std::string& integrator, int count,
                               int samplesPerPixel, RenderOverrides overrides = {}) {
  overrides.integrator = integrator;
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  BuiltScene built = BuildScene(description, overrides, true, diagnostics);
  Replicas replicas;
  for (int i = 0; i < count; ++i) {
    built.settings.seed = overrides.seed + static_cast<uint64_t>(i);
    const Rendered rendered = RenderBuilt(built, samplesPerPixel, 1);
    replicas.images.push_back(rendered.image);
    replicas.faults += rendered.outcome.counts.droppedSamples + rendered.rejectedRays;
  }
  return replicas;
}

inline Replicas RenderReplicas(const std::string& text, const std::string& integrator, int count, int samplesPerPixel,
                               RenderOverrides overrides = {}) {
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  return RenderReplicas(ParseScene(text, std::string(LAMPYR_SOURCE_DIR) + "/scenes/test.pbrt", diagnostics), integrator,
                        count, samplesPerPixel, overrides);
}

struct Agreement {
  int blocks = 0;
  double largestZ = 0, thresholdZ = 0;
  double chiSquared = 0, chiSquaredThreshold = 0;
  double meanZ = 0, meanThreshold = 0;
  double bias = 0, biasError = 0;  // of the whole image, relative

  bool Agrees() const {
    return largestZ <= thresholdZ && chiSquared <= chiSquaredThreshold && std::abs(meanZ) <= meanThreshold;
  }
};

namespace replicas_internal {

struct Moments {
  double mean = 0, variance = 0;  // of the mean
};

inline Moments MomentsOf(const std::vector<double>& values) {
  Moments result;
  const double n = static_cast<double>(values.size());
  for (const double v : values) result.mean += v / n;
  for (const double v : values) result.variance += (v - result.mean) * (v - result.mean) / (n * (n - 1));
  return result;
}

// Means of channel `c` over a rectangle, by replica.
inline std::vector<double> Means(const Replicas& replicas, size_t c, int x0, int y0, int x1, int y1) {
  std::vector<double> means;
  for (const Image& image : replicas.images) {
    double sum = 0;
    for (int y = y0; y < y1; ++y) {
      for (int x = x0; x < x1; ++x) sum += static_cast<double>(image.At(x, y, c));
    }
    means.push_back(sum / ((x1 - x0) * (y1 - y0)));
  }
  return means;
}

// The normal deviate that is as improbable as the difference of the means. Means that are equal but for the rounding of
// sums in float are equal.
inline double Deviate(const Moments& a, const Moments& b, double replicas) {
  const double rounding = 1e-6 * std::max(std::abs(a.mean), std::abs(b.mean));
  const double variance = a.variance + b.variance + rounding * rounding;
  if (!(variance > 0)) return 0;
  // Welch's degrees of freedom.
  const double v =
      std::pow(variance, 2) * (replicas - 1) / (std::pow(a.variance, 2) + std::pow(b.variance, 2) + 1e-300);
  const double nu = std::min(v, 1e6);
  const double t = (a.mean - b.mean) / std::sqrt(variance);
  return std::copysign((8 * nu + 1) / (8 * nu + 3) * std::sqrt(nu * std::log1p(t * t / nu)), t);
}

}  // namespace replicas_internal

// `scale` multiplies `a`: what a wrong picture would give.
inline Agreement CompareReplicas(const Replicas& a, const Replicas& b, int blockSize, double rate, double scale = 1) {
  using namespace replicas_internal;
  const int width = a.images[0].width, height = a.images[0].height;
  const double n = static_cast<double>(std::min(a.images.size(), b.images.size()));
  const auto deviate = [&](size_t c, int x0, int y0, int x1, int y1, Agreement* whole) {
    Moments first = MomentsOf(Means(a, c, x0, y0, x1, y1));
    const Moments second = MomentsOf(Means(b, c, x0, y0, x1, y1));
    first.mean *= scale;
    first.variance *= scale * scale;
    if (whole) {
      whole->bias = (first.mean - second.mean) / second.mean;
      whole->biasError = std::sqrt(first.variance + second.variance) / second.mean;
    }
    return Deviate(first, second, n);
  };
  Agreement result;
  double chiSquared[3] = {0, 0, 0};
  for (int y = 0; y < height; y += blockSize) {
    for (int x = 0; x < width; x += blockSize) {
      ++result.blocks;
      for (size_t c = 0; c < 3; ++c) {
        const double z = deviate(c, x, y, std::min(x + blockSize, width), std::min(y + blockSize, height), nullptr);
        result.largestZ = std::max(result.largestZ, std::abs(z));
        chiSquared[c] += z * z;
      }
    }
  }
  result.chiSquared = *std::max_element(chiSquared, chiSquared + 3);
  result.meanZ = deviate(1, 0, 0, width, height, &result);
  const double third = SidakRate(rate, 3);
  result.thresholdZ = NormalQuantileTwoSided(SidakRate(third, 3 * result.blocks));
  result.chiSquaredThreshold = ChiSquaredQuantile(SidakRate(third, 3), result.blocks);
  result.meanThreshold = NormalQuantileTwoSided(third);
  return result;
}

}  // namespace lampyr::test
