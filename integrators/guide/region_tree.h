// Regions of the scene: boxes of positions whose surfaces have the same main direction of the normal. What is learned
// of paths is kept by region (path_guide.h, path_roulette.h).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "math/vec.h"

namespace lampyr {

class ByteReader;
class ByteWriter;

// Main directions of normals, and one for places without a normal.
inline constexpr uint8_t kGuideSides = 7;
// Index of the main direction of `normal`. The normal of an opaque surface faces the path; that of a transmissive one
// is the surface's own; 0: the place has none.
uint8_t GuideSideOf(const Normal3& normal);

// An event of a walk, as regions are made of. Events are of one of two lists, such as those of camera paths and of
// light paths.
struct RegionPoint {
  Point3 position{0.0f};
  uint32_t index = 0;  // in its list
  uint8_t side = 0;    // GuideSideOf
  bool isOfSecond = false;
};

class RegionTree {
 public:
  static constexpr uint32_t kNone = 0xffffffffu;

  RegionTree() = default;  // has no regions
  // Divides space at the median until no region has more than `most` points of either list. Reorders the points by
  // region, those of a list in the order in which they were, and calls `add` with those of each region, in the order of
  // the regions' indices.
  RegionTree(std::span<RegionPoint> points, size_t most, const std::function<void(std::span<const RegionPoint>)>& add);

  // Index of the region; kNone: there are no regions on this side.
  uint32_t Find(const Point3& position, uint8_t side) const {
    uint32_t at = roots_[side];
    if (at == kNone) return kNone;
    while (nodes_[at].axis < 3) {
      const Node& node = nodes_[at];
      at = node.next + (position[node.axis] < node.split ? 0 : 1);
    }
    return nodes_[at].next;
  }

  // Upper bound of the number of regions.
  static constexpr size_t kMostRegions = size_t{1} << 16;

  void Save(ByteWriter& bytes) const;
  // False if the data is not what Save wrote for a tree. Its regions have to be checked by IsOf.
  bool Load(ByteReader& bytes);
  // True if all indices are below `regions`.
  bool IsOf(size_t regions) const;

 private:
  // An inner node divides along `axis`, and its two children follow each other from `next` on; a leaf has axis 3 and
  // the region `next`.
  struct Node {
    float split = 0;
    uint32_t axis = 3, next = 0;
  };
  class Builder;

  std::vector<Node> nodes_;
  std::array<uint32_t, kGuideSides> roots_{kNone, kNone, kNone, kNone, kNone, kNone, kNone};
};

}  // namespace lampyr
