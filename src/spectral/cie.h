// The CIE 1931 standard observer, daylight and black bodies. Internal to spectral/ and scene/.
#pragma once

#include "math/vec.h"

namespace lampyr {

inline constexpr double kLambdaMin = 360, kLambdaMax = 830;  // nm

// Colour matching functions x̄, ȳ, z̄ at a wavelength in nm, tabulated every 5 nm [CIE15]; 0 outside of the table.
Vector3d ColorMatching(double lambda);

// Relative spectral power of CIE daylight D65 (100 at 560 nm): the mean and two characteristic vectors, tabulated every
// 10 nm [CIE15].
double DaylightD65(double lambda);
// The same for another phase of daylight, by the weights M1 and M2 of the characteristic vectors.
double Daylight(double lambda, double m1, double m2);

// Planck's law at `kelvin`, up to a factor that keeps it in range for every temperature above 0.
double Blackbody(double lambda, double kelvin);

}  // namespace lampyr
