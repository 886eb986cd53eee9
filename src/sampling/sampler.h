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
  static constexpr uint32_t kBlockSize = 8;
  static constexpr uint32_t kNoBlock = 0xffffffffu;

  // Computes the Sobol points of dimensions [block, block + 1) · kBlockSize.
  void FillBlock(uint32_t block);

  SamplerKind kind_;
  uint64_t seed_;
  uint32_t reversedIndex_ = 0;  // sample index, bits reversed
  uint32_t dimension_ = 0;
  uint64_t pixelHash_ = 0;     // of pixel and seed; for independent samples, also of the index
  uint32_t block_ = kNoBlock;  // the block in blockX_ and blockY_
  float blockX_[kBlockSize] = {};
  float blockY_[kBlockSize] = {};
};

}  // namespace lampyr

#include "sampling/sampler_inline.h"
