// The sRGB transfer function (IEC 61966-2-1) and its inverse on [0,1]; extended beyond by the same formulas.
#pragma once

#include <cmath>

namespace lampyr {

inline float SrgbToLinear(float encoded) {
  return encoded <= 0.04045f ? encoded * (1.0f / 12.92f) : std::pow((encoded + 0.055f) * (1.0f / 1.055f), 2.4f);
}

inline float LinearToSrgb(float linear) {
  return linear <= 0.0031308f ? linear * 12.92f : 1.055f * std::pow(linear, 1.0f / 2.4f) - 0.055f;
}

}  // namespace lampyr
