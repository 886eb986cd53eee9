// Owen-scrambled Sobol points in two dimensions, in bit-reversed order throughout: the first binary digit of a
// coordinate (its half of the unit interval) is bit 0. A nested uniform ("Owen") scramble is then a hash in which bits
// affect higher bits only ([Burley20 §3], after [Laine11]), and the first two Sobol matrices are the identity and
// Pascal's triangle mod 2.
#pragma once

#include <cstdint>

namespace lampyr::sobol {

constexpr uint32_t ReverseBits(uint32_t v) {
  v = __builtin_bswap32(v);
  v = ((v >> 4) & 0x0f0f0f0fu) | ((v & 0x0f0f0f0fu) << 4);
  v = ((v >> 2) & 0x33333333u) | ((v & 0x33333333u) << 2);
  return ((v >> 1) & 0x55555555u) | ((v & 0x55555555u) << 1);
}

// A random permutation selected by `seed`, in which bit k of the result is bit k of v, flipped or not depending only on
// the bits below k. Constants of [Vegdahl21]: even factors, and an odd one that depends on the seed.
constexpr uint32_t ScrambleUpwards(uint32_t v, uint32_t seed) {
  v ^= v * 0x3d20adeau;
  v += seed;
  v *= (seed >> 16) | 1;
  v ^= v * 0x05526c56u;
  return v ^ (v * 0x53a22864u);
}

// The second Sobol coordinate of `index`, bit-reversed: bit r is the sum over c of binomial(c, r)·index_c mod 2. That
// matrix is a Kronecker power of ((1,1),(0,1)), hence the five steps.
constexpr uint32_t PascalTimes(uint32_t index) {
  index ^= (index >> 1) & 0x55555555u;
  index ^= (index >> 2) & 0x33333333u;
  index ^= (index >> 4) & 0x0f0f0f0fu;
  index ^= (index >> 8) & 0x00ff00ffu;
  return index ^ (index >> 16);
}

// A 32-bit mixing bijection (multipliers found by [Wellons18]'s search).
constexpr uint32_t MixBits32(uint32_t v) {
  v = (v ^ (v >> 16)) * 0x21f0aaadu;
  v = (v ^ (v >> 15)) * 0x735a2d97u;
  return v ^ (v >> 15);
}

}  // namespace lampyr::sobol
