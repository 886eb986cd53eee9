// Differences between two images: MSE, relMSE, FLIP, mean bias with its confidence interval, z-tests of pixel blocks.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "film/image.h"

namespace lampyr {

struct BlockTest {
  int blockSize = 8;
  int blocks = 0;         // with information (variance > 0 or a difference)
  double largestZ = 0;    // largest |mean difference| / combined standard error
  double threshold = 0;   // Šidák-corrected two-sided threshold for the family-wise rate
  double chiSquared = 0;  // Σ z², against `blocks` degrees of freedom
  double chiSquaredThreshold = 0;
  bool Agrees() const { return largestZ <= threshold && chiSquared <= chiSquaredThreshold; }
};

// True if the variance is unknown because there is at most one sample per pixel. The integrator "light" traces as many
// light paths per sample as the image has pixels, and has a variance even then.
bool IsOfOneSample(const Image& image);

// Result of a comparison. CannotSay does not mean agreement: nothing was tested.
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
  // Equal: no value differs by more than rounding. Agree, Differ: result of the block test.
  Verdict verdict = Verdict::CannotSay;
  std::string reason;  // for CannotSay, in words
};

// Compares two images. Throws an Error if they differ in size or crop, have no R, G, B (nor gray), or contain values
// that are not finite, or if `blockSize` < 1. `familyWiseRate`: false-alarm rate of the block test as a whole, which
// tests R, G and B of each block (largestZ is over all of them) and the sum of squares of each channel (blocks and
// chiSquared are those of the worst channel). Variance layers are "variance.R" … (of the mean of a pixel) or "stderr.R"
// … (its standard error).
ImageDifference CompareImages(const Image& a, const Image& b, int blockSize = 8, double familyWiseRate = 1e-3);

// Errors of an image against a reference that is itself noisy: the variance of the reference (its variance layers) is
// part of every squared difference, and is subtracted. The result may be negative if the reference is as noisy as the
// image. FLIP compares the images as displayed with `exposureStops`; the contribution of the reference's noise to it is
// unknown.
struct ImageError {
  double mse = 0, relMse = 0, flip = 0;
  double bias = 0;  // mean difference over the reference's mean
};
ImageError MeasureError(const Image& image, const Image& reference, float exposureStops = 0);

// Error common to several independent images, as MSE and relMSE: the mean over all pairs of the product of their
// differences from the reference, in which the noise of the images cancels and that of the reference is subtracted; and
// the relMSE of one image that differs between them: their variance. Both together are the mean of MeasureError.
// `without`, `varyingWithout`: leave-one-out estimates of `relMse` and `varying`, for the jackknife; empty for two
// images.
struct CommonError {
  double mse = 0, relMse = 0;
  double varying = 0;
  std::vector<double> without, varyingWithout;
};
CommonError MeasureCommonError(std::span<const Image* const> images, const Image& reference);

// The root of the divisor of relMSE, pixel by pixel, R, G, B: sqrt(b² + 1 % of the mean of b²).
std::vector<Color> RelativeErrorDivisors(const Image& reference);

// Noise of the reference itself. Absent without variance layers.
struct ImageNoise {
  double mse = 0, relMse = 0;
  double relativeError = 0;  // root of mse over the mean
  double meanError = 0;      // standard error of the image mean, relative to it; pixels taken as independent
  // Standard errors of the result of subtracting the noise: squares of normal deviates minus their variance, which is
  // estimated from `parts` independent images. Channels are taken as fully correlated.
  double mseError = 0, relMseError = 0;
};
std::optional<ImageNoise> NoiseOf(const Image& reference, int parts);

// Mean over all pixels and R, G, B.
double MeanValue(const Image& image);

// An image of the differences: R, G and B are absolute differences, "relative.Y" is RelativeErrorMap. Throws as
// CompareImages does.
Image DifferenceImage(const Image& image, const Image& reference);

// Relative error per pixel: the square root of the pixel's term of relMse. Includes the noise of the reference.
std::vector<float> RelativeErrorMap(const Image& image, const Image& reference);

// Two-sided normal quantile: the |z| that is exceeded with probability `p`.
double NormalQuantileTwoSided(double p);
// The |t| that a Student variable with `degrees` > 0 degrees of freedom exceeds with probability `p`.
double StudentQuantileTwoSided(double p, double degrees);
// The value that a χ² variable with `degrees` degrees of freedom exceeds with probability `p`; and the probability of
// exceeding `value`.
double ChiSquaredQuantile(double p, double degrees);
double ChiSquaredTail(double value, double degrees);
// Rate per test for which `tests` independent tests have the family-wise rate [Sidak67].
double SidakRate(double familyWiseRate, int tests);

}  // namespace lampyr
