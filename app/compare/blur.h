// The blur of pictures for which photons are merged within a radius: their bias, estimated from pictures at two radii.
//
// The bias of merging falls as r² where the density of photons is smooth, and as r at the edges of light and of
// surfaces ([Hachisuka08]; below a pixel, the share of a pixel that an edge's blur covers). So that of the radius q r
// is at most q times that of r, and the difference D of both bounds it:
//   |bias(q r)| <= q / (1 - q) · |D|,   |bias(r)| <= 1 / (1 - q) · |D|.
#pragma once

#include <span>

#include "film/image.h"

namespace lampyr {

// An amount of blur.
struct Blur {
  double relMse = 0;       // estimate above the noise, at least 0
  double relMseLimit = 0;  // upper bounds at 95 % confidence, one-sided
  double mseLimit = 0;
  double meanLimit = 0;     // of the absolute difference of the picture's mean, relative to it
  bool isFromZero = false;  // the estimate is significantly above 0, p < 0.01

  // The relative error of the blur (root of relMSE): the estimate, or its upper bound for a blur that is not
  // significant.
  double RelativeError() const;
  // Adds the blur of another picture to that of a mean of pictures: errors are added, because they have the same sign
  // at each pixel.
  void Add(const Blur& other, double weight);
  Blur Times(double factor) const;  // of the error; squares by its square
};

// The difference D between independent pictures wide[k] and narrow[k], which differ in the radius alone; at least four
// of each (otherwise an Error). The part common to all k is bias, the rest is noise. Relative to neighbourhoods of
// pixels.
Blur DifferenceOfRadii(std::span<const Image* const> wide, std::span<const Image* const> narrow);

// The mean radius of the samples `first` … `first` + `samples` - 1 of a pixel over that of sample 0, with the default
// alpha ([Knaus11 eq. 15]).
double RadiusOfSamples(uint32_t first, int samples);

// Samples of a pixel after which the radius is half of what it was.
inline constexpr uint32_t kSamplesToHalfRadius = 64;

}  // namespace lampyr
