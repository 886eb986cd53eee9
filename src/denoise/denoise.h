// Denoising of rendered pictures: first-order regression of colours on features ([Bitterli16]).
//
// Colours are regressed on the features of the first surface (albedo, normal, distance) and on the position in the
// picture, in a window around each pixel, with weights of non-local means. Two halves of the samples are filtered with
// picture, in a window around each pixel, with weights of non-local means. Two halves of the samples are filtered, each
// with weights from the other. The difference of the results is an estimate of the variance; the product of their
// residuals, whose noise is independent, is an estimate of the squared bias ([Bitterli16 §5] uses halves for the same
// purpose). Both determine the width of the weights pixel by pixel, and add up to the variance of the result.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>

#include "film/image.h"

namespace lampyr {

// Layers of a picture that is to be denoised, besides variance.R, .G, .B:
//   half.R, .G, .B           the part of the picture that comes from about half of its samples (Film::kHalfLayer)
//   feature.NAME             a feature, to separate edges from noise; a mean over some samples of each pixel
//   feature.variance.NAME    its variance
inline constexpr const char* kFeaturePrefix = "feature.";
inline constexpr const char* kFeatureVariancePrefix = "feature.variance.";

// Name of the metadata with the number of samples per pixel, from which the share of that half follows.
inline constexpr const char* kSamplesMetadata = "lampyr.samplesPerPixel";

// Statistics of the picture.
struct DenoiseReport {
  bool hasHalves = false, hasFeatures = false;
  int64_t invalidPixels = 0;  // not finite: replaced by values from around them
  int64_t outliers = 0;       // pixels reduced to the brightness of those around them
  double removed = 0;         // light removed from them, as a fraction of the mean luminance of the picture
};

// The denoised picture: R, G, B; variance.R, .G, .B, the expected squared error with the bias; noisy.R, .G, .B and
// noisy.variance.R, .G, .B, the input picture; then its other layers, unchanged. Without channels if `interrupted` was
// set. Throws an Error if the image has no R, G, B, no variance layers, or has been denoised already.
//
// The result does not depend on the number of threads. `progress` is called with the fraction done, from any thread,
// one at a time.
Image Denoise(const Image& noisy, int threads, const std::atomic<bool>& interrupted,
              const std::function<void(double)>& progress, DenoiseReport& report);

}  // namespace lampyr
