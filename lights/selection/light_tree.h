// A tree over emitters that chooses one of them for a receiver, in proportion to an estimate of what it sends there
// ([Conty18 §4, §5]). Nodes have eight children, whose importances are evaluated together.
//
// The probability of a given emitter is the product of its shares on the way from the root, which it knows the nodes
// of: O(depth), the same operations in the same order as when it was chosen, and so the same bits.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "lights/selection/light_bounds.h"

namespace lampyr {

class LightTree {
 public:
  LightTree() = default;
  // Emitters with empty bounds are never chosen. Builds on `threads`; the tree is the same for any number of them.
  LightTree(std::span<const ClusterBounds> emitters, int threads);

  // Shares of a choice that does not look at the receiver (by intensity) beside those that do: what the estimate
  // overlooks keeps a chance.
  struct Probabilities {
    double seen = 1, blind = 1;
  };
  struct Choice {
    uint32_t emitter = 0;
    Probabilities probability;
    double u = 0;  // the random number, stretched over [0,1) again
  };
  // u in [0,1). By the receiver, or blindly. Requires !IsEmpty().
  Choice Select(const TreeReceiver& receiver, double u, bool blindly) const;
  // 0 for emitters that are never chosen.
  Probabilities ProbabilityOf(const TreeReceiver& receiver, uint32_t emitter) const;

  // The importances of the root's children, added up: an estimate of the irradiance from all emitters.
  float TotalImportance(const TreeReceiver& receiver) const;

  bool IsEmpty() const { return nodes_.empty(); }
  size_t Bytes() const;
  int Depth() const { return depth_; }

  static constexpr int kWidth = 8;
  static constexpr uint32_t kNone = 0xffffffffu;

  struct alignas(32) Node {
    float minX[kWidth], minY[kWidth], minZ[kWidth], maxX[kWidth], maxY[kWidth], maxZ[kWidth];
    float axisX[kWidth], axisY[kWidth], axisZ[kWidth];
    float cosThetaO[kWidth], cosThetaE[kWidth], intensity[kWidth];  // intensity 0: nothing there
    uint32_t child[kWidth];                                         // a node, or an emitter: see kEmitter
    uint32_t parent = kNone;  // the slot in the node above: node · kWidth + child
    uint32_t twoSided = 0;    // a bit each
  };

 private:
  static constexpr uint32_t kEmitter = 0x80000000u;

  friend class LightTreeBuilder;

  std::vector<Node> nodes_;      // the root first
  std::vector<uint32_t> slots_;  // of each emitter: node · kWidth + child
  int depth_ = 0;                // nodes from the root to an emitter, at most
};

}  // namespace lampyr
