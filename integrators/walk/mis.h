// Multiple importance sampling with the power heuristic, β = 2 ([Veach97 §9.2]).
#pragma once

#include "math/density.h"

namespace lampyr {

// The term of a technique in the sum that a weight divides by: (p_i / p)^β for the ratio p_i / p of its density to that
// of the technique that is weighed. Of a density: its own factor of such a ratio.
inline double Mis(double ratio) {
  return ratio * ratio;
}
template <class Measure>
double Mis(Density<Measure> density) {
  return density.value * density.value;
}

// The weight of a sample of the technique with density `own`, against one other. Written with a ratio: densities of
// tiny lights leave the range of float when squared.
inline float PowerHeuristic(PdfSolidAngle own, PdfSolidAngle other) {
  if (own.value <= 0) return 0;
  const float ratio = other.value / own.value;
  return 1.0f / (1.0f + ratio * ratio);
}

}  // namespace lampyr
