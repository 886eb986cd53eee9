// Lattice coordinates stay in float until they are hashed, so that positions of any size are valid.
#include "math/noise.h"

#include <cstdint>

namespace lampyr {

namespace {

// Positions beyond this have no fractional part in float: the lattice wraps there.
constexpr float kLargestCoordinate = 0x1p30f;
constexpr float kOctaveScale = 1.99f;  // just below 2, so that the lattices of octaves do not coincide

uint32_t HashLattice(int32_t x, int32_t y, int32_t z) {
  uint32_t h = static_cast<uint32_t>(x) * 0x9e3779b1u ^ static_cast<uint32_t>(y) * 0x85ebca77u ^
               static_cast<uint32_t>(z) * 0xc2b2ae3du;
  h ^= h >> 15;
  h *= 0x2c1b3c6du;
  h ^= h >> 12;
  h *= 0x297a2d39u;
  return h ^ (h >> 15);
}

// Dot product of the offset with one of the 12 directions to the midpoints of the edges of a cube (four of them twice).
float GradientDot(int32_t x, int32_t y, int32_t z, float dx, float dy, float dz) {
  const uint32_t h = HashLattice(x, y, z) >> 28;
  const float u = h < 8 || h == 12 || h == 13 ? dx : dy;
  const float v = h < 4 || h == 12 || h == 13 ? dy : dz;
  return ((h & 1) != 0 ? -u : u) + ((h & 2) != 0 ? -v : v);
}

float Fade(float t) { return t * t * t * (t * (t * 6 - 15) + 10); }

float Mix(float a, float b, float t) { return a + (b - a) * t; }

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
