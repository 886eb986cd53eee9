// Gradient noise ([Perlin02]) and sums of it. Gradients are chosen by an integer hash of the lattice point, so that the
// noise does not repeat. The field differs from that of other renderers, but has the same character.
#pragma once

#include "math/vec.h"

namespace lampyr {

// Smooth noise, 0 at lattice points, approximately in [-1,1].
float Noise(const Point3& p);

// Σ roughness^i · Noise(1.99^i p) over `octaves` ([Pharr23 §10.6]).
float FractalNoise(const Point3& p, float roughness, int octaves);

// The sum of FractalNoise with |Noise| in place of Noise, which has creases.
float Turbulence(const Point3& p, float roughness, int octaves);

}  // namespace lampyr
