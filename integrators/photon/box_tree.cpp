#include "integrators/photon/box_tree.h"

#include <algorithm>

namespace lampyr {

BoxTree::BoxTree(std::span<const Bounds3> boxes) {
  size_t count = boxes.size();
  for (uint32_t level = 0; count > 0; ++level) {
    const size_t children = count;
    counts_.push_back(static_cast<uint32_t>(children));
    count = (children + kWidth - 1) / kWidth;
    starts_.push_back(static_cast<uint32_t>(nodes_.size()));
    nodes_.resize(nodes_.size() + count);
    Node* const nodes = &nodes_[starts_[level]];
    for (size_t i = 0; i < count * kWidth; ++i) {
      Node& node = nodes[i / kWidth];
      const size_t slot = i % kWidth;
      for (size_t axis = 0; axis < 3; ++axis) {
        float least = kInfinity, most = -kInfinity;
        if (i < children && level == 0) {
          const auto a = static_cast<glm::length_t>(axis);
          least = boxes[i].min[a];
          most = boxes[i].max[a];
        } else if (i < children) {
          const Node& child = nodes_[starts_[level - 1] + i];
          least = *std::min_element(child.least[axis].begin(), child.least[axis].end());
          most = *std::max_element(child.most[axis].begin(), child.most[axis].end());
        }
        node.least[axis][slot] = least;
        node.most[axis][slot] = most;
      }
    }
    if (count == 1) break;
  }
}

void BoxTree::Find(const Ray& ray, float tMax, std::vector<uint32_t>& found) const {
  if (nodes_.empty()) return;
  const Vector3 inverse = 1.0f / ray.direction;
  struct Entry {
    uint32_t level, index;
  };
  std::array<Entry, 12 * kWidth> stack;  // 32 bits of indices are eleven levels
  size_t waiting = 0;
  stack[waiting++] = {static_cast<uint32_t>(starts_.size() - 1), 0};
  while (waiting > 0) {
    const Entry entry = stack[--waiting];
    const Node& node = nodes_[starts_[entry.level] + entry.index];
    uint32_t met = 0;
    const uint32_t children = std::min(counts_[entry.level] - entry.index * kWidth, kWidth);
    for (uint32_t slot = 0; slot < children; ++slot) {
      float enters = 0, leaves = tMax;
      for (glm::length_t axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<size_t>(axis);
        const float low = (node.least[a][slot] - ray.origin[axis]) * inverse[axis];
        const float high = (node.most[a][slot] - ray.origin[axis]) * inverse[axis];
        // A NaN (0 · infinity, a ray within a side of the box) leaves the interval as it is.
        enters = std::max(enters, std::min(low, high));
        leaves = std::min(leaves, std::max(low, high));
      }
      constexpr float kMargin = 1 + 1e-6f;
      if (enters <= leaves * kMargin) met |= 1u << slot;
    }
    if (entry.level > 0) {
      // From the last child to the first: items come by increasing index.
      for (uint32_t slot = kWidth; slot-- > 0;) {
        if (met & 1u << slot) stack[waiting++] = {entry.level - 1, entry.index * kWidth + slot};
      }
      continue;
    }
    for (uint32_t slot = 0; slot < kWidth; ++slot) {
      if (met & 1u << slot) found.push_back(entry.index * kWidth + slot);
    }
  }
}

}  // namespace lampyr
