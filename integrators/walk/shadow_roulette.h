// Russian roulette of shadow rays. The contribution of a connection is known before its shadow ray is traced, and is
// often negligible against what the sample has gathered already.
//
// By default such shadow rays are traced with a survival probability and weighted by its inverse: the mean is
// unchanged, and the added noise is small against that of the sample ([Veach97 §10.4.2]; here the probability is
// proportional to the contribution). A threshold drops contributions below it for good: a bias, which `lampyr compare`
// measures.
#pragma once

#include <bit>
#include <cstdint>

#include "math/vec.h"
#include "sampling/rng.h"

namespace lampyr {

struct ShadowRays {
  // Contributions below this fraction of what the sample has gathered so far are subject to roulette; 0: all are
  // traced.
  float roulette = 0.05f;
  // Contributions whose largest channel is below this (radiance) are dropped; 0: none.
  float threshold = 0;

  // Survival weight of a contribution: 1 over the probability with which its shadow ray is traced; 0: the ray is not
  // traced. `decider`: random bits of the connection, such as those of its random numbers or its direction, that decide
  // nothing else.
  float SurvivalWeight(const Color& contribution, const Color& soFar, uint64_t decider) const {
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
