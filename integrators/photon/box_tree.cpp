#include "integrators/photon/box_tree.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

namespace lampyr {

namespace {

// The children of a node side by side.
using Lanes [[gnu::vector_size(32)]] = float;
using Mask [[gnu::vector_size(32)]] = int32_t;

Lanes LoadedFrom(const std::array<float, 8>& values) {
  Lanes lanes;
  std::memcpy(&lanes, values.data(), sizeof(lanes));
  return lanes;
}

// A bit for each lane that is set.
uint32_t BitsOf(const Mask& mask) {
  constexpr Mask kBits = {1, 2, 4, 8, 16, 32, 64, 128};
  const auto pairs = std::bit_cast<std::array<uint64_t, 4>>(mask & kBits);
  const uint64_t all = (pairs[0] | pairs[1]) | (pairs[2] | pairs[3]);
  return static_cast<uint32_t>(all | all >> 32);
}

}  // namespace

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
  // Bounded, because 0 times infinity is not a number.
  Vector3 inverse;
  for (int axis = 0; axis < 3; ++axis) {
    constexpr float kLeast = 1e-15f;
    const float d = ray.direction[axis];
    inverse[axis] = 1 / (std::abs(d) < kLeast ? std::copysign(kLeast, d) : d);
  }
  struct Entry {
    uint32_t level, index;
  };
  std::array<Entry, 12 * kWidth> stack;  // 32 bits of indices are eleven levels
  size_t waiting = 0;
  stack[waiting++] = {static_cast<uint32_t>(starts_.size() - 1), 0};
  while (waiting > 0) {
    const Entry entry = stack[--waiting];
    const Node& node = nodes_[starts_[entry.level] + entry.index];
    const uint32_t children = std::min(counts_[entry.level] - entry.index * kWidth, kWidth);
    Lanes enters = {}, leaves = Lanes{} + tMax;
    for (glm::length_t axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<size_t>(axis);
      const bool isForward = inverse[axis] > 0;
      const Lanes first = (LoadedFrom(isForward ? node.least[a] : node.most[a]) - ray.origin[axis]) * inverse[axis];
      const Lanes last = (LoadedFrom(isForward ? node.most[a] : node.least[a]) - ray.origin[axis]) * inverse[axis];
      enters = first > enters ? first : enters;
      leaves = last < leaves ? last : leaves;
    }
    constexpr float kMargin = 1 + 1e-6f;
    const Mask isMet = enters <= leaves * kMargin;
    uint32_t met = BitsOf(isMet) & ((1u << children) - 1);
    if (entry.level > 0) {
      // From the last child to the first: items come by increasing index.
      for (; met != 0; met &= ~(1u << (std::bit_width(met) - 1)))
        stack[waiting++] = {entry.level - 1, entry.index * kWidth + static_cast<uint32_t>(std::bit_width(met)) - 1};
      continue;
    }
    for (; met != 0; met &= met - 1)
      found.push_back(entry.index * kWidth + static_cast<uint32_t>(std::countr_zero(met)));
  }
}

}  // namespace lampyr
