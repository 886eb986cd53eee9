// The named spectra of pbrt-v4 as curves.
#include "scene/spectrum.h"

namespace lampyr {

namespace {

struct Glass {
  const char* name;
  SellmeierCoefficients coefficients;
};

// Of the manufacturer's data sheets. F10 and F11 of pbrt-v4 are SF10 and SF11, and F5 is SF5.
constexpr Glass kGlasses[] = {
    {"glass-BK7", {{1.03961212, 0.231792344, 1.01046945}, {0.00600069867, 0.0200179144, 103.560653}}},
    {"glass-F11", {{1.73759695, 0.313747346, 1.89878101}, {0.013188707, 0.0623068142, 155.23629}}},
};

}  // namespace

std::optional<SpectralCurve> FindNamedCurve(const std::string& name, SpectrumRole role) {
  for (const Glass& glass : kGlasses) {
    if (name != glass.name) continue;
    return SpectralCurve([&](double wavelength) { return glass.coefficients.IndexAt(wavelength); });
  }
  (void)role;
  return std::nullopt;
}

}  // namespace lampyr
