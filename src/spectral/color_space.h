// The RGB colour spaces of scene files, and their conversion to the working space, linear Rec. 709 with a D65 white.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include <glm/mat3x3.hpp>

#include "math/vec.h"

namespace lampyr {

enum class RgbColorSpace { Srgb, DciP3, Rec2020, Aces2065 };

// Finds a colour space by its name in pbrt-v4: "srgb", "dci-p3", "rec2020", "aces2065-1", case ignored.
std::optional<RgbColorSpace> FindColorSpace(const std::string& name);
const std::vector<std::string>& ColorSpaceNames();

// Treatment of a white point other than D65.
enum class WhiteHandling {
  Keep,   // light: the white keeps its chromaticity, as a camera sees it
  Adapt,  // reflectances and coefficients: (1,1,1) stays (1,1,1); Bradford adaptation
};

// Converts linear RGB of `from` to linear Rec. 709. Colours outside of the gamut get components below 0 or above 1.
Vector3d ToRec709(const Vector3d& rgb, RgbColorSpace from, WhiteHandling white);

// The matrix from linear RGB of the chromaticities x, y of red, green, blue and white to linear Rec. 709. nullopt: they
// are those of Rec. 709 to three digits, or of no colour space.
std::optional<glm::dmat3> MatrixToRec709(const std::array<double, 8>& chromaticities, WhiteHandling white);

// Converts CIE 1931 XYZ (Y = 1 for white) to linear Rec. 709.
Vector3d XyzToRec709(const Vector3d& xyz);

// XYZ of a chromaticity at luminance 1.
Vector3d XyzOfChromaticity(double x, double y);

// The matrix from linear Rec. 709 to CIE 1931 XYZ.
const glm::dmat3& Rec709ToXyz();

// White balance of linear Rec. 709: light of the given temperature becomes white (Bradford adaptation, [Lam85]). The
// light is CIE daylight ([CIE15]) from 4000 to 25000 K, and a black body ([Kim02]) from 1667 to 4000 K. Throws an Error
// for temperatures outside of that.
glm::dmat3 WhiteBalance(double kelvin);

// Sets negative components to 0 and rescales the others, so that the luminance is unchanged.
Color ClampToGamut(const Vector3d& rgb);

}  // namespace lampyr
