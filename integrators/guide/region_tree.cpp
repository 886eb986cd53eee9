#include "integrators/guide/region_tree.h"

#include <algorithm>
#include <cmath>

#include "base/byte_stream.h"

namespace lampyr {

uint8_t GuideSideOf(const Normal3& normal) {
  if (normal == Normal3(0.0f)) return kGuideSides - 1;
  const Vector3 n = Abs(Vector3(normal));
  const int axis = n.x >= n.y && n.x >= n.z ? 0 : n.y >= n.z ? 1 : 2;
  return static_cast<uint8_t>(2 * axis + (normal[axis] < 0 ? 1 : 0));
}

class RegionTree::Builder {
 public:
  Builder(RegionTree& tree, size_t most, const std::function<void(std::span<const RegionPoint>)>& add)
      : tree_(tree), most_(most), add_(add) {}

  // Makes the node `at` of these points, and all below it.
  void Divide(uint32_t at, std::span<RegionPoint> points) {
    const auto seconds = static_cast<size_t>(
        std::count_if(points.begin(), points.end(), [](const RegionPoint& point) { return point.isOfSecond; }));
    const size_t firsts = points.size() - seconds;
    size_t below = 0;
    if (std::max(firsts, seconds) > most_ && regions_ + 2 < kMostRegions) {
      int axis = 0;
      const float split = Median(points, firsts < seconds, axis);
      // In the same order on every machine, so that sums over a region are the same.
      const auto middle = std::stable_partition(points.begin(), points.end(),
                                                [&](const RegionPoint& point) { return point.position[axis] < split; });
      below = static_cast<size_t>(middle - points.begin());
      if (below > 0 && below < points.size()) {
        const auto next = static_cast<uint32_t>(tree_.nodes_.size());
        tree_.nodes_.resize(next + 2);
        tree_.nodes_[at] = {split, static_cast<uint32_t>(axis), next};
        Divide(next, points.first(below));
        Divide(next + 1, points.subspan(below));
        return;
      }
    }
    tree_.nodes_[at] = {0, 3, regions_++};
    add_(points);
  }

 private:
  // Median position along the axis in which the points of a list lie widest; sets that axis.
  static float Median(std::span<const RegionPoint> points, bool ofSecond, int& axis) {
    Vector3d sum(0.0), squares(0.0);
    double count = 0;
    for (const RegionPoint& point : points) {
      if (point.isOfSecond != ofSecond) continue;
      const Vector3d p(point.position);
      sum += p;
      squares += p * p;
      ++count;
    }
    const Vector3d variance = squares / count - (sum / count) * (sum / count);
    axis = variance.x >= variance.y && variance.x >= variance.z ? 0 : variance.y >= variance.z ? 1 : 2;
    std::vector<float> along;
    along.reserve(static_cast<size_t>(count));
    for (const RegionPoint& point : points)
      if (point.isOfSecond == ofSecond) along.push_back(point.position[axis]);
    const auto middle = along.begin() + static_cast<std::ptrdiff_t>(along.size() / 2);
    std::nth_element(along.begin(), middle, along.end());
    return *middle;
  }

  RegionTree& tree_;
  const size_t most_;
  const std::function<void(std::span<const RegionPoint>)>& add_;
  uint32_t regions_ = 0;
};

RegionTree::RegionTree(std::span<RegionPoint> points, size_t most,
                       const std::function<void(std::span<const RegionPoint>)>& add) {
  std::stable_sort(points.begin(), points.end(),
                   [](const RegionPoint& a, const RegionPoint& b) { return a.side < b.side; });
  Builder builder(*this, most, add);
  for (size_t begin = 0; begin < points.size();) {
    const uint8_t side = points[begin].side;
    size_t end = begin;
    while (end < points.size() && points[end].side == side) ++end;
    roots_[side] = static_cast<uint32_t>(nodes_.size());
    nodes_.emplace_back();
    builder.Divide(roots_[side], points.subspan(begin, end - begin));
    begin = end;
  }
}

void RegionTree::Save(ByteWriter& bytes) const {
  bytes.Value(roots_);
  bytes.List(std::span(nodes_));
}

bool RegionTree::Load(ByteReader& bytes) {
  roots_ = bytes.Value<decltype(roots_)>();
  nodes_ = bytes.List<Node>(2 * kMostRegions + kGuideSides);
  for (const uint32_t root : roots_)
    if (root != kNone && root >= nodes_.size()) return false;
  for (size_t i = 0; i < nodes_.size(); ++i) {
    const Node& node = nodes_[i];
    if (node.axis > 3) return false;
    if (node.axis == 3) continue;
    // Children come after their parent, so that every descent ends.
    if (!(node.next > i && size_t{node.next} + 1 < nodes_.size() && std::isfinite(node.split))) return false;
  }
  return true;
}

bool RegionTree::IsOf(size_t regions) const {
  return std::all_of(nodes_.begin(), nodes_.end(),
                     [regions](const Node& node) { return node.axis < 3 || node.next < regions; });
}

}  // namespace lampyr
