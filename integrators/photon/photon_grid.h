// A grid over the photons on surfaces, for lookups that find few of them.
//
// Photons are in the order of a Morton curve, so that those of a cell follow each other: a cell is a first photon and
// a count, in a hash table. A lookup about as wide as a cell reads a few slots of the table, which do not wait for each
// other, where a tree follows one node after another.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/large_array.h"
#include "integrators/photon/box_tree.h"
#include "math/vec.h"

namespace lampyr {

// A photon while a map is sorted by cells.
struct SortItem {
  uint32_t cell, item;
};

// Cells along a Morton curve, 1024 along the longest side of what they cover.
class MortonFrame {
 public:
  static constexpr uint32_t kBits = 10;  // per axis

  MortonFrame() = default;
  MortonFrame(const Point3& least, float longest);

  // Along an axis; a greater coordinate has no lesser cell, whatever the rounding. Beyond the ends: the last cell. Of
  // what is not a number: 0.
  uint32_t CellOf(float coordinate, int axis) const {
    constexpr float last = (1 << kBits) - 1;
    return static_cast<uint32_t>(std::min(std::max(0.0f, (coordinate - least_[axis]) * scale_), last));
  }
  uint32_t CodeOf(const Point3& p) const { return MortonCode(CellOf(p.x, 0), CellOf(p.y, 1), CellOf(p.z, 2)); }

 private:
  Point3 least_{0.0f};
  float scale_ = 0;  // cells per scene unit
};

class PhotonGrid {
 public:
  PhotonGrid() = default;
  // `sorted`: the cells of the photons in `frame`, in ascending order. `positions`: of the same photons.
  PhotonGrid(const MortonFrame& frame, std::span<const SortItem> sorted, std::vector<Point3> positions);

  // Fetches into the cache the cells that Find reads first, while other work goes on.
  void PrefetchCells(const Point3& center, float radius) const;

  // Sets `found` to the indices of all photons nearer than `radius` (scene units), and `distances` to the squares of
  // their distances. False, without a result, if a tree is likely to be faster: where the radius spans many cells, or
  // the cells that it meets hold many photons.
  bool Find(const Point3& center, float radius, std::vector<uint32_t>& found, std::vector<float>& distances) const;

  const std::vector<Point3>& Positions() const { return positions_; }
  size_t Bytes() const { return positions_.size() * sizeof(Point3) + slots_.Size() * sizeof(Slot); }

 private:
  struct Slot {
    uint32_t cell, first, count;  // count 0: empty
  };
  static constexpr uint32_t kMostCells = 27;  // of a lookup
  // The cells within `radius`, whose slots are fetched into the cache. Returns their number; 0: more than kMostCells.
  uint32_t FetchCells(const Point3& center, float radius, std::array<uint32_t, kMostCells>& cells) const;
  uint32_t SlotOf(uint32_t cell) const { return (cell * 0x9e3779b1u) >> hashShift_; }
  Slot Lookup(uint32_t cell) const;

  MortonFrame frame_;
  uint32_t coarser_ = 0;  // a cell of the grid has 2^coarser_ cells of the frame on a side
  uint32_t hashShift_ = 0;
  LargeArray<Slot> slots_;
  std::vector<Point3> positions_;
};

}  // namespace lampyr
