// The error over spatial frequencies, in the form of the error spectrum ensemble of [Celarek19]: the power spectra of
// the errors of several renders, averaged over rings of equal frequency; their mean, and their spread over the renders.
#pragma once

#include <span>
#include <vector>

#include "film/image.h"

namespace lampyr {

// A ring of frequencies. Densities are relMSE per unit of the frequency plane, whose unit square holds all frequencies
// of a picture: noise that is independent from pixel to pixel has the density of its relMSE at every frequency.
struct SpectrumRing {
  double frequency = 0;      // cycles per pixel, mean of the ring; 0: the mean of the picture
  double share = 0;          // part of relMSE; the shares of all rings sum up to it
  double density = 0;        // mean over the renders
  double low = 0, high = 0;  // 10 % and 90 % of the renders are below it
  double deviation = 0;      // standard deviation over the renders
  double common = 0;         // density of the part common to all renders: the bias
};

// The spectrum from at least two independent renders. The error is relative to the reference as in relMSE, channel by
// channel, so that, by Parseval's theorem, the sum of the shares is the mean relMSE of the renders. The picture is
// continued periodically. `referenceNoise`: relMSE of the reference's own noise, which is subtracted as noise that is
// independent from pixel to pixel. Rings are as wide as the lowest frequency, or 12 % of their own.
std::vector<SpectrumRing> ErrorSpectrum(std::span<const Image* const> images, const Image& reference,
                                        double referenceNoise, int threads);

}  // namespace lampyr
