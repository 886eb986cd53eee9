#include "spectral/color_space.h"

#include <algorithm>
#include <cmath>

#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "base/error.h"

namespace lampyr {

namespace {

struct Chromaticity {
  double x, y;
};

struct Primaries {
  const char* name;
  Chromaticity red, green, blue, white;
};

// ITU-R BT.709, SMPTE EG 432-1 (display P3 white), ITU-R BT.2020, SMPTE ST 2065-1; the order of RgbColorSpace.
constexpr Primaries kSpaces[] = {
    {"srgb", {0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}, {0.3127, 0.3290}},
    {"dci-p3", {0.680, 0.320}, {0.265, 0.690}, {0.150, 0.060}, {0.3127, 0.3290}},
    {"rec2020", {0.708, 0.292}, {0.170, 0.797}, {0.131, 0.046}, {0.3127, 0.3290}},
    {"aces2065-1", {0.7347, 0.2653}, {0.0, 1.0}, {0.0001, -0.0770}, {0.32168, 0.33767}},
};

Vector3d ToXyz(const Chromaticity& c) {
  return XyzOfChromaticity(c.x, c.y);
}

// Columns are the primaries, scaled so that their sum is the white. The white fixes the scale, without a division by
// the y of a primary (that of ACES blue is negative).
glm::dmat3 RgbToXyz(const Primaries& space) {
  const auto direction = [](const Chromaticity& c) { return Vector3d(c.x, c.y, 1 - c.x - c.y); };
  const glm::dmat3 directions(direction(space.red), direction(space.green), direction(space.blue));
  const Vector3d scale = glm::inverse(directions) * ToXyz(space.white);
  return glm::dmat3(directions[0] * scale.x, directions[1] * scale.y, directions[2] * scale.z);
}

// The linear Bradford transform between two whites [Lam85].
glm::dmat3 Adaptation(const Chromaticity& from, const Chromaticity& to) {
  const glm::dmat3 cone =
      glm::transpose(glm::dmat3(0.8951, 0.2664, -0.1614, -0.7502, 1.7135, 0.0367, 0.0389, -0.0685, 1.0296));
  const Vector3d ratio = (cone * ToXyz(to)) / (cone * ToXyz(from));
  glm::dmat3 scale(0.0);
  for (int i = 0; i < 3; ++i) scale[i][i] = ratio[i];
  return glm::inverse(cone) * scale * cone;
}

std::string LowerCase(std::string text) {
  for (char& c : text) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return text;
}

}  // namespace

const std::vector<std::string>& ColorSpaceNames() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list;
    for (const Primaries& space : kSpaces) list.push_back(space.name);
    return list;
  }();
  return names;
}

std::optional<RgbColorSpace> FindColorSpace(const std::string& name) {
  const std::vector<std::string>& names = ColorSpaceNames();
  const auto found = std::find(names.begin(), names.end(), LowerCase(name));
  if (found == names.end()) return std::nullopt;
  return static_cast<RgbColorSpace>(found - names.begin());
}

Vector3d XyzOfChromaticity(double x, double y) {
  return {x / y, 1.0, (1 - x - y) / y};
}

Vector3d XyzToRec709(const Vector3d& xyz) {
  static const glm::dmat3 matrix = glm::inverse(RgbToXyz(kSpaces[0]));
  return matrix * xyz;
}

const glm::dmat3& Rec709ToXyz() {
  static const glm::dmat3 matrix = RgbToXyz(kSpaces[0]);
  return matrix;
}

namespace {

// The cubic approximation of the Planckian locus from 1667 to 4000 K ([Kim02]).
Chromaticity ChromaticityOfBlackbody(double kelvin) {
  const double per = 1e3 / kelvin;
  const double x = ((-0.2661239 * per - 0.2343589) * per + 0.8776956) * per + 0.179910;
  const double y = kelvin < 2222 ? ((-1.1063814 * x - 1.34811020) * x + 2.18555832) * x - 0.20219683
                                 : ((-0.9549476 * x - 1.37418593) * x + 2.09137015) * x - 0.16748867;
  return {x, y};
}

Chromaticity ChromaticityOfDaylight(double kelvin) {
  constexpr double kNewOverOldRadiation = 1.4388 / 1.4380;  // nominal temperatures use the old constant
  const double t = kelvin * kNewOverOldRadiation, per = 1e3 / t;
  const double x = t <= 7000 ? ((-4.6070 * per + 2.9678) * per + 0.09911) * per + 0.244063
                             : ((-2.0064 * per + 1.9018) * per + 0.24748) * per + 0.237040;
  return {x, (-3 * x + 2.870) * x - 0.275};
}

}  // namespace

glm::dmat3 WhiteBalance(double kelvin) {
  if (!(kelvin >= 1667 && kelvin <= 25000)) throw Error("a white balance is from 1667 to 25000 K");
  constexpr double kColdestDaylight = 4000;
  const Chromaticity white =
      kelvin < kColdestDaylight ? ChromaticityOfBlackbody(kelvin) : ChromaticityOfDaylight(kelvin);
  const glm::dmat3& toXyz = Rec709ToXyz();
  return glm::inverse(toXyz) * Adaptation(white, kSpaces[0].white) * toXyz;
}

namespace {

glm::dmat3 MatrixToRec709(const Primaries& space, WhiteHandling white) {
  const glm::dmat3 toXyz = RgbToXyz(space);
  const glm::dmat3 adapted = white == WhiteHandling::Adapt ? Adaptation(space.white, kSpaces[0].white) * toXyz : toXyz;
  return glm::inverse(Rec709ToXyz()) * adapted;
}

}  // namespace

Vector3d ToRec709(const Vector3d& rgb, RgbColorSpace from, WhiteHandling white) {
  if (from == RgbColorSpace::Srgb) return rgb;
  return MatrixToRec709(kSpaces[static_cast<int>(from)], white) * rgb;
}

std::optional<glm::dmat3> MatrixToRec709(const std::array<double, 8>& c, WhiteHandling white) {
  const Primaries& own = kSpaces[0];
  const double known[] = {own.red.x,  own.red.y,  own.green.x, own.green.y,
                          own.blue.x, own.blue.y, own.white.x, own.white.y};
  constexpr double kSame = 1e-3;
  bool isSame = true;
  for (size_t i = 0; i < c.size(); ++i) isSame = isSame && std::abs(c[i] - known[i]) < kSame;
  if (isSame || !(c[7] > 0)) return std::nullopt;
  const glm::dmat3 matrix =
      MatrixToRec709(Primaries{"", {c[0], c[1]}, {c[2], c[3]}, {c[4], c[5]}, {c[6], c[7]}}, white);
  for (int column = 0; column < 3; ++column) {
    for (int row = 0; row < 3; ++row)
      if (!(std::abs(matrix[column][row]) < 1e6)) return std::nullopt;  // primaries in one line
  }
  return matrix;
}

Color ClampToGamut(const Vector3d& rgb) {
  const auto luminance = [](const Vector3d& c) { return glm::dot(c, Vector3d(0.2126390, 0.7151687, 0.0721923)); };
  Vector3d clamped = glm::max(rgb, Vector3d(0.0));
  const double wanted = luminance(rgb), got = luminance(clamped);
  if (wanted <= 0 || got <= 0) return Color(0.0f);
  if (clamped != rgb) clamped *= wanted / got;
  return Color(static_cast<float>(clamped.x), static_cast<float>(clamped.y), static_cast<float>(clamped.z));
}

}  // namespace lampyr
