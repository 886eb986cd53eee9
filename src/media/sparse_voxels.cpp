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

size_t SparseVoxels::OffsetInBrick(int x, int y, int z) {
  return static_cast<size_t>((x & 7) << 6 | (y & 7) << 3 | (z & 7));
}

uint32_t SparseVoxels::EntryAt(int x, int y, int z) const {
  const std::array<int, 3> position = {Floor8(x), Floor8(y), Floor8(z)};
  return IsInRange(position) ? table_[TableIndex(position)] : static_cast<uint32_t>(brickCount_);
}

float SparseVoxels::Value(int x, int y, int z) const {
  const uint32_t entry = EntryAt(x, y, z);
  if (entry >= brickCount_) return constants_[entry - brickCount_];
  return values_[size_t{entry} * kBrickVoxels + OffsetInBrick(x, y, z)];
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
  const auto weight = [&part](int x, int y, int z) {
    return (x ? part[0] : 1 - part[0]) * (y ? part[1] : 1 - part[1]) * (z ? part[2] : 1 - part[2]);
  };
  float sum = 0;
  if ((low[0] & 7) < 7 && (low[1] & 7) < 7 && (low[2] & 7) < 7) {  // all in one brick
    const uint32_t entry = EntryAt(low[0], low[1], low[2]);
    if (entry >= brickCount_) return constants_[entry - brickCount_];
    const float* voxel = &values_[size_t{entry} * kBrickVoxels + OffsetInBrick(low[0], low[1], low[2])];
    for (int corner = 0; corner < 8; ++corner) {
      const int x = corner & 1, y = corner >> 1 & 1, z = corner >> 2;
      sum += weight(x, y, z) * voxel[x * 64 + y * 8 + z];
    }
    return sum;
  }
  for (int corner = 0; corner < 8; ++corner) {
    const int x = corner & 1, y = corner >> 1 & 1, z = corner >> 2;
    sum += weight(x, y, z) * Value(low[0] + x, low[1] + y, low[2] + z);
  }
  return sum;
}

float SparseVoxels::MaximumOfBrick(uint32_t entry, const IndexBox& within) const {
  if (entry >= brickCount_) return constants_[entry - brickCount_];
  const float* brick = &values_[size_t{entry} * kBrickVoxels];
  float most = 0;
  for (int x = within.min[0]; x <= within.max[0]; ++x) {
    for (int y = within.min[1]; y <= within.max[1]; ++y) {
      const float* line = brick + OffsetInBrick(x, y, 0);
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

float SparseVoxels::MaximumOfEntry(uint32_t entry) const {
  return MaximumOfBrick(entry, {{0, 0, 0}, {kSide - 1, kSide - 1, kSide - 1}});
}

void SparseVoxels::ForRuns(const std::function<void(const IndexBox&, uint32_t)>& visit) const {
  std::array<int, 3> at;
  size_t i = 0;
  for (at[0] = bricks_.min[0]; at[0] <= bricks_.max[0]; ++at[0]) {
    for (at[1] = bricks_.min[1]; at[1] <= bricks_.max[1]; ++at[1]) {
      for (at[2] = bricks_.min[2]; at[2] <= bricks_.max[2]; ++at[2]) {
        const uint32_t entry = table_[i++];
        IndexBox box;
        for (int axis = 0; axis < 3; ++axis) box.min[axis] = at[axis] * kSide;
        for (; entry >= brickCount_ && at[2] < bricks_.max[2] && table_[i] == entry; ++i) ++at[2];
        if (entry >= brickCount_ && constants_[entry - brickCount_] <= 0) continue;
        for (int axis = 0; axis < 3; ++axis) box.max[axis] = at[axis] * kSide + kSide - 1;
        visit(box, entry);
      }
    }
  }
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

namespace {

struct Range {
  int first = 0, last = 0;  // both inclusive
};

// For each cell along an axis, the voxels from which values within it are interpolated; both ends ascend.
std::vector<Range> VoxelRanges(const IndexBox& box, int axis, int cells) {
  const double side = static_cast<double>(box.Extent(axis)) / cells;
  const double first = box.min[axis], last = static_cast<double>(box.max[axis]) + 1;
  std::vector<Range> ranges;
  for (int cell = 0; cell < cells; ++cell) {
    ranges.push_back({static_cast<int>(std::max(std::floor(first + (cell - kCellMargin) * side), first)),
                      static_cast<int>(std::min(std::floor(first + (cell + 1 + kCellMargin) * side) + 1, last))});
  }
  return ranges;
}

// The cells whose values depend on the voxels `voxels`.
Range CellsOf(const std::vector<Range>& ranges, Range voxels) {
  const auto first =
      std::partition_point(ranges.begin(), ranges.end(), [&](const Range& range) { return range.last < voxels.first; });
  const auto last =
      std::partition_point(first, ranges.end(), [&](const Range& range) { return range.first <= voxels.last; });
  return {static_cast<int>(first - ranges.begin()), static_cast<int>(last - ranges.begin()) - 1};
}

}  // namespace

// Visits each brick once, and each run of equal constants as one: most of a large box is empty.
std::vector<float> MajorantsOf(const SparseVoxels& voxels, const GridResolution& cells, float factor) {
  const size_t count = static_cast<size_t>(cells[0]) * static_cast<size_t>(cells[1]) * static_cast<size_t>(cells[2]);
  std::vector<float> majorants(count, std::max(voxels.Background(), 0.0f));
  std::array<std::vector<Range>, 3> ranges;
  for (int axis = 0; axis < 3; ++axis) ranges[axis] = VoxelRanges(voxels.Box(), axis, cells[axis]);
  voxels.ForRuns([&](const IndexBox& box, uint32_t entry) {
    const float most = voxels.MaximumOfEntry(entry);
    std::array<Range, 3> touched;
    for (int axis = 0; axis < 3; ++axis) touched[axis] = CellsOf(ranges[axis], {box.min[axis], box.max[axis]});
    IndexBox within;
    const auto clip = [&](int axis, int cell) {
      const Range& range = ranges[axis][static_cast<size_t>(cell)];
      within.min[axis] = std::max(box.min[axis], range.first);
      within.max[axis] = std::min(box.max[axis], range.last);
    };
    for (int z = touched[2].first; z <= touched[2].last; ++z) {
      clip(2, z);
      for (int y = touched[1].first; y <= touched[1].last; ++y) {
        clip(1, y);
        for (int x = touched[0].first; x <= touched[0].last; ++x) {
          float& majorant = majorants[static_cast<size_t>((z * cells[1] + y) * cells[0] + x)];
          if (most <= majorant) continue;
          clip(0, x);
          majorant = std::max(majorant, voxels.MaximumOfBrick(entry, within));
        }
      }
    }
  });
  for (float& majorant : majorants) majorant *= factor * kMajorantMargin;
  return majorants;
}

}  // namespace lampyr
