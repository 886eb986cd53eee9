// Russian roulette ([Veach97 §10.4.1]).
//
// Path tracing weighs one vertex at a time, so survival enters the throughput only and no density.
#pragma once

#include <algorithm>

#include "math/vec.h"

namespace lampyr {

// The probability with which a path goes on: the largest channel of its throughput, undone for refraction (radiance
// that entered glass is scaled by η² and is scaled back when it leaves). 1 for the first `firstVertices` scattering
// events.
inline float SurvivalProbability(const Color& throughput, float etaScale, int depth, int firstVertices) {
  if (depth < firstVertices) return 1;
  return std::min(1.0f, throughput.Max() * etaScale);
}

}  // namespace lampyr
