#include "lights/selection/light_tree_builder.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/parallel.h"

namespace lampyr {

namespace {

constexpr int kBins = 16;
constexpr size_t kLeaf = LightTree::kWidth;
// From this depth on, nodes are halved, so that the depth is bounded whatever the splits were.
constexpr int kDepthOfHalves = 40;

// Orientation measure: solid angle of a cone of normals with the emission beyond it ([Conty18 eq. 1]).
float OrientationMeasure(float thetaO, float thetaE) {
  const float thetaW = std::min(thetaO + thetaE, kPi);
  const float sinO = std::sin(thetaO), cosO = std::cos(thetaO);
  return 2 * kPi * (1 - cosO) +
         0.5f * kPi * (2 * thetaW * sinO - std::cos(thetaO - 2 * thetaW) - 2 * thetaO * sinO + cosO);
}

// Surface area plus a small part of the diagonal, because the bounds of collinear points have no area.
float SpatialMeasure(const Bounds3& box) {
  const Vector3 d = box.Diagonal();
  return 2 * (d.x * d.y + d.y * d.z + d.z * d.x) + 0.05f * glm::dot(d, d);
}

// Contents of a bin. Its cone is approximated from the length of the sum of axes.
struct Bin {
  Bounds3 box;
  Vector3 axes{0.0f};
  float widestO = 0, widestE = 0;  // angles
  float intensity = 0;
  size_t count = 0;

  void Add(const Bin& other) {
    box.Add(other.box);
    axes += other.axes;
    widestO = std::max(widestO, other.widestO);
    widestE = std::max(widestE, other.widestE);
    intensity += other.intensity;
    count += other.count;
  }
  float Cost() const {
    if (count == 0) return 0;
    const float left = std::min(glm::length(axes) / static_cast<float>(count), 1.0f);
    const float spread = std::acos(std::clamp(2 * left - 1, -1.0f, 1.0f));
    return intensity * SpatialMeasure(box) * OrientationMeasure(std::min(spread + widestO, kPi), widestE);
  }
};

}  // namespace

LightTreeBuilder::LightTreeBuilder(std::span<const ClusterBounds> emitters, int threads)
    : emitters_(emitters), threads_(threads) {
  for (uint32_t i = 0; i < emitters_.size(); ++i) {
    if (!emitters_[i].IsEmpty()) items_.push_back({emitters_[i].box.Center(), i});
  }
}

void LightTreeBuilder::Bound(Branch& branch) const {
  branch.bounds = ClusterBounds();
  const auto add = [&branch](const ClusterBounds& bounds, float normals2, bool hasEdge) {
    branch.bounds.Add(bounds);
    const float share = branch.bounds.intensity > 0 ? bounds.intensity / branch.bounds.intensity : 1.0f;
    branch.normals2 += share * (normals2 - branch.normals2);
    branch.hasEdge |= hasEdge;
  };
  if (branch.left) {
    for (const Branch* part : {branch.left.get(), branch.right.get()}) add(part->bounds, part->normals2, part->hasEdge);
    return;
  }
  for (size_t i = branch.first; i < branch.first + branch.count; ++i) {
    const ClusterBounds& emitter = emitters_[items_[i].emitter];
    const bool shinesAllAround = emitter.cosThetaO <= -1;
    add(emitter, LengthSquared(emitter.meanNormal), !shinesAllAround && emitter.cosThetaE > 0);
  }
}

// Bins of a branch's items along each axis of the bounds of their centroids.
struct LightTreeBuilder::Binning {
  using Row = std::array<Bin, kBins>;
  Bounds3 centers;
  Vector3 extent{0.0f};
  std::array<Row, 3> rows;

  int BinOf(const Item& item, int axis) const {
    const float t = (item.center[axis] - centers.min[axis]) / extent[axis] * kBins;
    return std::min(static_cast<int>(t), kBins - 1);
  }
};

void LightTreeBuilder::FillBins(const Branch& branch, Binning& binning) const {
  const Vector3 reference = emitters_[items_[branch.first].emitter].axis;
  for (size_t i = branch.first; i < branch.first + branch.count; ++i) {
    const Item& item = items_[i];
    const ClusterBounds& emitter = emitters_[item.emitter];
    Bin one;
    one.box = emitter.box;
    one.axes = emitter.twoSided && glm::dot(emitter.axis, reference) < 0 ? -emitter.axis : emitter.axis;
    one.widestO = emitter.cosThetaO >= 1 ? 0.0f : std::acos(emitter.cosThetaO);
    one.widestE = emitter.cosThetaE <= 0 ? 0.5f * kPi : emitter.cosThetaE >= 1 ? 0.0f : std::acos(emitter.cosThetaE);
    one.intensity = emitter.intensity;
    one.count = 1;
    for (int axis = 0; axis < 3; ++axis) {
      if (binning.extent[axis] > 0)
        binning.rows[static_cast<size_t>(axis)][static_cast<size_t>(binning.BinOf(item, axis))].Add(one);
    }
  }
}

// The split of least cost ([Conty18 §4.3]); no axis: no split has items on both sides.
LightTreeBuilder::Split LightTreeBuilder::CheapestSplit(const Binning& binning) {
  const Vector3& extent = binning.extent;
  const float longest = std::max({extent.x, extent.y, extent.z});
  Split best;
  float leastCost = kInfinity;
  for (int axis = 0; axis < 3; ++axis) {
    if (!(extent[axis] > 0)) continue;
    const Binning::Row& row = binning.rows[static_cast<size_t>(axis)];
    std::array<float, kBins> above{};
    std::array<size_t, kBins> countAbove{};
    Bin sum;
    for (size_t b = kBins - 1; b > 0; --b) {
      sum.Add(row[b]);
      above[b] = sum.Cost();
      countAbove[b] = sum.count;
    }
    sum = Bin();
    for (size_t b = 1; b < kBins; ++b) {
      sum.Add(row[b - 1]);
      if (sum.count == 0 || countAbove[b] == 0) continue;
      // Regularisation against splits of thin boxes along their short axes.
      const float cost = (sum.Cost() + above[b]) * longest / extent[axis];
      if (cost < leastCost) {
        leastCost = cost;
        best = {axis, static_cast<int>(b)};
      }
    }
  }
  return best;
}

// Partitions the items of a branch; returns the number on the first side.
size_t LightTreeBuilder::Partition(const Branch& branch, int depth) {
  const auto begin = items_.begin() + static_cast<std::ptrdiff_t>(branch.first);
  const auto end = begin + static_cast<std::ptrdiff_t>(branch.count);
  const size_t half = branch.count / 2;
  Binning binning;
  for (auto item = begin; item != end; ++item) binning.centers.Add(item->center);
  const Vector3 extent = binning.extent = binning.centers.Diagonal();
  const float longest = std::max({extent.x, extent.y, extent.z});
  if (!(longest > 0)) return half;  // all at one position
  if (depth >= kDepthOfHalves) {
    const int axis = extent.x == longest ? 0 : extent.y == longest ? 1 : 2;
    std::nth_element(begin, begin + static_cast<std::ptrdiff_t>(half), end, [axis](const Item& a, const Item& b) {
      return a.center[axis] != b.center[axis] ? a.center[axis] < b.center[axis] : a.emitter < b.emitter;
    });
    return half;
  }
  FillBins(branch, binning);
  const Split split = CheapestSplit(binning);
  if (split.axis < 0) return half;
  const auto middle =
      std::stable_partition(begin, end, [&](const Item& item) { return binning.BinOf(item, split.axis) < split.bin; });
  const auto count = static_cast<size_t>(middle - begin);
  return count == 0 || count == branch.count ? half : count;
}

bool LightTreeBuilder::Divide(Branch& branch, int depth) {
  if (branch.count <= kLeaf) return false;
  const size_t count = Partition(branch, depth);
  branch.left = std::make_unique<Branch>();
  branch.right = std::make_unique<Branch>();
  branch.left->first = branch.first;
  branch.left->count = count;
  branch.right->first = branch.first + count;
  branch.right->count = branch.count - count;
  return true;
}

void LightTreeBuilder::Grow(Branch& branch, int depth) {
  if (Divide(branch, depth)) {
    Grow(*branch.left, depth + 1);
    Grow(*branch.right, depth + 1);
  }
  Bound(branch);
}

// Divides the upper branches serially and those below in parallel. The boundary depends on counts alone, not on
// threads.
void LightTreeBuilder::GrowInParallel(Branch& root) {
  constexpr size_t kAlone = 16384;  // items of a task
  struct Open {
    Branch* branch;
    int depth;
  };
  std::vector<Open> inner, outer, open{{&root, 0}};
  while (!open.empty()) {
    const Open next = open.back();
    open.pop_back();
    if (next.branch->count <= kAlone) {
      outer.push_back(next);
      continue;
    }
    Divide(*next.branch, next.depth);
    inner.push_back(next);
    open.push_back({next.branch->right.get(), next.depth + 1});
    open.push_back({next.branch->left.get(), next.depth + 1});
  }
  ParallelFor(static_cast<int>(outer.size()), threads_, [&](int i) {
    const Open& one = outer[static_cast<size_t>(i)];
    Grow(*one.branch, one.depth);
  });
  for (auto one = inner.rbegin(); one != inner.rend(); ++one) Bound(*one->branch);
}

void LightTreeBuilder::PutChild(LightTree::Node& node, int slot, const ClusterBounds& bounds, uint32_t child,
                                uint16_t variety) const {
  node.lobes.Set(slot, LobeOf(bounds));
  node.variety[slot] = variety;
  node.child[slot] = child;
}

// Stores the intensity as it is read again, as the difference of two sums, so that probabilities have the same bits.
void LightTreeBuilder::PutPlace(uint32_t emitter) {
  places_.push_back({intensity_, emitter, emitters_[emitter].mean});
  intensity_ += static_cast<double>(emitters_[emitter].intensity);
}

Vector3 LightTreeBuilder::OffsetOfMean(const LightTree::Below& below, const Point3& mean) const {
  Point3d sum(0.0);
  for (size_t i = below.first; i < below.first + below.count; ++i) {
    const double next = i + 1 < places_.size() ? places_[i + 1].before : intensity_;
    const auto intensity = static_cast<double>(static_cast<float>(next - places_[i].before));
    sum += intensity * Point3d(places_[i].position - mean);
  }
  return below.intensity > 0 ? Vector3(sum / below.intensity) : Vector3(0.0f);
}

// Makes a node of eight children: opens the largest child until there are eight, and fills remaining slots with the
// emitters of small leaves.
void LightTreeBuilder::Emit(const Branch& branch, uint32_t parent, int depth, LightTree& tree) {
  constexpr auto width = static_cast<size_t>(LightTree::kWidth);
  tree.depth_ = std::max(tree.depth_, depth);
  std::vector<const Branch*> children{&branch};
  const auto isLarger = [](const Branch* a, const Branch* b) {
    const float ofA = a->bounds.intensity * SpatialMeasure(a->bounds.box);
    const float ofB = b->bounds.intensity * SpatialMeasure(b->bounds.box);
    return ofA != ofB ? ofA > ofB : a->count > b->count;
  };
  while (children.size() < width) {
    size_t largest = children.size();
    for (size_t i = 0; i < children.size(); ++i) {
      if (!children[i]->left) continue;
      if (largest == children.size() || isLarger(children[i], children[largest])) largest = i;
    }
    if (largest == children.size()) break;
    const Branch* opened = children[largest];
    children[largest] = opened->left.get();
    children.push_back(opened->right.get());
  }
  const auto index = static_cast<uint32_t>(nodes_.size());
  nodes_.push_back({});
  below_.push_back({intensity_, 0, static_cast<uint32_t>(places_.size()), 0, Vector3(0.0f)});
  tree.parents_.push_back(parent);
  size_t slots = children.size();
  std::sort(children.begin(), children.end(), [](const Branch* a, const Branch* b) {
    return a->count != b->count ? a->count < b->count : a->first < b->first;
  });
  int slot = 0;
  for (const Branch* child : children) {
    const bool isSpread = !child->left && slots - 1 + child->count <= width;
    if (isSpread) {
      slots += child->count - 1;
      for (size_t i = child->first; i < child->first + child->count; ++i) {
        const uint32_t emitter = items_[i].emitter;
        constexpr uint16_t ofAnEmitter = 0xbf80;  // -1
        PutPlace(emitter);
        PutChild(nodes_[index], slot, emitters_[emitter], LightTree::kEmitter | emitter, ofAnEmitter);
        nodes_[index].lobes.intensity[slot] = static_cast<float>(intensity_ - places_.back().before);
        tree.slots_[emitter] = index * LightTree::kWidth + static_cast<uint32_t>(slot++);
      }
      continue;
    }
    const uint16_t variety =
        RoundUpToBfloat16(child->hasEdge ? LightTree::kUnlike
                                         : std::max(child->normals2 - LengthSquared(child->bounds.meanNormal), 0.0f));
    PutChild(nodes_[index], slot, child->bounds, static_cast<uint32_t>(nodes_.size()), variety);
    Emit(*child, index * LightTree::kWidth + static_cast<uint32_t>(slot), depth + 1, tree);
    ++slot;
  }
  LightTree::Below& below = below_[index];
  below.count = static_cast<uint32_t>(places_.size()) - below.first;
  below.intensity = intensity_ - below.before;
  below.offset = OffsetOfMean(below, branch.bounds.mean);
}

void LightTreeBuilder::BuildInto(LightTree& tree) {
  tree.slots_.assign(emitters_.size(), LightTree::kNone);
  if (items_.empty()) return;
  Branch root;
  root.count = items_.size();
  GrowInParallel(root);
  Emit(root, LightTree::kNone, 1, tree);
  tree.nodes_ = LargeArray<LightTree::Node>(nodes_.size());
  std::copy(nodes_.begin(), nodes_.end(), &tree.nodes_[0]);
  tree.below_ = LargeArray<LightTree::Below>(below_.size());
  std::copy(below_.begin(), below_.end(), &tree.below_[0]);
  places_.push_back({intensity_, LightTree::kNone, Point3(0.0f)});
  tree.places_ = LargeArray<LightTree::Place>(places_.size());
  std::copy(places_.begin(), places_.end(), &tree.places_[0]);
  tree.parents_.shrink_to_fit();
}

}  // namespace lampyr
