// Gradient noise ([Perlin02]) and sums of it. Gradients are chosen by the published permutation, so that patterns have
// the same positions as those of other renderers. They repeat after 256 cells of the lattice.
#pragma once

#include <array>

#include "math/vec.h"

namespace lampyr {

// Smooth noise, 0 at lattice points, approximately in [-1,1].
float Noise(const Point3& p);

// Noise at p, and at p + step along each axis: the same values in an eighth of the time, if they are in one cell of the
// lattice.
std::array<float, 4> NoiseAround(const Point3& p, float step);

// Σ roughness^i · Noise(1.99^i p) over `octaves` ([Pharr23 §10.6]).
float FractalNoise(const Point3& p, float roughness, int octaves);

// The sum of FractalNoise with |Noise| in place of Noise, which has creases.
float Turbulence(const Point3& p, float roughness, int octaves);

}  // namespace lampyr
