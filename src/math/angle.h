// Angles whose unit is part of the type: degrees cannot be passed where radians are expected.
#pragma once

#include "math/vec.h"

namespace lampyr {

struct Radians {
  float value = 0;
  constexpr explicit Radians(float radians) : value(radians) {}
};

struct Degrees {
  float value = 0;
  constexpr explicit Degrees(float degrees) : value(degrees) {}
  constexpr operator Radians() const { return Radians(value * (kPi / 180.0f)); }
};

inline float Cos(Radians a) {
  return std::cos(a.value);
}
inline float Sin(Radians a) {
  return std::sin(a.value);
}
inline float Tan(Radians a) {
  return std::tan(a.value);
}

}  // namespace lampyr
