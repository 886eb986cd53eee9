// The RGB colour spaces of scene files and the way from each to ours, linear Rec. 709 with a D65 white.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <glm/mat3x3.hpp>

#include "math/vec.h"

namespace lampyr {

enum class RgbColorSpace { Srgb, DciP3, Rec2020, Aces2065 };

// The names of pbrt-v4: "srgb", "dci-p3", "rec2020", "aces2065-1". Upper and lower case are the same.
std::optional<RgbColorSpace> FindColorSpace(const std::string& name);
const std::vector<std::string>& ColorSpaceNames();

// What becomes of another white point than ours.
enum class WhiteHandling {
  Keep,   // light: the other space's white keeps its chromaticity, as a camera sees it
  Adapt,  // reflectances and coefficients: (1,1,1) stays (1,1,1); Bradford adaptation
};

// Linear RGB of `from` as linear Rec. 709; components outside the gamut come out negative or above 1.
Vector3d ToRec709(const Vector3d& rgb, RgbColorSpace from, WhiteHandling white);

// CIE 1931 XYZ (the white has Y = 1) as linear Rec. 709.
Vector3d XyzToRec709(const Vector3d& xyz);

// XYZ of a chromaticity at luminance 1.
Vector3d XyzOfChromaticity(double x, double y);

// Linear Rec. 709 as CIE 1931 XYZ: a matrix.
const glm::dmat3& Rec709ToXyz();

// White balance of linear Rec. 709: light of the given temperature becomes white (Bradford adaptation, [Lam85]). The
// light is CIE daylight ([CIE15]) from 4000 to 25000 K, and a black body ([Kim02]) from 1667 K to there. Throws an
// Error for a temperature beyond.
glm::dmat3 WhiteBalance(double kelvin);

// Negative components become 0 and the rest is scaled so that the luminance stays.
Color ClampToGamut(const Vector3d& rgb);

}  // namespace lampyr
