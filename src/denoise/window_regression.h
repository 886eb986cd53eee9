// Regression of the colours around each pixel on the features there ([Bitterli16 §4]).
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <vector>

#include "denoise/patch_distances.h"

namespace lampyr {

// The most features of a regression, besides a constant and the position in the picture.
inline constexpr size_t kMostFeatures = 7;

// A feature without its noise, and the variance of the noise that is left in it.
struct CleanFeature {
  Plane value, variance;
};

// Two independent estimates of the same picture, each filtered with weights that come from the other: weights that
// follow the noise of what they weight would favour one sign of it.
struct RegressionInput {
  std::array<std::array<Plane, 3>, 2> halves;  // R, G, B
  std::array<Guide, 2> guides;                 // of the halves
  std::vector<CleanFeature> features;          // kMostFeatures at most
  std::vector<uint8_t> isValid;                // others count for nothing
};

// The filtered halves. `weights` is 0 where no valid pixel is near.
struct RegressionOutput {
  std::array<std::array<Plane, 3>, 2> halves;
  std::array<Plane, 2> weights;
};

// The widths of weights that are tried: a difference of so many standard deviations is a distance of 1.
inline constexpr std::array<float, 3> kWidths = {0.25f, 0.5f, 1};

// Filters with each of kWidths. Every regression predicts all pixels of its window, and a pixel is the mean of its
// predictions by their weights. The result does not depend on the number of threads. `progress` is called with the
// fraction done, from any thread, one at a time. Returns when it has noticed that `interrupted` was set; the result is
// then of no use.
std::array<RegressionOutput, kWidths.size()> RegressInWindows(const RegressionInput& input, int threads,
                                                              const std::atomic<bool>& interrupted,
                                                              const std::function<void(double)>& progress);

}  // namespace lampyr
