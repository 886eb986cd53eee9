// The complex index of a metal in red, green and blue.
#pragma once

#include "math/vec.h"
#include "spectral/spectral_curve.h"

namespace lampyr {

struct MetalIndex {
  Color eta, k;
};

// Index by channel of a metal whose index is given by wavelength, chosen such that its reflectance at normal incidence
// has the colour of the metal's under D65, and that at 75° comes as near to it as possible. The mean index would give
// another colour, because reflectance is not linear in the index: red of gold would be 0.93 instead of 1. Reflectances
// are kept within [0,1], and colours outside of the gamut are therefore at its edge.
MetalIndex RgbIndexOf(const SpectralCurve& eta, const SpectralCurve& k);

}  // namespace lampyr
