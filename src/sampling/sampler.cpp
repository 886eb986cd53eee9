// The Sobol sampler computes points in blocks: one loop over the dimensions of a block, without branches, which the
// compiler vectorizes. Eight points cost little more than two computed one by one.
#include "sampling/sampler.h"

#include <algorithm>

#include "sampling/sobol.h"

namespace lampyr {

void Sampler::StartPixelSample(int x, int y, uint32_t index) {
  dimension_ = 0;
  std::fill_n(indices_, kBlocks, kNoBlock);
  reversedIndex_ = sobol::ReverseBits(index);
  pixelHash_ = Hash(seed_, x, y, kind_ == SamplerKind::Sobol ? 0u : index);
}

void Sampler::FillBlock(uint32_t index, Block& block) const {
  const uint32_t low = static_cast<uint32_t>(pixelHash_), high = static_cast<uint32_t>(pixelHash_ >> 32);
  const uint32_t reversedIndex = reversedIndex_;
  for (uint32_t i = 0; i < kBlockSize; ++i) {
    const uint32_t seed = sobol::MixBits32(low + 0x9e3779b9u * (index * kBlockSize + i));
    const uint32_t seedX = sobol::MixBits32(seed ^ high);
    const uint32_t seedY = sobol::MixBits32(seedX + 0x85ebca6bu);
    // Each pair of dimensions shuffles the order of the points anew; otherwise the pairs would be correlated.
    const uint32_t shuffled = sobol::ReverseBits(sobol::ScrambleUpwards(reversedIndex, seed));
    const uint32_t x = sobol::ReverseBits(sobol::ScrambleUpwards(shuffled, seedX));
    const uint32_t y = sobol::ReverseBits(sobol::ScrambleUpwards(sobol::PascalTimes(shuffled), seedY));
    block.x[i] = UnitFloat(x);
    block.y[i] = UnitFloat(y);
  }
}

}  // namespace lampyr
