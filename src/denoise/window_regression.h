// Regression of the colours around each pixel on the features ([Bitterli16 §4]).
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <vector>

#include "denoise/patch_distances.h"

namespace lampyr {

// The maximum number of features of a regression, besides a constant and the position in the picture.
inline constexpr size_t kMostFeatures = 7;

// A denoised feature, and the variance of its remaining noise.
struct CleanFeature {
  Plane value, variance;
};

// Two independent estimates of the same picture, each filtered with weights from the other: weights that are correlated
// with the noise of the values that they weight would favour one sign of it.
struct RegressionInput {
  std::array<std::array<Plane, 3>, 2> halves;  // R, G, B
  std::array<Guide, 2> guides;                 // of the halves
  std::vector<CleanFeature> features;          // kMostFeatures at most
  std::vector<uint8_t> isValid;                // others are ignored
};

// The filtered halves. `weights` is 0 where no valid pixel is near.
struct RegressionOutput {
  std::array<std::array<Plane, 3>, 2> halves;
  std::array<Plane, 2> weights;
};

// The widths of weights that are tried: a difference of this many standard deviations is a distance of 1.
inline constexpr std::array<float, 3> kWidths = {0.25f, 0.5f, 1};

// Filters with each of kWidths. Every regression predicts all pixels of its window, and a pixel is the weighted mean of
// its predictions. The result does not depend on the number of threads. `progress` is called with the fraction done,
// from any thread, one at a time. Returns early if `interrupted` is set; the result is then meaningless.
std::array<RegressionOutput, kWidths.size()> RegressInWindows(const RegressionInput& input, int threads,
                                                              const std::atomic<bool>& interrupted,
                                                              const std::function<void(double)>& progress);

}  // namespace lampyr
