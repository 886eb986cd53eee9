#include "extremes/extreme_case.h"

#include <cmath>
#include <cstdio>

namespace lampyr::test {

const std::vector<ExtremeGroup>& ExtremeGroups() {
  static const std::vector<ExtremeGroup> groups = {
      {"points", "Lights that are a point", PointLightCases},
      {"infinite", "Lights at infinity", InfiniteLightCases},
      {"areas", "Lights that are a surface", AreaLightCases},
      {"materials", "Materials and many bounces", MaterialCases},
      {"geometry", "Geometry and places", GeometryCases},
      {"photons", "Photons", PhotonCases},
      {"media", "Participating media", MediaCases},
      {"wavelengths", "Light by wavelength", WavelengthCases},
      {"cameras", "Cameras and film", CameraCases},
      {"degenerate", "Nothing there, and very much", DegenerateCases},
  };
  return groups;
}

std::string Number(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

std::string Numbers(std::initializer_list<double> values) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "" : " ") + Number(value);
  return text;
}

std::string Short(double value) {
  char text[40];
  const double exponent = value > 0 ? std::log10(value) : 0.5;
  if (std::abs(exponent) >= 3 && std::abs(exponent - std::round(exponent)) < 1e-9) {
    std::snprintf(text, sizeof text, "1e%d", static_cast<int>(std::lround(exponent)));
  } else {
    std::snprintf(text, sizeof text, "%g", value);
  }
  return text;
}

}  // namespace lampyr::test
