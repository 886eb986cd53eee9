#include "integrators/guide/path_guide.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "base/byte_stream.h"
#include "base/error.h"
#include "base/parallel.h"

namespace lampyr {

namespace {

// Events of either walk that a region has before it is divided.
constexpr size_t kMostInRegion = 1200;

}  // namespace

uint8_t GuideSideOf(const Normal3& normal) {
  if (normal == Normal3(0.0f)) return kGuideSides - 1;
  const Vector3 n = Abs(Vector3(normal));
  const int axis = n.x >= n.y && n.x >= n.z ? 0 : n.y >= n.z ? 1 : 2;
  return static_cast<uint8_t>(2 * axis + (normal[axis] < 0 ? 1 : 0));
}

// The events of a node.
struct PathGuide::Part {
  std::span<PlacedEvent> ofCamera, ofLight;

  size_t Most() const { return std::max(ofCamera.size(), ofLight.size()); }
  std::span<PlacedEvent> Larger() const { return ofCamera.size() >= ofLight.size() ? ofCamera : ofLight; }
};

class PathGuide::Builder {
 public:
  explicit Builder(PathGuide& guide) : guide_(guide) {}

  // Makes the node `at` of a part, and all below it.
  void Divide(uint32_t at, const Part& part) {
    int axis = 0;
    const bool isDivided = part.Most() > kMostInRegion && parts_.size() + 2 < kMostRegions;
    const float split = isDivided ? Median(part.Larger(), axis) : 0;
    const auto before = [&](const PlacedEvent& event) { return event.position[axis] < split; };
    const auto camera = isDivided ? Partition(part.ofCamera, before) : 0,
               light = isDivided ? Partition(part.ofLight, before) : 0;
    const Part first{part.ofCamera.first(camera), part.ofLight.first(light)};
    const Part second{part.ofCamera.subspan(camera), part.ofLight.subspan(light)};
    if (!isDivided || first.Most() == 0 || second.Most() == 0) {
      guide_.nodes_[at] = {0, 3, static_cast<uint32_t>(parts_.size())};
      parts_.push_back(part);
      return;
    }
    const auto next = static_cast<uint32_t>(guide_.nodes_.size());
    guide_.nodes_.resize(next + 2);
    guide_.nodes_[at] = {split, static_cast<uint32_t>(axis), next};
    Divide(next, first);
    Divide(next + 1, second);
  }
  void Fit(int threads) {
    guide_.regions_.resize(parts_.size());
    ParallelFor(static_cast<int>(parts_.size()), threads, [&](int i) {
      const Part& part = parts_[static_cast<size_t>(i)];
      GuideRegion& region = guide_.regions_[static_cast<size_t>(i)];
      region.radiance = FitOne(part.ofCamera);
      region.importance = FitOne(part.ofLight);
    });
  }

 private:
  // Median position along the axis in which the events lie widest; sets that axis.
  static float Median(std::span<PlacedEvent> events, int& axis) {
    Vector3d sum(0.0), squares(0.0);
    for (const PlacedEvent& event : events) {
      const Vector3d p(event.position);
      sum += p;
      squares += p * p;
    }
    const auto count = static_cast<double>(events.size());
    const Vector3d variance = squares / count - (sum / count) * (sum / count);
    axis = variance.x >= variance.y && variance.x >= variance.z ? 0 : variance.y >= variance.z ? 1 : 2;
    std::vector<float> along;
    along.reserve(events.size());
    for (const PlacedEvent& event : events) along.push_back(event.position[axis]);
    const auto middle = along.begin() + static_cast<std::ptrdiff_t>(along.size() / 2);
    std::nth_element(along.begin(), middle, along.end());
    return *middle;
  }
  // In the same order on every machine, so that sums are the same.
  template <class Before>
  static size_t Partition(std::span<PlacedEvent> events, const Before& before) {
    return static_cast<size_t>(std::stable_partition(events.begin(), events.end(), before) - events.begin());
  }
  static MixtureFit FitOne(std::span<const PlacedEvent> placed) {
    if (placed.empty()) return {};
    std::vector<GuideEvent> events(placed.begin(), placed.end());
    Vector3d sum(0.0);
    for (const GuideEvent& event : events) sum += Vector3d(event.position);
    return FitMixture(events, Point3(sum / static_cast<double>(events.size())));
  }

  PathGuide& guide_;
  std::vector<Part> parts_;  // of the regions
};

PathGuide::PathGuide(std::vector<PlacedEvent>& ofCamera, std::vector<PlacedEvent>& ofLight, int threads) {
  for (std::vector<PlacedEvent>* events : {&ofCamera, &ofLight})
    std::stable_sort(events->begin(), events->end(),
                     [](const PlacedEvent& a, const PlacedEvent& b) { return a.side < b.side; });
  const auto ofSide = [](std::vector<PlacedEvent>& events, uint8_t side) {
    const auto range = std::equal_range(events.begin(), events.end(), PlacedEvent{{}, side},
                                        [](const PlacedEvent& a, const PlacedEvent& b) { return a.side < b.side; });
    return std::span<PlacedEvent>(range.first, range.second);
  };
  Builder builder(*this);
  for (uint8_t side = 0; side < kGuideSides; ++side) {
    const Part part{ofSide(ofCamera, side), ofSide(ofLight, side)};
    if (part.Most() == 0) continue;
    roots_[side] = static_cast<uint32_t>(nodes_.size());
    nodes_.emplace_back();
    builder.Divide(roots_[side], part);
  }
  builder.Fit(threads);
}

void PathGuide::Save(ByteWriter& bytes) const {
  bytes.Value(roots_);
  bytes.List(std::span(nodes_));
  bytes.List(std::span(regions_));
}

void PathGuide::Load(ByteReader& bytes) {
  roots_ = bytes.Value<decltype(roots_)>();
  nodes_ = bytes.List<Node>(2 * kMostRegions + kGuideSides);
  regions_ = bytes.List<GuideRegion>(kMostRegions);
  const auto refuse = [] { throw Error("it holds a guide that cannot be"); };
  for (const uint32_t root : roots_)
    if (root != kNone && root >= nodes_.size()) refuse();
  for (size_t i = 0; i < nodes_.size(); ++i) {
    const Node& node = nodes_[i];
    // Children come after their parent, so that every descent ends.
    const bool isSound = node.axis == 3 ? node.next < regions_.size()
                         : node.axis < 3
                             ? node.next > i && size_t{node.next} + 1 < nodes_.size() && std::isfinite(node.split)
                             : false;
    if (!isSound) refuse();
  }
  for (const GuideRegion& region : regions_) {
    for (const MixtureFit* fit : {&region.radiance, &region.importance}) {
      if (!(fit->share >= 0 && fit->share <= kMostShare) || (fit->share > 0 && !fit->mixture.IsValid())) refuse();
    }
  }
}

}  // namespace lampyr
