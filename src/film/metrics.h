// How far two images are apart: MSE, relMSE, FLIP, mean bias with its confidence interval, z-tests by pixel blocks.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "film/image.h"

namespace lampyr {

struct BlockTest {
  int blockSize = 8;
  int blocks = 0;         // that carry information (variance > 0 or a difference)
  double largestZ = 0;    // of |mean difference| / combined standard error
  double threshold = 0;   // Šidák-corrected two-sided threshold for the family-wise rate
  double chiSquared = 0;  // Σ z², against `blocks` degrees of freedom
  double chiSquaredThreshold = 0;
  bool Agrees() const { return largestZ <= threshold && chiSquared <= chiSquaredThreshold; }
};

// What can be said of two images. CannotSay is no agreement: nothing was tested.
enum class Verdict { Equal, Agree, Differ, CannotSay };
const char* NameOf(Verdict verdict);  // "equal", "agree", "differ", "cannot say"

struct ImageDifference {
  double mse = 0;     // mean over pixels and RGB of (a-b)²
  double relMse = 0;  // (a-b)² / (b² + 1 % of the mean of b²); infinite against a black image
  double flip =
      0;  // mean of the FLIP map, [0,1] (LDR-FLIP at 67 pixels per degree, images clipped to [0,1]; [Andersson20])
  double meanA = 0, meanB = 0;
  double bias = 0;  // mean (a-b) over pixels and channels, relative to meanB
  double biasInterval =
      0;  // half width of its 95 % confidence interval, relative to meanB; from variance layers, else from the pixels
  bool hasBlockTest = false;  // both images have variance (or standard error) layers, of two samples or more
  BlockTest blockTest;
  // Equal: no value differs by more than rounding. Agree, Differ: by the block test.
  Verdict verdict = Verdict::CannotSay;
  std::string reason;  // why it cannot be said
};

// Throws Error when the images have different sizes, crops, no R, G, B (nor gray), or values that are not finite.
// `familyWiseRate` is for the block test as a whole: it tests each of R, G and B in each block (largestZ is over all of
// them) and the sum of squares of each channel (blocks and chiSquared are those of the worst channel). The variance
// layers are "variance.R" … (of the pixel's mean) or "stderr.R" … (its standard error).
ImageDifference CompareImages(const Image& a, const Image& b, int blockSize = 8, double familyWiseRate = 1e-3);

// The errors of an image whose reference is itself a measurement: the variance of the reference's pixels (its variance
// layers) is part of every square of a difference, and is subtracted. Where the reference is as noisy as the image,
// what is left may be below 0. FLIP is of the images as shown with `exposureStops`; the part that the reference's noise
// has in it is not known.
struct ImageError {
  double mse = 0, relMse = 0, flip = 0;
  double bias = 0;  // mean difference over the reference's mean
};
ImageError MeasureError(const Image& image, const Image& reference, float exposureStops = 0);

// What is wrong in all of some independent images alike, as relMSE: the mean over their pairs of one's difference times
// the other's, in which the noise of neither is left, nor the reference's. `without`: the same without each of them.
struct CommonError {
  double relMse = 0;
  std::vector<double> without;  // empty for two images
};
CommonError MeasureCommonError(std::span<const Image* const> images, const Image& reference);

// The reference's own noise. Absent without variance layers.
struct ImageNoise {
  double mse = 0, relMse = 0;
  double relativeError = 0;  // root of mse over the mean
  double meanError = 0;      // standard error of the image's mean, relative to it; pixels taken as independent
  // Standard errors of what subtracting the noise leaves: squares of normal deviates less their variance, which is
  // known from `parts` independent images. Channels taken as fully correlated.
  double mseError = 0, relMseError = 0;
};
std::optional<ImageNoise> NoiseOf(const Image& reference, int parts);

// Mean over pixels and R, G, B.
double MeanValue(const Image& image);

// What is to be looked at: R, G and B are the absolute differences, "relative.Y" is RelativeErrorMap. Throws as
// CompareImages does.
Image DifferenceImage(const Image& image, const Image& reference);

// Each pixel's share of relMse, its root: the relative error of the pixel. The reference's noise is in it.
std::vector<float> RelativeErrorMap(const Image& image, const Image& reference);

// Two-sided normal quantile: |z| that is exceeded with probability `p`.
double NormalQuantileTwoSided(double p);
// |t| that a Student variable with `degrees` of freedom (above 0) exceeds with probability `p`.
double StudentQuantileTwoSided(double p, double degrees);
// The value that a χ² variable with `degrees` of freedom exceeds with probability `p`; and that probability for a
// value.
double ChiSquaredQuantile(double p, double degrees);
double ChiSquaredTail(double value, double degrees);
// Šidák: per-test rate so that `tests` independent tests have the family-wise rate.
double SidakRate(double familyWiseRate, int tests);

}  // namespace lampyr
