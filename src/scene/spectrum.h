// Conversion of spectra to linear RGB: pairs of wavelength and value, blackbodies, and the named spectra of pbrt-v4.
//
// Conversion by role:
// - Illuminant: the colour of the light at luminance (Y) 1. A colour outside of the gamut loses its negative components
//   and keeps its luminance.
// - Albedo: the colour of the surface under D65, in [0,1]. A value of 1 at all wavelengths is exactly white.
// - Unbounded (η, k, σ): per channel, an average weighted by the positive part of the channel's matching function times
//   D65. A constant spectrum gives that constant.
//
// Wavelengths are in nanometres, temperatures in kelvin.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scene/parameters.h"
#include "spectral/spectral_curve.h"

namespace lampyr {

struct SpectrumSample {
  double wavelength = 0;
  double value = 0;
};

// Interpolates linearly between the samples. Outside of them the spectrum is 0, as in pbrt-v4; for the role Unbounded,
// the ends are continued. Wavelengths have to increase and values must not be negative (SpectrumFromPairs checks this).
Color SpectrumToColor(const std::vector<SpectrumSample>& spectrum, SpectrumRole role);

// The colour of a blackbody of `kelvin` > 0; for roles other than Illuminant, of its spectrum scaled to a maximum of 1.
Color BlackbodyToColor(double kelvin, SpectrumRole role);

// The light of a blackbody of `kelvin` > 0 whose spectrum is scaled to a maximum of 1 per nanometre, over all
// wavelengths and not the visible ones alone (BlackbodySpectrum of pbrt-v4): the luminance, ∫ ȳ(λ) L(λ) dλ, depends on
// the temperature. It is 100.7 at 6000 K, and 9.6e-4 at 1000 K.
Color NormalizedBlackbody(double kelvin);

// Converts a list λ0 v0 λ1 v1 …. Throws an Error at `where` unless it has at least two pairs, increasing wavelengths
// that are not all below 100 nm (micrometres), and no negative values; for the role Albedo, none above 1 by more than
// the error of measurements (1.1).
std::vector<SpectrumSample> SpectrumFromPairs(const std::vector<double>& numbers, SpectrumRole role,
                                              const FileLocation& where);

// Reads a text file of such pairs; `#` starts a comment. Throws Errors at the pair in the file.
std::vector<SpectrumSample> ReadSpectrumFile(const std::filesystem::path& file, SpectrumRole role,
                                             const FileLocation& where);

// "metal-Au-eta", "glass-BK7", "stdillum-D65", …; nullopt for other names.
std::optional<Color> FindNamedSpectrum(const std::string& name, SpectrumRole role);
const std::vector<std::string>& SpectrumNames();

// Curves, for transport by wavelength. Of illuminants, blackbodies and lights: relative to D65 and at luminance 1.

// Averaged over each nanometre.
SpectralCurve CurveOf(const std::vector<SpectrumSample>& spectrum, SpectrumRole role);
SpectralCurve BlackbodyCurve(double kelvin, SpectrumRole role);
// nullopt for a name without a curve.
std::optional<SpectralCurve> FindNamedCurve(const std::string& name, SpectrumRole role);
// A spectral power distribution, in any unit, converted for a role: for an illuminant, scaled to luminance 1 and
// divided by D65; for a reflectance, scaled to a maximum of 1.
SpectralCurve CurveOfPower(const SpectralCurve& power, SpectrumRole role);

}  // namespace lampyr
