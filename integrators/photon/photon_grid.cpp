#include "integrators/photon/photon_grid.h"

#include <array>
#include <bit>

#include "base/large_pages.h"

namespace lampyr {

namespace {

// Photons per occupied cell at least, and up to four times as many on surfaces. Lookups of the integrators find 0
// to 10.
constexpr size_t kPerCell = 4;
// Above, or above kMostCells, FLANN's tree is about as fast.
constexpr uint32_t kMostPhotons = 160;

// Number of occupied cells at each resolution: element b is for 2^b cells per axis.
std::array<size_t, MortonFrame::kBits + 1> CountOccupied(std::span<const SortItem> sorted) {
  std::array<size_t, MortonFrame::kBits + 1> occupied{};
  occupied[0] = 1;
  for (size_t i = 1; i < sorted.size(); ++i) {
    const uint32_t differs = sorted[i - 1].cell ^ sorted[i].cell;
    if (differs == 0) continue;
    const auto highest = static_cast<uint32_t>(std::bit_width(differs)) - 1;
    ++occupied[MortonFrame::kBits - highest / 3];
  }
  for (size_t bits = 1; bits < occupied.size(); ++bits) occupied[bits] += occupied[bits - 1];
  return occupied;
}

}  // namespace

MortonFrame::MortonFrame(const Point3& least, float longest)
    : least_(least), scale_(longest > 0 ? static_cast<float>((1 << kBits) - 1) / longest : 0.0f) {}

PhotonGrid::PhotonGrid(const MortonFrame& frame, std::span<const SortItem> sorted, std::vector<Point3> positions)
    : frame_(frame), positions_(std::move(positions)) {
  if (sorted.empty()) return;
  const auto occupied = CountOccupied(sorted);
  uint32_t bits = MortonFrame::kBits;
  while (bits > 0 && occupied[bits] * kPerCell > sorted.size()) --bits;
  coarser_ = MortonFrame::kBits - bits;
  const auto hashBits = static_cast<uint32_t>(std::bit_width(occupied[bits])) + 1;  // at most half full
  hashShift_ = 32 - hashBits;
  slots_ = LargeArray<Slot>(size_t{1} << hashBits);
  const uint32_t mask = (1u << hashBits) - 1;
  for (size_t i = 0; i < sorted.size();) {
    const uint32_t cell = sorted[i].cell >> 3 * coarser_;
    const size_t first = i;
    while (i < sorted.size() && sorted[i].cell >> 3 * coarser_ == cell) ++i;
    uint32_t at = SlotOf(cell);
    while (slots_[at].count > 0) at = (at + 1) & mask;
    slots_[at] = {cell, static_cast<uint32_t>(first), static_cast<uint32_t>(i - first)};
  }
}

PhotonGrid::Slot PhotonGrid::Lookup(uint32_t cell) const {
  const uint32_t mask = static_cast<uint32_t>(slots_.Size()) - 1;
  uint32_t at = SlotOf(cell);
  while (slots_[at].count > 0 && slots_[at].cell != cell) at = (at + 1) & mask;
  return slots_[at];
}

uint32_t PhotonGrid::FetchCells(const Point3& center, float radius, std::array<uint32_t, kMostCells>& cells) const {
  // Rounding must not leave out a cell with a photon on the rim. Sums are rounded monotonically, as cells are.
  const float reach = radius * 1.00001f;
  std::array<uint32_t, 3> first, last;
  uint32_t count = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<size_t>(axis);
    first[a] = frame_.CellOf(center[axis] - reach, axis) >> coarser_;
    last[a] = frame_.CellOf(center[axis] + reach, axis) >> coarser_;
    count *= last[a] - first[a] + 1;
  }
  if (count > kMostCells) return 0;
  count = 0;
  for (uint32_t z = first[2]; z <= last[2]; ++z) {
    for (uint32_t y = first[1]; y <= last[1]; ++y) {
      for (uint32_t x = first[0]; x <= last[0]; ++x) {
        cells[count] = MortonCode(x, y, z);
        Prefetch(&slots_[SlotOf(cells[count++])]);
      }
    }
  }
  return count;
}

void PhotonGrid::PrefetchCells(const Point3& center, float radius) const {
  std::array<uint32_t, kMostCells> cells;
  if (slots_.Size() > 0) FetchCells(center, radius, cells);
}

bool PhotonGrid::Find(const Point3& center, float radius, std::vector<uint32_t>& found,
                      std::vector<float>& distances) const {
  std::array<uint32_t, kMostCells> cells;
  const uint32_t count = FetchCells(center, radius, cells);
  if (count == 0) return false;
  std::array<Slot, kMostCells> runs;
  uint32_t occupied = 0, photons = 0;
  for (uint32_t i = 0; i < count; ++i) {
    const Slot slot = Lookup(cells[i]);
    if (slot.count == 0) continue;
    Prefetch(&positions_[slot.first]);
    runs[occupied++] = slot;
    photons += slot.count;
  }
  if (photons > kMostPhotons) return false;
  found.clear();
  distances.clear();
  const float radiusSquared = radius * radius;
  for (uint32_t run = 0; run < occupied; ++run) {
    const uint32_t end = runs[run].first + runs[run].count;
    for (uint32_t i = runs[run].first; i < end; ++i) {
      const float distance = LengthSquared(positions_[i] - center);
      if (!(distance < radiusSquared)) continue;
      found.push_back(i);
      distances.push_back(distance);
    }
  }
  return true;
}

}  // namespace lampyr
