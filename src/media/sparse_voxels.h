// Voxels in bricks of 8³, of which most may be empty: what a NanoVDB file becomes.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "base/memory.h"
#include "media/voxels.h"

namespace lampyr {

// Indices of voxels, both ends included.
struct IndexBox {
  std::array<int, 3> min{}, max{};

  // Number of voxels along an axis.
  int64_t Extent(int axis) const { return int64_t{max[axis]} - min[axis] + 1; }
};

class SparseVoxels {
 public:
  static constexpr int kSide = 8, kBrickVoxels = kSide * kSide * kSide;

  // All voxels have the value `background`. Table and `brickCount` bricks are counted against `memory`; `where` and
  // `name` are for the Error if they exceed it.
  SparseVoxels(const IndexBox& box, float background, size_t brickCount, MemoryBudget& memory,
               const FileLocation& where, const std::string& name);

  // Bricks are numbered over all that touch `Box()`, one voxel more at the upper ends: BrickRange() along each axis.
  const IndexBox& BrickRange() const { return bricks_; }
  // The voxels of brick i of `brickCount`: x slowest, z fastest.
  float* Brick(size_t i) { return &values_[i * kBrickVoxels]; }
  // Places brick i, or a constant, at a position of BrickRange().
  void Place(const std::array<int, 3>& position, size_t i) { table_[TableIndex(position)] = static_cast<uint32_t>(i); }
  void PlaceConstant(const std::array<int, 3>& position, float value);

  // Active voxels. Beyond them, values may be interpolated towards the next voxel's.
  const IndexBox& Box() const { return box_; }
  // `background` outside of the bricks.
  float Value(int x, int y, int z) const;
  // Trilinear, with values at whole indices; `index` is within Box(), one more at the upper ends.
  float Interpolate(const Point3& index) const;
  // The largest value of the voxels from `box.min` to `box.max`.
  float Maximum(const IndexBox& box) const;
  // Throws an Error without a place if a voxel of a brick or a constant is not finite, or negative and not
  // `mayBeNegative`.
  void CheckValues(bool mayBeNegative) const;

  size_t Bytes() const;

 private:
  static constexpr int Floor8(int x) { return x >> 3; }
  bool IsInRange(const std::array<int, 3>& position) const;
  size_t TableIndex(const std::array<int, 3>& position) const;
  float MaximumOfBrick(uint32_t entry, const IndexBox& within) const;

  IndexBox box_, bricks_;
  std::array<size_t, 3> brickCounts_{};
  std::vector<uint32_t> table_;  // a brick's number; from brickCount_ on, that of a constant
  std::vector<float> values_, constants_;
  size_t brickCount_ = 0;
};

// Majorants over [Box().min, Box().max + 1], `factor` times the values.
GridResolution MajorantResolution(const SparseVoxels& voxels);
std::vector<float> MajorantsOf(const SparseVoxels& voxels, const GridResolution& cells, float factor);

}  // namespace lampyr
