// Which shadow rays are worth tracing. What a connection would contribute is known before its shadow ray is traced;
// next to what its sample has gathered already, much of it is nothing to speak of.
//
// By default such rays are traced by chance, and count for more when they are: the mean stays what it is, and the noise
// that is added is small against that of the sample ([Veach97 §10.4.2]: here the probability is in proportion
// to the contribution). A threshold leaves out what is below it, for good: that is a bias, which
// `lampyr compare` measures.
#pragma once

#include <bit>
#include <cstdint>

#include "math/vec.h"
#include "sampling/rng.h"

namespace lampyr {

struct ShadowRays {
  // Contributions below this part of what the sample has gathered so far are traced by chance; 0: all are traced.
  float roulette = 0.05f;
  // Contributions whose largest channel is below this (radiance) are left out; 0: none.
  float threshold = 0;

  // What a contribution is to be multiplied by, if its ray is traced at all; 0: it is not. `decider`: random bits of
  // the connection, such as those of the sampled numbers or places, which nothing else is decided by.
  float Worth(const Color& contribution, const Color& soFar, uint64_t decider) const {
    const float value = contribution.Max();
    if (value < threshold) return 0;
    const float enough = roulette * soFar.Max();
    if (!(value < enough)) return 1;
    const float survival = value / enough;
    const uint64_t bits = MixBits(decider + 0x632be59bd9b4e019u);
    return UnitFloat(static_cast<uint32_t>(bits >> 32)) < survival ? 1 / survival : 0.0f;
  }

  static uint64_t DeciderOf(float a, float b) {
    return static_cast<uint64_t>(std::bit_cast<uint32_t>(a)) << 32 | std::bit_cast<uint32_t>(b);
  }
};

}  // namespace lampyr
