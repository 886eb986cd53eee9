// Voxels in bricks of 8³, most of which may be empty: a NanoVDB grid in memory.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
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

  // Sets all voxels to `background`. Table and `brickCount` bricks are counted against `memory`; `where` and `name` are
  // for the Error if they exceed it.
  SparseVoxels(const IndexBox& box, float background, size_t brickCount, MemoryBudget& memory,
               const FileLocation& where, const std::string& name);

  // Bricks are numbered over all that overlap `Box()`, extended by one voxel at the upper ends: BrickRange() along each
  // axis.
  const IndexBox& BrickRange() const { return bricks_; }
  // The voxels of brick i of `brickCount`: x slowest, z fastest.
  float* Brick(size_t i) { return &values_[i * kBrickVoxels]; }
  // Places brick i, or a constant, at a position of BrickRange().
  void Place(const std::array<int, 3>& position, size_t i) { table_[TableIndex(position)] = static_cast<uint32_t>(i); }
  void PlaceConstant(const std::array<int, 3>& position, float value);

  // Box of the active voxels. Beyond it, values are interpolated towards the next voxel's.
  const IndexBox& Box() const { return box_; }
  float Background() const { return constants_[0]; }
  // The background outside of the bricks.
  float Value(int x, int y, int z) const;
  // Trilinear, with values at whole indices; `index` is within Box(), one more at the upper ends.
  float Interpolate(const Point3& index) const;
  // The largest value of the voxels from `box.min` to `box.max`.
  float Maximum(const IndexBox& box) const;
  // Calls visit(box, entry) for each brick, and for each run of bricks with the same constant, except for constants up
  // to 0. `entry` is for the two methods below.
  void ForRuns(const std::function<void(const IndexBox&, uint32_t)>& visit) const;
  // The largest value, at least 0, of a brick, and of the part of it that is within a box of voxels it has.
  float MaximumOfEntry(uint32_t entry) const;
  float MaximumOfBrick(uint32_t entry, const IndexBox& within) const;
  // Throws an Error without a place if a voxel of a brick or a constant is not finite, or negative and not
  // `mayBeNegative`.
  void CheckValues(bool mayBeNegative) const;

  size_t Bytes() const;

 private:
  static constexpr int Floor8(int x) { return x >> 3; }
  static size_t OffsetInBrick(int x, int y, int z);
  // Entry of the table for the brick of a voxel; outside of the table, that of the background.
  uint32_t EntryAt(int x, int y, int z) const;
  bool IsInRange(const std::array<int, 3>& position) const;
  size_t TableIndex(const std::array<int, 3>& position) const;

  IndexBox box_, bricks_;
  std::array<size_t, 3> brickCounts_{};
  std::vector<uint32_t> table_;  // number of a brick; from brickCount_ on, of a constant
  std::vector<float> values_, constants_;
  size_t brickCount_ = 0;
};

// Majorants over [Box().min, Box().max + 1], `factor` times the values.
GridResolution MajorantResolution(const SparseVoxels& voxels);
std::vector<float> MajorantsOf(const SparseVoxels& voxels, const GridResolution& cells, float factor);

}  // namespace lampyr
