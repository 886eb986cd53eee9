// A tree of boxes, searched along a ray.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/ray.h"
#include "math/bounds.h"

namespace lampyr {

// Place on a Morton curve, which keeps neighbours in space near each other. Coordinates: below 1024.
inline uint32_t MortonCode(uint32_t x, uint32_t y, uint32_t z) {
  const auto spread = [](uint32_t bits) {
    bits = (bits | bits << 16) & 0x030000ff;
    bits = (bits | bits << 8) & 0x0300f00f;
    bits = (bits | bits << 4) & 0x030c30c3;
    return (bits | bits << 2) & 0x09249249;
  };
  return spread(x) << 2 | spread(y) << 1 | spread(z);
}

// Each node has up to eight children, whose boxes it holds side by side. Nodes are complete, level by level: no
// pointers.
class BoxTree {
 public:
  BoxTree() = default;
  // `boxes`: near each other where they are neighbours in the list.
  explicit BoxTree(std::span<const Bounds3> boxes);

  // Adds the indices of the boxes that the ray meets on [0, tMax], by increasing index.
  void Find(const Ray& ray, float tMax, std::vector<uint32_t>& found) const;
  size_t Bytes() const { return nodes_.size() * sizeof(Node); }

 private:
  static constexpr uint32_t kWidth = 8;
  struct Node {
    std::array<std::array<float, kWidth>, 3> least, most;  // of the children; beyond the last without meaning
  };

  std::vector<Node> nodes_;       // level by level, the leaves first
  std::vector<uint32_t> starts_;  // of each level
  std::vector<uint32_t> counts_;  // of the children of each level
};

}  // namespace lampyr
