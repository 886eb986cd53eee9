// Relative errors of noisy pictures without a reference: relative to the mean of a neighbourhood of the pixel.
//
// A pixel that has caught no light yet would otherwise count as a dark one, and what another render finds there as an
// error of any size.
#pragma once

#include <array>
#include <vector>

#include "film/image.h"

namespace lampyr {

// What errors of a pixel are relative to, for each pixel and channel: the square of the mean of the 7 × 7 pixels around
// it, plus 1 % of the mean of these squares over the picture.
std::vector<std::array<double, 3>> NeighbourhoodSquares(const Image& image);

// relMSE of the noise of a picture, relative to its neighbourhoods. The picture must have layers of standard errors, as
// MeanOfImages writes them, or of variances, as renders do; else an Error.
double RelativeNoise(const Image& mean);

}  // namespace lampyr
