// The spectra of the fluorescent lamps F1 to F12 of the CIE. Internal to scene/.
#pragma once

#include "spectral/spectral_curve.h"

namespace lampyr {

inline constexpr int kFluorescentLamps = 12;

// Relative spectral power of lamp F`number`, from 1 to kFluorescentLamps; 0 below 380 and above 780 nm.
SpectralCurve FluorescentLamp(int number);

}  // namespace lampyr
