// Inline members of Sampler on the hot path.
#pragma once

#include "sampling/rng.h"

namespace lampyr {

inline Point2 Sampler::Get2D() {
  const uint32_t dimension = dimension_++;
  if (kind_ == SamplerKind::Independent) {
    const uint64_t hash = MixBits(pixelHash_ + 0x9e3779b97f4a7c15ull * (dimension + 1ull));
    return {UnitFloat(static_cast<uint32_t>(hash)), UnitFloat(static_cast<uint32_t>(hash >> 32))};
  }
  const uint32_t index = dimension / kBlockSize, place = index % kBlocks, i = dimension % kBlockSize;
  Block& block = blocks_[place];
  if (indices_[place] != index) {
    FillBlock(index, block);
    indices_[place] = index;
  }
  return {block.x[i], block.y[i]};
}

inline float Sampler::Get1D() {
  return Get2D().x;
}

}  // namespace lampyr
