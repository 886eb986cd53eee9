// From spectra to linear RGB: pairs of wavelength and value, blackbodies, and the spectra that pbrt-v4 knows by name.
//
// How each role is computed:
//  - Illuminant: the colour of the light at luminance (Y) 1; a colour outside the gamut loses its negative components
//    and keeps its luminance.
//  - Albedo: the colour of the surface under D65, in [0,1]. A value of 1 at all wavelengths is exactly white.
//  - Unbounded (η, k, σ): per channel an average, weighted by the positive part of the channel's matching function
//    times D65. A constant spectrum gives that constant.
// Wavelengths are in nanometres, temperatures in kelvin.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scene/parameters.h"

namespace lampyr {

struct SpectrumSample {
  double wavelength = 0;
  double value = 0;
};

// Linear between the samples, zero outside them, as in pbrt-v4; for the role Unbounded the ends are continued instead.
// Wavelengths increase and values are not negative (SpectrumFromPairs sees to it).
Color SpectrumToColor(const std::vector<SpectrumSample>& spectrum, SpectrumRole role);

// A blackbody of `kelvin` > 0; roles other than Illuminant see it scaled to a maximum of 1.
Color BlackbodyToColor(double kelvin, SpectrumRole role);

// Checks a list λ0 v0 λ1 v1 …: at least two pairs, increasing wavelengths, nothing negative. Throws an Error at
// `where`.
std::vector<SpectrumSample> SpectrumFromPairs(const std::vector<double>& numbers, const FileLocation& where);

// A text file of such pairs, `#` starting a comment. Throws Errors that name the file.
std::vector<SpectrumSample> ReadSpectrumFile(const std::filesystem::path& file, const FileLocation& where);

// "metal-Au-eta", "glass-BK7", "stdillum-D65", …; nothing when there is no such spectrum.
std::optional<Color> FindNamedSpectrum(const std::string& name, SpectrumRole role);
const std::vector<std::string>& SpectrumNames();

}  // namespace lampyr
