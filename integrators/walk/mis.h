// Multiple importance sampling with the power heuristic, β = 2 ([Veach97 §9.2]).
#pragma once

#include "math/density.h"

namespace lampyr {

// (p_i / p)^β, the term of technique i in the denominator of a weight, for the ratio p_i / p of its density to that of
// the technique being weighted. Of a density: its factor of such a term.
inline double Mis(double ratio) {
  return ratio * ratio;
}
template <class Measure>
double Mis(Density<Measure> density) {
  return density.value * density.value;
}

// Weight of a sample drawn with density `own`, against one other technique. Computed from the ratio, because densities
// of tiny lights leave the range of float when squared.
inline float PowerHeuristic(PdfSolidAngle own, PdfSolidAngle other) {
  if (own.value <= 0) return 0;
  const float ratio = other.value / own.value;
  return 1.0f / (1.0f + ratio * ratio);
}

}  // namespace lampyr
