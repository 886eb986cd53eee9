// Records of walks for path guiding: their scattering events, and the radiance found beyond each.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "base/large_pages.h"
#include "integrators/guide/path_guide.h"

namespace lampyr {

// A scattering event of a recorded walk. `weight` of the base: not set.
//
// Light follows the path in the other direction, so that the event is one of a light path, too: it leaves towards the
// previous vertex. Camera paths therefore teach both walks.
struct RecordedEvent : PlacedEvent {
  float guidance = 1;  // Guidance::forward
  // Throughput of the path that arrived (mean of the channels), and the probability with which it went on.
  float throughput = 0, survival = 1;
  uint32_t raysBefore = 0;  // of the path, up to this vertex
  // Radiance that the path had found when it arrived at the vertex, and when it left it: mean of the channels,
  // W/(m² sr).
  float foundOnArrival = 0, foundBefore = 0;
  Vector3 toPrevious{0.0f};
  float previousDistance = 0;  // scene units; 0: the previous vertex is the lens, where no walk from a light goes
  float unguidedReverse = 0;   // density of `toPrevious` by a walk from a light, without a guide; 0: a delta
};

struct RecordedPath {
  uint32_t pixel = 0;       // y · width + x
  uint32_t sample = 0;      // index in the pixel
  uint32_t firstEvent = 0;  // the events up to that of the next path are this path's
  float found = 0;          // by the whole walk
  uint32_t rays = 0;        // by the whole walk
};

// The records of one thread's share of a pass.
class PathRecords {
 public:
  // True for a share of all paths (SetFraction). `decider`: uniform bits that depend on the sample alone.
  bool Wants(uint64_t decider) const { return static_cast<double>(decider >> 11) * 0x1p-53 < fraction_; }
  void SetFraction(double fraction) { fraction_ = fraction; }

  void StartPath(uint32_t pixel, uint32_t sample) {
    paths_.push_back({pixel, sample, static_cast<uint32_t>(events_.size()), 0, 0});
  }
  // False if the path has kMostEvents events already; later ones are not recorded.
  bool HasRoom() const { return events_.size() - paths_.back().firstEvent < kMostEvents; }
  void Add(const RecordedEvent& event) { events_.push_back(event); }
  // Sets the distance of the last event to the next vertex.
  void SetDistance(float distance) {
    if (events_.size() > paths_.back().firstEvent) events_.back().distance = distance;
  }
  // Ends the path, which has found the radiance `found` with so many rays, and drops it if that is not finite.
  void EndPath(float found, size_t rays) {
    paths_.back().found = found;
    paths_.back().rays = static_cast<uint32_t>(rays);
    if (std::isfinite(found)) return;
    events_.resize(paths_.back().firstEvent);
    paths_.pop_back();
  }

  void Clear() {
    paths_.clear();
    events_.clear();
  }
  std::span<const RecordedPath> Paths() const { return paths_; }
  std::span<const RecordedEvent> Events() const { return events_; }
  std::span<const RecordedEvent> EventsOf(size_t path) const {
    const size_t end = path + 1 < paths_.size() ? paths_[path + 1].firstEvent : events_.size();
    return Events().subspan(paths_[path].firstEvent, end - paths_[path].firstEvent);
  }
  // Appends all paths of `other`.
  void Append(const PathRecords& other) {
    const auto shift = static_cast<uint32_t>(events_.size());
    const size_t before = paths_.size();
    paths_.insert(paths_.end(), other.paths_.begin(), other.paths_.end());
    for (size_t i = before; i < paths_.size(); ++i) paths_[i].firstEvent += shift;
    events_.insert(events_.end(), other.events_.begin(), other.events_.end());
  }
  // In the order of samples and pixels, whatever the order in which they were recorded.
  PathRecords Sorted() const {
    std::vector<size_t> order(paths_.size());
    std::iota(order.begin(), order.end(), size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) {
      return std::pair(paths_[a].sample, paths_[a].pixel) < std::pair(paths_[b].sample, paths_[b].pixel);
    });
    PathRecords sorted;
    sorted.paths_.reserve(paths_.size());
    sorted.events_.reserve(events_.size());
    for (const size_t i : order) sorted.Append(*this, i);
    return sorted;
  }
  // What a file holds. The caller has checked it.
  void Set(std::span<const RecordedPath> paths, std::span<const RecordedEvent> events) {
    paths_.assign(paths.begin(), paths.end());
    events_.assign(events.begin(), events.end());
  }

 private:
  static constexpr size_t kMostEvents = 16;  // of a path

  void Append(const PathRecords& other, size_t path) {
    const std::span<const RecordedEvent> events = other.EventsOf(path);
    paths_.push_back(other.paths_[path]);
    paths_.back().firstEvent = static_cast<uint32_t>(events_.size());
    events_.insert(events_.end(), events.begin(), events.end());
  }

  double fraction_ = 1;
  LargePageVector<RecordedPath> paths_;
  LargePageVector<RecordedEvent> events_;
};

}  // namespace lampyr
