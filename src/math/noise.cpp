// Lattice coordinates stay in float until they are hashed, so that positions of any size are valid.
#include "math/noise.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace lampyr {

namespace {

// Positions beyond this have no fractional part in float: the lattice wraps there.
constexpr float kLargestCoordinate = 0x1p30f;
constexpr float kOctaveScale = 1.99f;  // just below 2, so that the lattices of octaves do not coincide

// The permutation published in [Perlin02], which other renderers use, too: patterns have the same positions as theirs.
constexpr std::array<uint8_t, 256> kPermutation = {
    151, 160, 137, 91,  90,  15,  131, 13,  201, 95,  96,  53,  194, 233, 7,   225, 140, 36,  103, 30,  69,  142,
    8,   99,  37,  240, 21,  10,  23,  190, 6,   148, 247, 120, 234, 75,  0,   26,  197, 62,  94,  252, 219, 203,
    117, 35,  11,  32,  57,  177, 33,  88,  237, 149, 56,  87,  174, 20,  125, 136, 171, 168, 68,  175, 74,  165,
    71,  134, 139, 48,  27,  166, 77,  146, 158, 231, 83,  111, 229, 122, 60,  211, 133, 230, 220, 105, 92,  41,
    55,  46,  245, 40,  244, 102, 143, 54,  65,  25,  63,  161, 1,   216, 80,  73,  209, 76,  132, 187, 208, 89,
    18,  169, 200, 196, 135, 130, 116, 188, 159, 86,  164, 100, 109, 198, 173, 186, 3,   64,  52,  217, 226, 250,
    124, 123, 5,   202, 38,  147, 118, 126, 255, 82,  85,  212, 207, 206, 59,  227, 47,  16,  58,  17,  182, 189,
    28,  42,  223, 183, 170, 213, 119, 248, 152, 2,   44,  154, 163, 70,  221, 153, 101, 155, 167, 43,  172, 9,
    129, 22,  39,  253, 19,  98,  108, 110, 79,  113, 224, 232, 178, 185, 112, 104, 218, 246, 97,  228, 251, 34,
    242, 193, 238, 210, 144, 12,  191, 179, 162, 241, 81,  51,  145, 235, 249, 14,  239, 107, 49,  192, 214, 31,
    181, 199, 106, 157, 184, 84,  204, 176, 115, 121, 50,  45,  127, 4,   150, 254, 138, 236, 205, 93,  222, 114,
    67,  29,  24,  72,  243, 141, 128, 195, 78,  66,  215, 61,  156, 180};

// The permutation twice: the sum of an entry and a coordinate below 256 is an index. Lattice points repeat after 256
// cells.
constexpr std::array<uint8_t, 512> kHash = [] {
  std::array<uint8_t, 512> twice{};
  for (size_t i = 0; i < twice.size(); ++i) twice[i] = kPermutation[i % kPermutation.size()];
  return twice;
}();

struct Gradient {
  float x = 0, y = 0, z = 0;
};

// The 12 directions to the midpoints of the edges of a cube (four of them twice), by hash. A table, because branches on
// random bits are not predicted: they took six times as long as all else.
constexpr std::array<Gradient, 16> kGradients = [] {
  std::array<Gradient, 16> gradients{};
  for (uint32_t h = 0; h < gradients.size(); ++h) {
    const bool isDouble = h == 12 || h == 13;
    const float first = (h & 1) != 0 ? -1.0f : 1.0f, second = (h & 2) != 0 ? -1.0f : 1.0f;
    Gradient& gradient = gradients[h];
    (h < 8 || isDouble ? gradient.x : gradient.y) += first;
    (h < 4 || isDouble ? gradient.y : gradient.z) += second;
  }
  return gradients;
}();

// The gradients at the corners of a cell of the lattice: those at x or x + 1, y or y + 1, z or z + 1 by bits 0, 1, 2.
struct CellGradients {
  std::array<Gradient, 8> at;

  CellGradients(int32_t x, int32_t y, int32_t z) {
    const uint32_t ix = static_cast<uint32_t>(x) & 255, iy = static_cast<uint32_t>(y) & 255,
                   iz = static_cast<uint32_t>(z) & 255;
    for (uint32_t corner = 0; corner < 8; ++corner) {
      const uint32_t ofX = kHash[ix + (corner & 1)], ofXy = kHash[ofX + iy + (corner >> 1 & 1)];
      at[corner] = kGradients[kHash[ofXy + iz + (corner >> 2)] & 15];
    }
  }
};

template <class Value>
Value Fade(Value t) {
  return t * t * t * (t * (t * 6 - 15) + 10);
}

template <class Value>
Value Mix(Value a, Value b, Value t) {
  return a + (b - a) * t;
}

// Interpolates between the corners of a cell at the offset (x, y, z) from its first one, each in [0, 1]. A value may be
// a vector of several floats.
template <class Value>
Value Interpolate(const CellGradients& gradients, Value x, Value y, Value z) {
  const auto corner = [&](size_t i) {
    const Gradient& g = gradients.at[i];
    const Value dx = (i & 1) != 0 ? x - 1 : x, dy = (i & 2) != 0 ? y - 1 : y, dz = (i & 4) != 0 ? z - 1 : z;
    return g.x * dx + (g.y * dy + g.z * dz);
  };
  const Value wx = Fade(x), wy = Fade(y), wz = Fade(z);
  const auto edge = [&](size_t first) { return Mix(corner(first), corner(first + 1), wx); };
  return Mix(Mix(edge(0), edge(2), wy), Mix(edge(4), edge(6), wy), wz);
}

// Four floats, of which each operation is one instruction.
using FloatFour = float __attribute__((vector_size(16)));

}  // namespace

float Noise(const Point3& p) {
  float d[3];
  int32_t i[3];
  for (int axis = 0; axis < 3; ++axis) {
    const float x = std::abs(p[axis]) < kLargestCoordinate ? p[axis] : std::fmod(p[axis], kLargestCoordinate);
    const float cell = std::floor(x);
    d[axis] = x - cell;
    i[axis] = static_cast<int32_t>(cell);
  }
  return Interpolate(CellGradients(i[0], i[1], i[2]), d[0], d[1], d[2]);
}

std::array<float, 4> NoiseAround(const Point3& p, float step) {
  FloatFour d[3];
  float cell[3];
  bool isOneCell = true;
  for (int axis = 0; axis < 3; ++axis) {
    const float moved = p[axis] + step;
    cell[axis] = std::floor(p[axis]);
    isOneCell = isOneCell && std::abs(p[axis]) < kLargestCoordinate && std::abs(moved) < kLargestCoordinate &&
                std::floor(moved) == cell[axis];
    const float stays = p[axis] - cell[axis];
    d[axis] = FloatFour{stays, stays, stays, stays};
    d[axis][axis + 1] = moved - cell[axis];
  }
  if (!isOneCell)
    return {Noise(p), Noise(p + Vector3(step, 0, 0)), Noise(p + Vector3(0, step, 0)), Noise(p + Vector3(0, 0, step))};
  const CellGradients gradients(static_cast<int32_t>(cell[0]), static_cast<int32_t>(cell[1]),
                                static_cast<int32_t>(cell[2]));
  const FloatFour noise = Interpolate(gradients, d[0], d[1], d[2]);
  return {noise[0], noise[1], noise[2], noise[3]};
}

float FractalNoise(const Point3& p, float roughness, int octaves) {
  float sum = 0, frequency = 1, amplitude = 1;
  for (int i = 0; i < octaves; ++i) {
    sum += amplitude * Noise(p * frequency);
    frequency *= kOctaveScale;
    amplitude *= roughness;
  }
  return sum;
}

float Turbulence(const Point3& p, float roughness, int octaves) {
  float sum = 0, frequency = 1, amplitude = 1;
  for (int i = 0; i < octaves; ++i) {
    sum += amplitude * std::abs(Noise(p * frequency));
    frequency *= kOctaveScale;
    amplitude *= roughness;
  }
  return sum;
}

}  // namespace lampyr
