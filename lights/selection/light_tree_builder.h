// Builds light trees: a binary tree by the surface area orientation heuristic ([Conty18 §4.3]), which is then collapsed
// to nodes of eight children. Private to light_tree.cpp.
#pragma once

#include <memory>
#include <span>

#include "lights/selection/light_tree.h"

namespace lampyr {

class LightTreeBuilder {
 public:
  LightTreeBuilder(std::span<const ClusterBounds> emitters, int threads);
  void BuildInto(LightTree& tree);

 private:
  struct Item {
    Point3 center;
    uint32_t emitter;
  };
  // A node of the binary tree, of items [first, first + count). A leaf if both children are null.
  struct Branch {
    ClusterBounds bounds;
    float normals2 = 0;    // mean squared length of the emitters' mean normals, weighted by intensity
    bool hasEdge = false;  // some emit within a cone narrower than a hemisphere
    size_t first = 0, count = 0;
    std::unique_ptr<Branch> left, right;
  };

  void Grow(Branch& branch, int depth);
  void GrowInParallel(Branch& root);
  bool Divide(Branch& branch, int depth);
  struct Binning;
  // Position between bins `bin` - 1 and `bin` along `axis`; -1: no split.
  struct Split {
    int axis = -1, bin = 0;
  };
  size_t Partition(const Branch& branch, int depth);
  void FillBins(const Branch& branch, Binning& binning) const;
  static Split CheapestSplit(const Binning& binning);
  void Bound(Branch& branch) const;
  void Emit(const Branch& branch, uint32_t parent, int depth, LightTree& tree);
  void PutChild(LightTree::Node& node, int slot, const ClusterBounds& bounds, uint32_t child, uint16_t variety) const;

  void PutPlace(uint32_t emitter);
  Vector3 OffsetOfMean(const LightTree::Below& below, const Point3& mean) const;

  std::span<const ClusterBounds> emitters_;
  int threads_;
  std::vector<Item> items_;
  std::vector<LightTree::Node> nodes_;
  std::vector<LightTree::Below> below_;
  std::vector<LightTree::Place> places_;
  double intensity_ = 0;  // of all places so far
};

}  // namespace lampyr
