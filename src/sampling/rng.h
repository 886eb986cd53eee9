// Random numbers that are pure functions of integers: a mixing hash, and a small generator for everything but pixel
// samples (tables, tests, photon emission).
#pragma once

#include <bit>
#include <cstdint>

#include "math/vec.h"

namespace lampyr {

// A bijection of 64-bit numbers in which each input bit flips each output bit with a probability near 1/2 (the
// finaliser of SplitMix64 with the constants of [Stafford11], variant 13).
constexpr uint64_t MixBits(uint64_t v) {
  v = (v ^ (v >> 30)) * 0xbf58476d1ce4e5b9ull;
  v = (v ^ (v >> 27)) * 0x94d049bb133111ebull;
  return v ^ (v >> 31);
}

// Hash of a sequence of integers.
template <class... Integers>
constexpr uint64_t Hash(Integers... values) {
  uint64_t hash = 0x9e3779b97f4a7c15ull * (sizeof...(values) + 1);
  ((hash = MixBits(hash + 0x9e3779b97f4a7c15ull + static_cast<uint64_t>(values)) * 0xd6e8feb86659fd93ull), ...);
  return MixBits(hash);
}

// The upper 24 bits as a float in [0,1). Every value is exact: no rounding up to 1.
constexpr float UnitFloat(uint32_t bits) {
  return static_cast<float>(bits >> 8) * 0x1p-24f;
}

// Extends a random float to 52 bits: a float in [0,1) has 24, and a choice among a million uses 20 of them. The 28 new
// bits are a hash of u and of three other numbers of the sample. The result is in [0,1), equal for equal arguments.
inline double WithMoreBits(float u, float a, float b, float c) {
  const auto pair = [](float high, float low) {
    return static_cast<uint64_t>(std::bit_cast<uint32_t>(high)) << 32 | std::bit_cast<uint32_t>(low);
  };
  const uint64_t hash = MixBits(pair(u, a) + 0x9e3779b97f4a7c15ull * pair(b, c));
  return static_cast<double>(u) + 0x1p-52 * static_cast<double>(hash >> 36);
}

// A point of [0,1)² for the k-th of several samples that share one random point: moved along the additive recurrence
// with the least discrepancy known in two dimensions ([Roberts18]); the 0th is the point itself.
inline Point2 MovedPoint(const Point2& u, int k) {
  if (k == 0) return u;
  const auto step = static_cast<float>(k);
  const Point2 moved(u.x + 0.75487766f * step, u.y + 0.56984029f * step);
  return glm::min(moved - glm::floor(moved), Point2(0x1.fffffep-1f));
}

// PCG32: a 64-bit congruential generator whose output is permuted ([ONeill14], XSH-RR). Streams are independent
// sequences.
class Rng {
 public:
  explicit Rng(uint64_t seed = 0, uint64_t stream = 0) : increment_(2 * MixBits(stream) + 1) {
    state_ = MixBits(seed) + increment_;
    NextUint32();
  }

  uint32_t NextUint32() {
    const uint64_t old = state_;
    state_ = old * 6364136223846793005ull + increment_;
    const uint32_t folded = static_cast<uint32_t>(((old >> 18) ^ old) >> 27);
    const uint32_t rotation = static_cast<uint32_t>(old >> 59);
    return (folded >> rotation) | (folded << ((32 - rotation) & 31));
  }
  uint64_t NextUint64() {
    const uint64_t high = NextUint32();
    return (high << 32) | NextUint32();
  }
  // In [0,1).
  float NextFloat() { return UnitFloat(NextUint32()); }
  Point2 NextPoint2() {
    const float x = NextFloat();
    return {x, NextFloat()};
  }

 private:
  uint64_t state_ = 0;
  uint64_t increment_;
};

}  // namespace lampyr
