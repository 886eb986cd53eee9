// The named spectra of pbrt-v4 as curves.
//
// Glasses: dispersion formulas of the manufacturer's data sheets. pbrt-v4 has the lead-free types, and so does lampyr:
// BAF10, LASF9, F5, F10 and F11 are N-BAF10, N-LASF9, N-SF5, N-SF10 and N-SF11.
//
// Metals and oxides: Ag, Al, Au and Cu as collected in [Palik85], at each tenth of an electronvolt; CuZn (brass, 70 %
// Cu) of [Querry85]; MgO by the formula of [Stephens52] for its whole range; TiO2 by that of [Devore51] for the
// extraordinary ray, which is valid from 430 nm on and is extrapolated below. The oxides do not absorb.
//
// Illuminants [CIE15]: A by its formula, D50, D65 and D60 of ACES by the vectors of daylight, F1 to F12 by tables.
#include <algorithm>
#include <array>
#include <cmath>

#include "scene/fluorescent_lamps.h"
#include "scene/spectrum.h"
#include "spectral/cie.h"

namespace lampyr {

namespace {

struct Glass {
  const char* name;
  SellmeierCoefficients coefficients;
};

constexpr Glass kGlasses[] = {
    {"glass-BK7", {{1.03961212, 0.231792344, 1.01046945}, {0.00600069867, 0.0200179144, 103.560653}}},
    {"glass-BAF10", {{1.5851495, 0.143559385, 1.08521269}, {0.00926681282, 0.0424489805, 105.613573}}},
    {"glass-FK51A", {{0.971247817, 0.216901417, 0.904651666}, {0.00472301995, 0.0153575612, 168.68133}}},
    {"glass-LASF9", {{2.00029547, 0.298926886, 1.80691843}, {0.0121426017, 0.0538736236, 156.530829}}},
    {"glass-F5", {{1.52481889, 0.187085527, 1.42729015}, {0.011254756, 0.0588995392, 129.141675}}},
    {"glass-F10", {{1.62153902, 0.256287842, 1.64447552}, {0.0122241457, 0.0595736775, 147.468793}}},
    {"glass-F11", {{1.73759695, 0.313747346, 1.89878101}, {0.013188707, 0.0623068142, 155.23629}}},
};

template <size_t count>
struct Table {
  const char* name;
  std::array<double, count> values;
};

// Values at the photon energies 1.4, 1.5, … 3.5 eV.
constexpr double kFirstEnergy = 1.4, kEnergyStep = 0.1;
constexpr double kElectronvoltNanometres = 1239.841984;  // hc
constexpr Table<22> kMetals[] = {
    {"metal-Ag-eta", {0.163, 0.145, 0.143, 0.148, 0.14, 0.14,  0.131, 0.121, 0.12, 0.129, 0.13,
                      0.13,  0.132, 0.144, 0.157, 0.16, 0.173, 0.173, 0.192, 0.2,  0.186, 0.209}},
    {"metal-Ag-k", {5.95, 5.5,  5.09, 4.74, 4.44, 4.15, 3.88, 3.66, 3.45, 3.25, 3.07,
                    2.88, 2.72, 2.56, 2.4,  2.26, 2.11, 1.95, 1.81, 1.67, 1.61, 1.44}},
    {"metal-Al-eta", {2.24,  2.74,  2.63,  2.14,  1.74,  1.49,  1.3,  1.15, 1.02,  0.912, 0.826,
                      0.755, 0.695, 0.644, 0.598, 0.558, 0.523, 0.49, 0.46, 0.432, 0.407, 0.385}},
    {"metal-Al-k", {8.21, 8.31, 8.6,  8.57, 8.21, 7.82, 7.48, 7.15, 6.85, 6.55, 6.28,
                    6.03, 5.8,  5.58, 5.38, 5.2,  5.02, 4.86, 4.71, 4.56, 4.43, 4.3}},
    {"metal-Au-eta", {0.21,  0.188, 0.176, 0.164, 0.16,  0.166, 0.194, 0.236, 0.306, 0.402, 0.608,
                      0.916, 1.242, 1.426, 1.562, 1.616, 1.636, 1.658, 1.674, 1.696, 1.716, 1.74}},
    {"metal-Au-k", {5.88, 5.39,  4.86,  4.357, 3.8,  3.15,  3.06,  2.97,  2.88,  2.54,  2.12,
                    1.84, 1.796, 1.846, 1.904, 1.94, 1.958, 1.956, 1.936, 1.906, 1.862, 1.848}},
    {"metal-Cu-eta", {0.3,   0.26, 0.25, 0.223, 0.213, 0.214, 0.272, 0.468, 0.826, 1.04, 1.12,
                      1.135, 1.15, 1.16, 1.17,  1.175, 1.18,  1.175, 1.18,  1.225, 1.27, 1.29}},
    {"metal-Cu-k", {5.717, 5.26,  4.817, 4.43,  4.05,  3.67, 3.24, 2.809, 2.599, 2.583, 2.605,
                    2.564, 2.504, 2.433, 2.362, 2.289, 2.21, 2.13, 2.21,  2.015, 1.95,  1.916}},
};

// Values at the wavelengths 360, 380, … 840 nm.
constexpr double kFirstOfBrass = 360, kBrassStep = 20;
constexpr Table<25> kBrass[] = {
    {"metal-CuZn-eta", {1.503, 1.487, 1.445, 1.35,  1.191, 0.994, 0.816, 0.686, 0.602, 0.549, 0.505, 0.468, 0.45,
                        0.449, 0.444, 0.445, 0.444, 0.446, 0.45,  0.455, 0.458, 0.464, 0.473, 0.481, 0.486}},
    {"metal-CuZn-k", {1.815, 1.818, 1.805, 1.786, 1.797, 1.883, 2.046, 2.25,  2.464, 2.668, 2.86,  3.059, 3.253,
                      3.434, 3.609, 3.778, 3.943, 4.106, 4.266, 4.424, 4.579, 4.737, 4.89,  5.039, 5.192}},
};

// Linear between the entries and their midpoints. The value at a midpoint is that of the cubic through the four entries
// around it: straight lines from entry to entry would miss the edge of gold by 2 %.
template <size_t count>
double Interpolate(const std::array<double, count>& values, double position) {
  const auto half = [&](size_t i) {
    const double before = values[i / 2];
    if (i % 2 == 0) return before;
    const double after = values[i / 2 + 1];
    if (i / 2 == 0 || i / 2 + 2 == count) return 0.5 * (before + after);
    return (9 * (before + after) - values[i / 2 - 1] - values[i / 2 + 2]) / 16;
  };
  const double halves = 2 * std::clamp(position, 0.0, static_cast<double>(count - 1));
  const size_t i = std::min(static_cast<size_t>(halves), 2 * count - 3);
  return std::lerp(half(i), half(i + 1), halves - static_cast<double>(i));
}

double SquaredMicrometres(double wavelength) {
  return wavelength * wavelength * 1e-6;
}

double MagnesiumOxide(double wavelength) {
  const double squared = SquaredMicrometres(wavelength);
  return std::sqrt(2.956362 + 0.0219577 / (squared - 0.01428322) - 0.01062387 * squared -
                   2.04968e-5 * squared * squared);
}

double Rutile(double wavelength) {
  return std::sqrt(7.197 + 0.3322 / (SquaredMicrometres(wavelength) - 0.0843));
}

// η, k and indices.
std::optional<SpectralCurve> FindCoefficient(const std::string& name) {
  for (const Glass& glass : kGlasses) {
    if (name == glass.name)
      return SpectralCurve([&](double wavelength) { return glass.coefficients.IndexAt(wavelength); });
  }
  for (const auto& table : kMetals) {
    if (name != table.name) continue;
    return SpectralCurve([&](double wavelength) {
      return Interpolate(table.values, (kElectronvoltNanometres / wavelength - kFirstEnergy) / kEnergyStep);
    });
  }
  for (const auto& table : kBrass) {
    if (name != table.name) continue;
    return SpectralCurve(
        [&](double wavelength) { return Interpolate(table.values, (wavelength - kFirstOfBrass) / kBrassStep); });
  }
  if (name == "metal-MgO-eta") return SpectralCurve(MagnesiumOxide);
  if (name == "metal-TiO2-eta") return SpectralCurve(Rutile);
  if (name == "metal-MgO-k" || name == "metal-TiO2-k") return SpectralCurve();
  return std::nullopt;
}

// A is a black body of 2848 K by the second radiation constant of its time, 1.435e-2 m·K.
double IlluminantA(double wavelength) {
  constexpr double kRadiationThen = 1.435e7, kRadiationNow = 1.438776877e7;
  return Blackbody(wavelength, 2848 * kRadiationNow / kRadiationThen);
}

// Relative spectral powers.
std::optional<SpectralCurve> FindPower(const std::string& name) {
  if (name == "stdillum-A") return SpectralCurve(IlluminantA);
  // Weights as in the table of D50 [CIE15], and by the chromaticity of D60.
  if (name == "stdillum-D50")
    return SpectralCurve([](double wavelength) { return Daylight(wavelength, -1.039, 0.363); });
  if (name == "stdillum-D65") return SpectralCurve(DaylightD65);
  if (name == "illum-acesD60")
    return SpectralCurve([](double wavelength) { return Daylight(wavelength, -0.531, -0.495); });
  for (int number = 1; number <= kFluorescentLamps; ++number) {
    if (name == "stdillum-F" + std::to_string(number)) return FluorescentLamp(number);
  }
  return std::nullopt;
}

}  // namespace

std::optional<SpectralCurve> FindNamedCurve(const std::string& name, SpectrumRole role) {
  if (const auto curve = FindCoefficient(name)) {
    if (role != SpectrumRole::Albedo) return curve;
    return SpectralCurve([&](double wavelength) { return std::min(curve->At(wavelength), 1.0); });
  }
  const auto power = FindPower(name);
  if (!power) return std::nullopt;
  // D65 is exactly white.
  if (name == "stdillum-D65" && role != SpectrumRole::Albedo) return SpectralCurve([](double) { return 1.0; });
  // A power distribution that is given as a coefficient is treated as light, as in RGB.
  return CurveOfPower(*power, role == SpectrumRole::Albedo ? role : SpectrumRole::Illuminant);
}

}  // namespace lampyr
