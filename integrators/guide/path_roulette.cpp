#include "integrators/guide/path_roulette.h"

#include <algorithm>
#include <cmath>

#include "base/byte_stream.h"
#include "base/error.h"
#include "sampling/rng.h"

namespace lampyr {

namespace {

constexpr size_t kMostOfRegion = 400;  // events of a region before it is divided
constexpr size_t kFewestOfRegion = 16;
// Events kept, and paths of which events are added at a time.
constexpr size_t kMostRouletteEvents = size_t{1} << 16;
// Factor on the probability. With 1 paths are longer than is best, because samples are better distributed than the
// independent ones that V is estimated by. 1 / (relMSE × rays) of `path` with 0.5, 0.7, 1, over that with 1, in a
// Cornell box: 0.77, 1.02, 1; scenes/gallery: 1.10, 1.06, 1; still-life: 1.05, 1.02, 1; ring: 1.01, 1, 1.
constexpr double kRouletteFactor = 0.7;
// Part of the paths whose contributions are limited to that of the next one below them: a few bright samples are not
// the noise of the whole picture.
constexpr double kOutliers = 1.0 / 200;
// Rays that a sample costs besides those of its path: what is done for the pixel.
constexpr double kRaysOfSample = 2;

// The part of the variance of direct light at first events, among the pixels of a block, that is taken for noise of a
// pixel; the rest are differences between pixels. 1 / (relMSE × rays) of `path` with 0, 0.3, 1, over that without this
// roulette (96×64, 32 samples, four seeds): scenes/rooms 0.94, 0.96, 0.98; gallery 1.09, 1.11, 1.03; lights-1000 0.97,
// 1.03, 1.07; still-life 1.88, 1.93, 1.94; a Cornell box 1.38, 1.37, 1.36.
constexpr double kDirectNoise = 0.4;
// Direct light at most, in brightnesses of the block.
constexpr double kMostDirect = 4;

// Sums over the samples of a block.
struct BlockVariance {
  double count = 0, sum = 0, squares = 0;

  void Add(double value) {
    ++count;
    sum += value;
    squares += value * value;
  }
  // The sum of the variances of the block's samples; 0 if there are fewer than two.
  double Total() const { return count < 2 ? 0.0 : std::max(squares - sum * sum / count, 0.0) * count / (count - 1); }
};

// √(C_I / V): of what paths find beyond their first event, and of a part of the direct light there.
double PerNoiseOf(const PathRecords& paths, const BlockLayout& layout, const std::vector<double>& scales) {
  std::vector<double> found, direct;
  double rays = 0;
  for (size_t i = 0; i < paths.Paths().size(); ++i) {
    const RecordedPath& path = paths.Paths()[i];
    const auto events = paths.EventsOf(i);
    const float beyond = events.empty() ? 0.0f : path.found - events.front().foundBefore;
    const float before = events.empty() ? 0.0f : events.front().foundBefore - events.front().foundOnArrival;
    const double scale = scales[layout.Of(path.pixel)];
    found.push_back(scale * static_cast<double>(beyond));
    direct.push_back(std::min(scale * static_cast<double>(before), kMostDirect));
    rays += static_cast<double>(path.rays) + kRaysOfSample;
  }
  if (found.empty()) return 0;
  std::vector<double> sorted = found;
  const auto last = sorted.end() - 1 - static_cast<std::ptrdiff_t>(kOutliers * static_cast<double>(sorted.size()));
  std::nth_element(sorted.begin(), last, sorted.end());
  const double most = *last;
  std::vector<BlockVariance> ofFound(scales.size()), ofDirect(scales.size());
  for (size_t i = 0; i < found.size(); ++i) {
    const size_t block = layout.Of(paths.Paths()[i].pixel);
    ofFound[block].Add(std::min(found[i], most));
    ofDirect[block].Add(direct[i]);
  }
  double variance = 0, varianceOfDirect = 0;
  for (const BlockVariance& block : ofFound) variance += block.Total();
  for (const BlockVariance& block : ofDirect) varianceOfDirect += block.Total();
  return variance > 0 ? std::sqrt(rays / (variance + kDirectNoise * varianceOfDirect)) : 0.0;
}

bool IsFiniteFactor(double value) {
  return value >= 0 && std::isfinite(value);
}

}  // namespace

void PathRoulette::Save(ByteWriter& bytes) const {
  bytes.List(std::span(ofBlock_));
  regions_.Save(bytes);
  bytes.List(std::span(ofRegion_));
}

std::shared_ptr<const PathRoulette> PathRoulette::Load(const BlockLayout& layout, ByteReader& bytes) {
  std::shared_ptr<PathRoulette> loaded(new PathRoulette(layout));
  loaded->ofBlock_ = bytes.List<double>(layout.Count());
  bool isSound = loaded->ofBlock_.size() == layout.Count() && loaded->regions_.Load(bytes);
  if (isSound) {
    loaded->ofRegion_ = bytes.List<double>(RegionTree::kMostRegions);
    isSound = loaded->regions_.IsOf(loaded->ofRegion_.size()) &&
              std::all_of(loaded->ofBlock_.begin(), loaded->ofBlock_.end(), IsFiniteFactor) &&
              std::all_of(loaded->ofRegion_.begin(), loaded->ofRegion_.end(), IsFiniteFactor);
  }
  if (!isSound) throw Error("it holds a roulette that cannot be");
  return loaded;
}

void RouletteLearning::Add(const PathRecords& paths) {
  std::vector<Event> latest;
  for (size_t i = 0; i < paths.Paths().size(); ++i) {
    const RecordedPath& path = paths.Paths()[i];
    for (const RecordedEvent& event : paths.EventsOf(i)) {
      // Radiance found beyond the event per unit of throughput, without the factor 1 / survival.
      const float found = (path.found - event.foundBefore) * event.survival / event.throughput;
      if (!std::isfinite(found) || found < 0) continue;
      latest.push_back({event.position, found, static_cast<float>(path.rays - std::min(path.rays, event.raysBefore)),
                        1 / event.survival, event.side});
    }
  }
  // Not each n-th: the events of a path follow each other.
  const auto thin = [](std::vector<Event>& events, size_t most) {
    const uint64_t every = (events.size() + most - 1) / most;
    if (every < 2) return;
    size_t i = 0;
    std::erase_if(events, [&](const Event&) { return MixBits(i++) % every != 0; });
  };
  thin(latest, kMostRouletteEvents / 2);
  events_.insert(events_.end(), latest.begin(), latest.end());
  thin(events_, kMostRouletteEvents);
}

void RouletteLearning::Learn(const PathRecords& paths, const std::vector<double>& scales) {
  Add(paths);
  const double perNoise = PerNoiseOf(paths, layout_, scales);
  if (!(perNoise > 0) || !std::isfinite(perNoise)) return;
  std::shared_ptr<PathRoulette> made(new PathRoulette(layout_));
  for (const double scale : scales) made->ofBlock_.push_back(kRouletteFactor * perNoise * scale);
  std::vector<RegionPoint> points;
  points.reserve(events_.size());
  for (size_t i = 0; i < events_.size(); ++i)
    points.push_back({events_[i].position, static_cast<uint32_t>(i), static_cast<uint8_t>(events_[i].side), false});
  const auto valueOf = [](const auto& events) {
    double squares = 0, rays = 0;
    for (const Event& event : events) {
      const auto found = static_cast<double>(event.found), weight = static_cast<double>(event.weight);
      squares += weight * found * found;
      rays += weight * static_cast<double>(event.rays);
    }
    return rays > 0 ? std::sqrt(squares / rays) : 0.0;
  };
  const double ofAll = valueOf(events_);
  made->regions_ = RegionTree(points, kMostOfRegion, [&](std::span<const RegionPoint> part) {
    std::vector<Event> events;
    for (const RegionPoint& point : part) events.push_back(events_[point.index]);
    // A region with few events is taken for one like all.
    made->ofRegion_.push_back(events.size() < kFewestOfRegion ? ofAll : valueOf(events));
  });
  const bool isFinite = std::all_of(made->ofBlock_.begin(), made->ofBlock_.end(), IsFiniteFactor) &&
                        std::all_of(made->ofRegion_.begin(), made->ofRegion_.end(), IsFiniteFactor);
  if (isFinite) roulette_ = made;
}

void RouletteLearning::Save(ByteWriter& bytes) const {
  bytes.Value<uint8_t>(roulette_ ? 1 : 0);
  if (roulette_) roulette_->Save(bytes);
  bytes.List(std::span(events_));
}

void RouletteLearning::Load(ByteReader& bytes) {
  if (bytes.Flag()) roulette_ = PathRoulette::Load(layout_, bytes);
  events_ = bytes.List<Event>(kMostRouletteEvents);
  for (const Event& event : events_) {
    if (!(IsFinite(event.position) && std::isfinite(event.found) && event.found >= 0 && std::isfinite(event.rays) &&
          event.rays >= 0 && std::isfinite(event.weight) && event.weight >= 1 && event.side < kGuideSides))
      throw Error("it holds a roulette that cannot be");
  }
}

}  // namespace lampyr
