// Lattice coordinates stay in float until they are hashed, so that positions of any size are valid.
#include "math/noise.h"

#include <array>
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

// Lattice points repeat after 256 cells.
uint32_t HashLattice(int32_t x, int32_t y, int32_t z) {
  const auto permuted = [](uint32_t i) -> uint32_t { return kPermutation[i & 255]; };
  return permuted(permuted(permuted(static_cast<uint32_t>(x)) + static_cast<uint32_t>(y)) + static_cast<uint32_t>(z));
}

// Dot product of the offset with one of the 12 directions to the midpoints of the edges of a cube (four of them twice).
float GradientDot(int32_t x, int32_t y, int32_t z, float dx, float dy, float dz) {
  const uint32_t h = HashLattice(x, y, z) & 15;
  const float u = h < 8 || h == 12 || h == 13 ? dx : dy;
  const float v = h < 4 || h == 12 || h == 13 ? dy : dz;
  return ((h & 1) != 0 ? -u : u) + ((h & 2) != 0 ? -v : v);
}

float Fade(float t) {
  return t * t * t * (t * (t * 6 - 15) + 10);
}

float Mix(float a, float b, float t) {
  return a + (b - a) * t;
}

}  // namespace

float Noise(const Point3& p) {
  float cell[3], d[3];
  int32_t i[3];
  for (int axis = 0; axis < 3; ++axis) {
    const float x = std::abs(p[axis]) < kLargestCoordinate ? p[axis] : std::fmod(p[axis], kLargestCoordinate);
    cell[axis] = std::floor(x);
    d[axis] = x - cell[axis];
    i[axis] = static_cast<int32_t>(cell[axis]);
  }
  const auto corner = [&](int a, int b, int c) {
    return GradientDot(i[0] + a, i[1] + b, i[2] + c, d[0] - static_cast<float>(a), d[1] - static_cast<float>(b),
                       d[2] - static_cast<float>(c));
  };
  const float wx = Fade(d[0]), wy = Fade(d[1]), wz = Fade(d[2]);
  const auto edge = [&](int b, int c) { return Mix(corner(0, b, c), corner(1, b, c), wx); };
  return Mix(Mix(edge(0, 0), edge(1, 0), wy), Mix(edge(0, 1), edge(1, 1), wy), wz);
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
