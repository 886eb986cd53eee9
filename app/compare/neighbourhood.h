// Relative errors of noisy pictures without a reference: relative to the mean of a neighbourhood of the pixel.
//
// A pixel without any contribution yet would otherwise count as a dark one, and the contributions in another render as
// an error of unlimited size.
#pragma once

#include <array>
#include <vector>

#include "film/image.h"

namespace lampyr {

// The divisors of squared errors, by pixel and channel: the square of the mean of the 7 × 7 pixels around it, plus 1 %
// of the mean of these squares over the picture.
std::vector<std::array<double, 3>> NeighbourhoodSquares(const Image& image);

// relMSE of the noise of a picture, relative to its neighbourhoods. The picture must have layers of standard errors, as
// those of MeanOfImages, or of variances, as renders; otherwise an Error.
double RelativeNoise(const Image& mean);

}  // namespace lampyr
