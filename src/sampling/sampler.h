// Random numbers for one sample of one pixel: a pure function of (pixel, sample index, dimension, seed), independent of
// the order in which threads work. Owen-scrambled Sobol points, padded by 2-D pairs ([Burley20]), or independent
// numbers.
#pragma once

#include <cstdint>

#include "math/vec.h"

namespace lampyr {

enum class SamplerKind { Sobol, Independent };

class Sampler {
 public:
  Sampler(SamplerKind kind, uint64_t seed) : kind_(kind), seed_(seed) {}

  // Begins sample `index` of a pixel at dimension 0.
  void StartPixelSample(int x, int y, uint32_t index);
  // Jumps to a dimension. Path vertices start at fixed dimensions, so that they stay stratified among paths of
  // different length and kind.
  void SetDimension(uint32_t dimension) { dimension_ = dimension; }

  // In [0, 1). Each call uses the next dimension (a pair counts as one).
  float Get1D();
  Point2 Get2D();

  SamplerKind Kind() const { return kind_; }

 private:
  static constexpr uint32_t kBlockSize = 8, kBlocks = 8;
  static constexpr uint32_t kNoBlock = 0xffffffffu;

  // Sobol points of kBlockSize dimensions, from index · kBlockSize on.
  struct Block {
    alignas(32) float x[kBlockSize], y[kBlockSize];
  };

  // Computes the points of a block.
  void FillBlock(uint32_t index, Block& block) const;

  SamplerKind kind_;
  uint64_t seed_;
  uint32_t reversedIndex_ = 0;  // sample index, bits reversed
  uint32_t dimension_ = 0;
  uint64_t pixelHash_ = 0;  // of pixel and seed; for independent samples, also of the index
  // Blocks computed for this sample, block i at i mod kBlocks: the two subpaths of a bidirectional sample alternate
  // between dimensions. `indices_`: index of the block in each slot.
  Block blocks_[kBlocks] = {};
  alignas(32) uint32_t indices_[kBlocks] = {kNoBlock, kNoBlock, kNoBlock, kNoBlock,
                                            kNoBlock, kNoBlock, kNoBlock, kNoBlock};
};

}  // namespace lampyr

#include "sampling/sampler_inline.h"
