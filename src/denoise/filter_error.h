// The error of a filtered picture, from two filtered halves of its samples.
//
// With halves A, B of a picture that is filtered to F_A, F_B, the difference F_A - F_B gives the variance. The
// residuals F_A - A and F_B - B share the bias of the filter, but not the noise: the mean of their product is the
// squared bias. No model of the noise is needed, and it may be correlated between pixels.
#pragma once

#include "denoise/noisy_picture.h"

namespace lampyr {

using Halves = std::array<ColorPlanes, 2>;

// Consequences of the correlation between the noise of the halves. It is negative if samples are stratified: those of
// one half fill the gaps of the other, and the picture has less noise than the difference of the halves suggests.
struct HalfStatistics {
  float varianceFactor = 1;  // variance of the mean of the halves over its estimate from their difference
  float covariance = 0;      // of the halves, over the squared difference

  // From the residuals of filtered halves. In most blocks of pixels the filter has no bias, and their correlation is
  // that of the noise: the median over blocks. Not above 0.
  HalfStatistics(const NoisyPicture& picture, const Halves& filtered);
};

// A filtered picture and its error: of R, G, B.
struct Filtered {
  ColorPlanes value;
  ColorPlanes variance, squaredBias;  // means over neighbours; the latter may be negative, as it is an estimate
  ColorPlanes errorOfBias;            // standard error of squaredBias
};

// The mean of two filtered halves by their shares. `radius`: of the means over neighbours, pixels.
Filtered FilteredOf(const NoisyPicture& picture, const Halves& halves, const HalfStatistics& statistics, int radius,
                    int threads);

// Mean over neighbours of a quantity with the dimension of a square, computed relative to `scale`, the squared value:
// relative errors vary less than absolute ones.
Plane MeanSquares(const Plane& squares, const Plane& scale, int radius, int threads);

}  // namespace lampyr
