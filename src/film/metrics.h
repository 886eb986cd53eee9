// How far two images are apart: MSE, relMSE, FLIP, mean bias with its confidence interval, z-tests by pixel blocks.
#pragma once

#include <string>
#include <vector>

#include "film/image.h"

namespace lampyr {

struct BlockTest {
  int blockSize = 8;
  int blocks = 0;              // that carry information (variance > 0 or a difference)
  double largestZ = 0;         // of |mean difference| / combined standard error
  double threshold = 0;        // Šidák-corrected two-sided threshold for the family-wise rate
  double chiSquared = 0;       // Σ z², against `blocks` degrees of freedom
  double chiSquaredThreshold = 0;
  bool Agrees() const { return largestZ <= threshold && chiSquared <= chiSquaredThreshold; }
};

struct ImageDifference {
  double mse = 0;       // mean over pixels and RGB of (a-b)²
  double relMse = 0;    // (a-b)² / (b² + 1 % of the mean of b²); infinite against a black image
  double flip = 0;      // mean of the FLIP map, [0,1] (LDR-FLIP at 67 pixels per degree, images clipped to [0,1]; [Andersson20])
  double meanA = 0, meanB = 0;
  double bias = 0;      // mean (a-b) over pixels and channels, relative to meanB
  double biasInterval = 0;  // half width of its 95 % confidence interval, relative to meanB; from variance layers, else from the pixels
  bool hasBlockTest = false;  // both images have variance (or standard error) layers
  BlockTest blockTest;
};

// Throws Error when the images have different sizes, crops, no R, G, B (nor gray), or values that are not finite.
// `familyWiseRate` is for the block test as a whole: it tests each of R, G and B in each block (largestZ is over all of
// them) and the sum of squares of each channel (blocks and chiSquared are those of the worst channel). The variance layers
// are "variance.R" … (of the pixel's mean) or "stderr.R" … (its standard error).
ImageDifference CompareImages(const Image& a, const Image& b, int blockSize = 8, double familyWiseRate = 1e-3);

// Two-sided normal quantile: |z| that is exceeded with probability `p`.
double NormalQuantileTwoSided(double p);
// The value that a χ² variable with `degrees` of freedom exceeds with probability `p`; and that probability for a value.
double ChiSquaredQuantile(double p, double degrees);
double ChiSquaredTail(double value, double degrees);
// Šidák: per-test rate so that `tests` independent tests have the family-wise rate.
double SidakRate(double familyWiseRate, int tests);

}  // namespace lampyr
