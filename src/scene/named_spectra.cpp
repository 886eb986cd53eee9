// The named spectra of pbrt-v4 as RGB: η and k of metals and oxides, indices of glasses, and CIE illuminants.
//
// Metals and oxides: values at 630, 532 and 465 nm, within 0.5 % of the tables of pbrt-v4. Ag, Al, Au and Cu are those
// collected in [Palik85]; MgO is by the formula of [Stephens52], TiO2 by that of [Devore51] for the extraordinary ray
// of rutile; CuZn (brass, 70 % Cu): [Querry85]. Glasses: n_d of the manufacturer's data sheet, without dispersion.
// Illuminants: their chromaticities for the 1931 observer [CIE15].
#include <algorithm>
#include <array>

#include "scene/spectrum.h"
#include "spectral/color_space.h"

namespace lampyr {

namespace {

struct NamedColor {
  const char* name;
  std::array<double, 3> rgb;
};

constexpr NamedColor kCoefficients[] = {
    {"metal-Ag-eta", {0.134, 0.130, 0.140}},
    {"metal-Ag-k", {3.96, 3.20, 2.61}},
    {"metal-Al-eta", {1.36, 0.885, 0.660}},
    {"metal-Al-k", {7.59, 6.47, 5.65}},
    {"metal-Au-eta", {0.184, 0.457, 1.37}},
    {"metal-Au-k", {3.07, 2.41, 1.82}},
    {"metal-Cu-eta", {0.246, 1.07, 1.16}},
    {"metal-Cu-k", {3.38, 2.59, 2.46}},
    {"metal-CuZn-eta", {0.445, 0.568, 0.947}},
    {"metal-CuZn-k", {3.52, 2.59, 1.92}},
    {"metal-MgO-eta", {1.735, 1.742, 1.750}},
    {"metal-MgO-k", {0, 0, 0}},
    {"metal-TiO2-eta", {2.874, 2.978, 3.117}},
    {"metal-TiO2-k", {0, 0, 0}},
    {"glass-BK7", {1.5168, 1.5168, 1.5168}},
    {"glass-BAF10", {1.6700, 1.6700, 1.6700}},
    {"glass-FK51A", {1.4866, 1.4866, 1.4866}},
    {"glass-LASF9", {1.8503, 1.8503, 1.8503}},
    {"glass-F5", {1.6727, 1.6727, 1.6727}},
    {"glass-F10", {1.7283, 1.7283, 1.7283}},  // F5, F10, F11 of pbrt-v4 are SF5 …
    {"glass-F11", {1.7847, 1.7847, 1.7847}},
};

struct NamedIlluminant {
  const char* name;
  double x, y;
};

constexpr NamedIlluminant kIlluminants[] = {
    {"stdillum-A", 0.44758, 0.40745},    {"stdillum-D50", 0.34567, 0.35850}, {"stdillum-D65", 0.3127, 0.3290},
    {"stdillum-F1", 0.3131, 0.3371},     {"stdillum-F2", 0.3721, 0.3751},    {"stdillum-F3", 0.4091, 0.3941},
    {"stdillum-F4", 0.4402, 0.4031},     {"stdillum-F5", 0.3138, 0.3452},    {"stdillum-F6", 0.3779, 0.3882},
    {"stdillum-F7", 0.3129, 0.3292},     {"stdillum-F8", 0.3458, 0.3586},    {"stdillum-F9", 0.3741, 0.3727},
    {"stdillum-F10", 0.3458, 0.3588},    {"stdillum-F11", 0.3805, 0.3769},   {"stdillum-F12", 0.4370, 0.4042},
    {"illum-acesD60", 0.32168, 0.33767},
};

}  // namespace

std::optional<Color> FindNamedSpectrum(const std::string& name, SpectrumRole role) {
  for (const NamedColor& entry : kCoefficients) {
    if (name != entry.name) continue;
    const Color color(static_cast<float>(entry.rgb[0]), static_cast<float>(entry.rgb[1]),
                      static_cast<float>(entry.rgb[2]));
    if (role != SpectrumRole::Albedo) return color;
    return Color(std::min(color.r, 1.0f), std::min(color.g, 1.0f), std::min(color.b, 1.0f));
  }
  for (const NamedIlluminant& entry : kIlluminants) {
    if (name != entry.name) continue;
    if (name == "stdillum-D65") return Color(1.0f);
    const Color color = ClampToGamut(XyzToRec709(XyzOfChromaticity(entry.x, entry.y)));
    return role == SpectrumRole::Albedo ? color * (1.0f / color.Max()) : color;
  }
  return std::nullopt;
}

const std::vector<std::string>& SpectrumNames() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list;
    for (const NamedColor& entry : kCoefficients) list.push_back(entry.name);
    for (const NamedIlluminant& entry : kIlluminants) list.push_back(entry.name);
    return list;
  }();
  return names;
}

}  // namespace lampyr
