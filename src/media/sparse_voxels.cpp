#include "media/sparse_voxels.h"

#include <algorithm>
#include <cmath>

namespace lampyr {

SparseVoxels::SparseVoxels(const IndexBox& box, float background, size_t brickCount, MemoryBudget& memory,
                           const FileLocation& where, const std::string& name)
    : box_(box), constants_{background}, brickCount_(brickCount) {
  double tableSize = 1;
  for (int axis = 0; axis < 3; ++axis) {
    bricks_.min[axis] = Floor8(box.min[axis]);
    bricks_.max[axis] = Floor8(box.max[axis] + 1);
    brickCounts_[axis] = static_cast<size_t>(bricks_.Extent(axis));
    tableSize *= static_cast<double>(brickCounts_[axis]);
  }
  memory.Take(tableSize * sizeof(uint32_t) + static_cast<double>(brickCount) * kBrickVoxels * sizeof(float), where,
              "the voxels of \"" + name + "\"");
  table_.assign(static_cast<size_t>(tableSize), static_cast<uint32_t>(brickCount));
  values_.resize(brickCount * kBrickVoxels);
}

bool SparseVoxels::IsInRange(const std::array<int, 3>& position) const {
  for (int axis = 0; axis < 3; ++axis) {
    if (position[axis] < bricks_.min[axis] || position[axis] > bricks_.max[axis]) return false;
  }
  return true;
}

size_t SparseVoxels::TableIndex(const std::array<int, 3>& position) const {
  std::array<size_t, 3> offset;
  for (int axis = 0; axis < 3; ++axis) offset[axis] = static_cast<size_t>(position[axis] - bricks_.min[axis]);
  return (offset[0] * brickCounts_[1] + offset[1]) * brickCounts_[2] + offset[2];
}

void SparseVoxels::PlaceConstant(const std::array<int, 3>& position, float value) {
  if (constants_.back() != value) constants_.push_back(value);
  if (brickCount_ + constants_.size() > std::numeric_limits<uint32_t>::max()) throw Error("it has too many nodes");
  table_[TableIndex(position)] = static_cast<uint32_t>(brickCount_ + constants_.size() - 1);
}

float SparseVoxels::Value(int x, int y, int z) const {
  const std::array<int, 3> position = {Floor8(x), Floor8(y), Floor8(z)};
  if (!IsInRange(position)) return constants_[0];
  const uint32_t entry = table_[TableIndex(position)];
  if (entry >= brickCount_) return constants_[entry - brickCount_];
  return values_[size_t{entry} * kBrickVoxels + static_cast<size_t>((x & 7) << 6 | (y & 7) << 3 | (z & 7))];
}

float SparseVoxels::Interpolate(const Point3& index) const {
  int low[3];
  float part[3];
  for (int axis = 0; axis < 3; ++axis) {
    const float floor = std::floor(index[axis]);
    if (!(std::abs(floor) < 0x1p30f)) return constants_[0];
    low[axis] = static_cast<int>(floor);
    part[axis] = index[axis] - floor;
  }
  float sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const int x = corner & 1, y = corner >> 1 & 1, z = corner >> 2;
    const float weight = (x ? part[0] : 1 - part[0]) * (y ? part[1] : 1 - part[1]) * (z ? part[2] : 1 - part[2]);
    // A voxel beside the point may have any value, and be beyond the box.
    if (weight != 0) sum += weight * Value(low[0] + x, low[1] + y, low[2] + z);
  }
  return sum;
}

float SparseVoxels::MaximumOfBrick(uint32_t entry, const IndexBox& within) const {
  if (entry >= brickCount_) return constants_[entry - brickCount_];
  const float* brick = &values_[size_t{entry} * kBrickVoxels];
  float most = 0;
  for (int x = within.min[0]; x <= within.max[0]; ++x) {
    for (int y = within.min[1]; y <= within.max[1]; ++y) {
      const float* line = brick + ((x & 7) << 6 | (y & 7) << 3);
      for (int z = within.min[2]; z <= within.max[2]; ++z) most = std::max(most, line[z & 7]);
    }
  }
  return most;
}

float SparseVoxels::Maximum(const IndexBox& box) const {
  std::array<int, 3> first, last, at;
  float most = 0;
  for (int axis = 0; axis < 3; ++axis) {
    first[axis] = std::max(Floor8(box.min[axis]), bricks_.min[axis]);
    last[axis] = std::min(Floor8(box.max[axis]), bricks_.max[axis]);
    if (first[axis] > Floor8(box.min[axis]) || last[axis] < Floor8(box.max[axis])) most = std::max(most, constants_[0]);
  }
  for (at[0] = first[0]; at[0] <= last[0]; ++at[0]) {
    for (at[1] = first[1]; at[1] <= last[1]; ++at[1]) {
      for (at[2] = first[2]; at[2] <= last[2]; ++at[2]) {
        IndexBox within;
        for (int axis = 0; axis < 3; ++axis) {
          within.min[axis] = std::max(box.min[axis], at[axis] * kSide);
          within.max[axis] = std::min(box.max[axis], at[axis] * kSide + kSide - 1);
        }
        most = std::max(most, MaximumOfBrick(table_[TableIndex(at)], within));
      }
    }
  }
  return most;
}

void SparseVoxels::CheckValues(bool mayBeNegative) const {
  const auto isBad = [mayBeNegative](float value) { return !std::isfinite(value) || (value < 0 && !mayBeNegative); };
  if (std::none_of(values_.begin(), values_.end(), isBad) && std::none_of(constants_.begin(), constants_.end(), isBad))
    return;
  throw Error(mayBeNegative ? "it has a voxel that is not finite" : "it has a voxel that is negative or not finite");
}

size_t SparseVoxels::Bytes() const {
  return table_.size() * sizeof(uint32_t) + (values_.size() + constants_.size()) * sizeof(float);
}

GridResolution MajorantResolution(const SparseVoxels& voxels) {
  GridResolution extents;
  for (int axis = 0; axis < 3; ++axis)
    extents[axis] = static_cast<int>(std::min<int64_t>(voxels.Box().Extent(axis), std::numeric_limits<int>::max()));
  return MajorantResolution(extents);
}

std::vector<float> MajorantsOf(const SparseVoxels& voxels, const GridResolution& cells, float factor) {
  // The voxels that values within a cell are interpolated from.
  const auto range = [&](int axis, int cell, IndexBox& box) {
    const double side = static_cast<double>(voxels.Box().Extent(axis)) / cells[axis];
    const double first = voxels.Box().min[axis];
    box.min[axis] = static_cast<int>(std::max(std::floor(first + (cell - kCellMargin) * side), first - 1));
    const double last = static_cast<double>(voxels.Box().max[axis]) + 1;
    box.max[axis] = static_cast<int>(std::min(std::floor(first + (cell + 1 + kCellMargin) * side) + 1, last));
  };
  std::vector<float> majorants;
  IndexBox box;
  for (int z = 0; z < cells[2]; ++z) {
    range(2, z, box);
    for (int y = 0; y < cells[1]; ++y) {
      range(1, y, box);
      for (int x = 0; x < cells[0]; ++x) {
        range(0, x, box);
        majorants.push_back(voxels.Maximum(box) * factor * kMajorantMargin);
      }
    }
  }
  return majorants;
}

}  // namespace lampyr
