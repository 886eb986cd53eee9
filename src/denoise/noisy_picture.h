// The input of the denoiser: colour, variance, and two independent halves.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "denoise/denoise.h"
#include "denoise/plane.h"
#include "film/image.h"

namespace lampyr {

using ColorPlanes = std::array<Plane, 3>;  // R, G, B

struct NoisyPicture {
  double unit = 1;                    // of all values: a power of two near the median luminance
  ColorPlanes color, variance;        // without outliers; variance of the mean
  std::array<ColorPlanes, 2> halves;  // estimates of the same picture with independent noise
  std::array<double, 2> shares;       // of the halves in `color`: their sum is 1
  ColorPlanes excess;                 // of outliers over their surroundings; not included in `color`
  std::vector<uint8_t> isValid;       // colour and variance are finite, or interpolated from nearby pixels
  std::vector<uint8_t> isKept;        // too bright to be filtered: unchanged
  Plane noiseScale;                   // of `variance`: its size according to the halves
};

// Throws an Error if the image has no colour, no variance or fewer than two samples per pixel. Fills the report.
//
// Without a layer of half of the samples, two halves with independent noise are made from the picture p and its
// standard deviation σ: p + σg and p - σg with a normal g that depends on the position alone ([Rasines23]). This is
// exact for normal noise.
//
// Outliers: a pixel more than twice as bright as the third brightest of the 48 around it, and not significantly bright
// by its own samples (by less than four standard deviations), is reduced to that bound. The difference is `excess`.
NoisyPicture ReadNoisyPicture(const Image& image, int threads, DenoiseReport& report);

}  // namespace lampyr
