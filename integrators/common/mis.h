// Multiple importance sampling of two techniques ([Veach97 §9.2]).
#pragma once

#include "math/density.h"

namespace lampyr {

// The power heuristic (β = 2) for a sample of the technique with density `own`, against `other`. Written with a ratio:
// densities of tiny lights leave the range of float when squared.
inline float PowerHeuristic(PdfSolidAngle own, PdfSolidAngle other) {
  if (own.value <= 0) return 0;
  const float ratio = other.value / own.value;
  return 1.0f / (1.0f + ratio * ratio);
}

}  // namespace lampyr
