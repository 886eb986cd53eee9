// Gradient noise ([Perlin02]) and sums of it. The gradients are chosen by an integer hash of the lattice point, so the
// noise does not repeat; it is not the same field as other renderers', only of the same character.
#pragma once

#include "math/vec.h"

namespace lampyr {

// Smooth, 0 at lattice points, about [-1,1].
float Noise(const Point3& p);

// Σ roughness^i · Noise(1.99^i p) over `octaves` ([Pharr23 §10.6]).
float FractalNoise(const Point3& p, float roughness, int octaves);

// The same of |Noise|: creases.
float Turbulence(const Point3& p, float roughness, int octaves);

}  // namespace lampyr
