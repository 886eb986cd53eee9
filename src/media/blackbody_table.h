// The light of hot gas: colours of blackbodies by temperature.
#pragma once

#include <vector>

#include "math/vec.h"

namespace lampyr {

inline constexpr float kColdestGlow = 100;  // K; a colder gas is dark, as in pbrt-v4
inline constexpr float kHottestGas = 1e6f;  // K

// NormalizedBlackbody, accurate to 0.1 % from 700 K on, interpolated in the logarithms of temperature and luminance.
class BlackbodyTable {
 public:
  // Made at the first call.
  static const BlackbodyTable& Get();

  // Radiance at a temperature in kelvin, which may be anything: 0 up to kColdestGlow, constant from kHottestGas on.
  Color At(float kelvin) const;

 private:
  BlackbodyTable();

  struct Entry {
    float logLuminance = 0;
    Color color;  // at luminance 1
  };
  std::vector<Entry> entries_;  // evenly in log T from kColdestGlow to kHottestGas
};

// Conversion of the values of a medium's temperature grid to kelvin: (value - offset) · scale.
struct TemperatureScale {
  float offset = 0, scale = 1;

  float Kelvin(float value) const { return (value - offset) * scale; }
};

}  // namespace lampyr
