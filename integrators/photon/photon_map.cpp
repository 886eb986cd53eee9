// The only file that includes FLANN.
#include "integrators/photon/photon_map.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <flann/flann.hpp>
#include <limits>
#include <mutex>
#include <new>
#include <numeric>
#include <optional>

#include "base/parallel.h"

namespace lampyr {

namespace {

using Index = flann::KDTreeSingleIndex<flann::L2_3D<float>>;

constexpr int kLeaf = 64;  // photons per leaf; with 32, lookups of 50 photons take 1.1 to 1.5 times as long

// Collects all points within the radius, and fetches their photons into the cache meanwhile.
class WithinRadius final : public flann::ResultSet<float> {
 public:
  WithinRadius(float radiusSquared, const Photon* photons, PhotonLookup& lookup)
      : radiusSquared_(radiusSquared), photons_(photons), found_(lookup.found), distances_(lookup.distances) {}
  bool full() const override { return true; }
  void addPoint(float distanceSquared, size_t index) override {
    __builtin_prefetch(photons_ + index);
    found_.push_back(static_cast<uint32_t>(index));
    distances_.push_back(distanceSquared);
  }
  float worstDist() const override { return radiusSquared_; }

 private:
  float radiusSquared_;
  const Photon* photons_;
  std::vector<uint32_t>& found_;
  std::vector<float>& distances_;
};

}  // namespace

// FLANN's tree, built by the first search. The positions must stay in their place.
class PhotonMap::Search {
 public:
  explicit Search(std::span<const Point3> positions) : positions_(positions) {}
  void Run(const Point3& relative, flann::ResultSet<float>& result) {
    std::call_once(isBuilt_, [this] { Build(); });
    const float query[3] = {relative.x, relative.y, relative.z};
    index_->findNeighbors(result, query, flann::SearchParams(flann::FLANN_CHECKS_UNLIMITED));
  }

 private:
  void Build() {
    static_assert(sizeof(Point3) == 3 * sizeof(float));
    auto* const data = const_cast<float*>(&positions_[0].x);  // FLANN copies them
    index_.emplace(flann::Matrix<float>(data, positions_.size(), 3), flann::KDTreeSingleIndexParams(kLeaf, true));
    index_->buildIndex();
  }

  std::span<const Point3> positions_;
  std::once_flag isBuilt_;
  std::optional<Index> index_;
};

PhotonMap::PhotonMap() = default;
PhotonMap::~PhotonMap() = default;
PhotonMap::PhotonMap(PhotonMap&&) noexcept = default;
PhotonMap& PhotonMap::operator=(PhotonMap&&) noexcept = default;

// Photons as they were traced, the unusable ones left out, with their bounds and origins.
struct PhotonMap::Traced {
  std::vector<const TracedPhoton*> photons;
  std::vector<uint32_t> origins;            // empty unless wanted
  std::vector<const VolumePhoton*> volume;  // by photon; null on a surface. Empty if all are
  std::vector<LabelRange> labels;           // by photon; empty without layers
  std::vector<uint32_t> paths;  // TracedPhoton::path, in the concatenated densities; empty if they were not kept
  BeamList beams;
  bool hasSpecular = false;  // flux for specular lobes differs from that for diffuse ones
  Point3 least{std::numeric_limits<float>::infinity()}, most{-std::numeric_limits<float>::infinity()};
};

PhotonMap::Traced PhotonMap::Collect(std::span<const PhotonList> lists, bool wantsOrigins) {
  Traced traced;
  uint32_t firstOrigin = 0;
  size_t count = 0, densities = 0, volume = 0;
  for (const PhotonList& list : lists) {
    count += list.Photons().size();
    volume += list.Volume().size();
    densities += list.Densities().size();
  }
  densities_ = LargeArray<SubpathDensities>::ForOverwrite(densities);
  size_t firstDensity = 0;
  traced.photons.reserve(count);
  for (const PhotonList& list : lists) {
    const auto firstLabel = static_cast<uint32_t>(labels_.size());
    labels_.insert(labels_.end(), list.Labels().begin(), list.Labels().end());
    for (const TracedPhoton& photon : list.Photons()) {
      // A single coordinate that is not a number would corrupt the whole tree.
      if (!IsFinite(photon.position) || !photon.diffuse.IsValid() || !photon.specular.IsValid()) {
        ++rejected_;
        continue;
      }
      traced.least = glm::min(traced.least, photon.position);
      traced.most = glm::max(traced.most, photon.position);
      traced.photons.push_back(&photon);
      if (volume > 0) {
        const bool isInMedium = photon.volume != TracedPhoton::kOnSurface;
        traced.volume.push_back(isInMedium ? &list.Volume()[photon.volume] : nullptr);
      }
      traced.hasSpecular |= photon.specular != photon.diffuse;
      if (!list.LabelRanges().empty()) {
        const LabelRange& of = list.LabelRanges()[static_cast<size_t>(&photon - list.Photons().data())];
        traced.labels.push_back({of.first + firstLabel, of.end + firstLabel});
      }
      if (wantsOrigins) traced.origins.push_back(firstOrigin + photon.origin);
      if (densities > 0) traced.paths.push_back(static_cast<uint32_t>(firstDensity) + photon.path);
    }
    traced.beams.Append(list.Beams(), firstOrigin, static_cast<uint32_t>(firstDensity));
    if (!list.Densities().empty()) {
      std::copy(list.Densities().begin(), list.Densities().end(), &densities_[firstDensity]);
      firstDensity += list.Densities().size();
    }
    firstOrigin += static_cast<uint32_t>(list.Origins().size());
  }
  return traced;
}

namespace {

// body(i) for all i below `count`, on all threads.
template <class Body>
void ForAll(size_t count, int threads, const Body& body) {
  constexpr size_t kChunk = 16384;
  ParallelFor(static_cast<int>((count + kChunk - 1) / kChunk), threads, [&](int chunk) {
    const size_t begin = static_cast<size_t>(chunk) * kChunk;
    for (size_t i = begin; i < std::min(begin + kChunk, count); ++i) body(i);
  });
}

// The photons along a Morton curve: neighbours in space are neighbours in memory. Photons of the same cell stay in
// their order.
std::vector<SortItem> MortonOrder(const std::vector<const TracedPhoton*>& photons, const Point3& center,
                                  const MortonFrame& frame, int threads) {
  constexpr uint32_t kBits = 10, kBuckets = 1 << kBits, kDigits = 3;  // of the sort
  static_assert(kBits * kDigits == 3 * MortonFrame::kBits);
  std::vector<SortItem> order(photons.size()), sorted(photons.size());
  ForAll(photons.size(), threads, [&](size_t i) {
    order[i] = {frame.CodeOf(photons[i]->position - center), static_cast<uint32_t>(i)};
  });
  const auto digit = [](const SortItem& item, uint32_t d) { return item.cell >> d * kBits & (kBuckets - 1); };
  std::array<std::array<uint32_t, kBuckets>, kDigits> starts{};
  for (const SortItem& item : order) {
    for (uint32_t d = 0; d < kDigits; ++d) ++starts[d][digit(item, d)];
  }
  for (auto& ofDigit : starts) std::exclusive_scan(ofDigit.begin(), ofDigit.end(), ofDigit.begin(), 0u);
  for (uint32_t d = 0; d < kDigits; ++d) {
    for (const SortItem& item : order) sorted[starts[d][digit(item, d)]++] = item;
    order.swap(sorted);
  }
  return order;
}

}  // namespace

PhotonMap::PhotonMap(std::span<const PhotonList> lists, int threads, std::vector<uint32_t>* origins,
                     const VolumeRadius& radius) {
  const auto start = std::chrono::steady_clock::now();
  Traced traced = Collect(lists, origins != nullptr);
  const size_t count = traced.photons.size();
  if (!traced.beams.IsEmpty()) beams_ = BeamMap(std::move(traced.beams), radius);
  if (count > 0) Build(traced, threads, origins, radius);
  if (origins) {
    for (const FlightStart& start : beams_.Starts()) origins->push_back(start.origin);
  }
  buildSeconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void PhotonMap::Build(const Traced& traced, int threads, std::vector<uint32_t>* origins, const VolumeRadius& radius) {
  const size_t count = traced.photons.size();
  const Vector3 extent = traced.most - traced.least;
  center_ = traced.least + 0.5f * extent;
  const MortonFrame frame(traced.least - center_, std::max({extent.x, extent.y, extent.z}));
  std::vector<SortItem> order = MortonOrder(traced.photons, center_, frame, threads);
  firstVolume_ = static_cast<uint32_t>(count);
  if (!traced.volume.empty()) {
    const auto first = std::stable_partition(order.begin(), order.end(),
                                             [&](const SortItem& i) { return traced.volume[i.item] == nullptr; });
    firstVolume_ = static_cast<uint32_t>(first - order.begin());
    for (auto i = first; i != order.end(); ++i) {
      volume_.push_back(*traced.volume[i->item]);
      volume_.back().radius = radius.OfGathered(volume_.back().position, volume_.back().extinction);
    }
    beamSearch_ = BeamSearch(volume_);
  }
  if (origins) {
    origins->resize(count);
    ForAll(count, threads, [&](size_t i) { (*origins)[i] = traced.origins[order[i].item]; });
  }
  photons_ = LargeArray<Photon>::ForOverwrite(count);
  std::vector<Point3> positions(firstVolume_);
  ForAll(count, threads, [&](size_t i) {
    // In the order of places the photons are read at random.
    constexpr size_t kAhead = 16;
    if (i + kAhead < count) {
      const TracedPhoton* next = traced.photons[order[i + kAhead].item];
      __builtin_prefetch(next);
      __builtin_prefetch(&next->path);
    }
    const TracedPhoton& source = *traced.photons[order[i].item];
    if (i < firstVolume_) positions[i] = source.position - center_;
    Photon& photon = *new (&photons_[i]) Photon();
    photon.toPrevious = source.toPrevious;
    photon.flux = source.diffuse;
    if (!traced.paths.empty()) photon.path = traced.paths[order[i].item];
    photon.previousSolidAnglePerArea = source.previousSolidAnglePerArea;
    photon.normal = source.normal;
    photon.weight = source.weight;
    photon.depth = source.depth;
  });
  ranges_.resize(traced.labels.size());
  for (size_t i = 0; i < ranges_.size(); ++i) ranges_[i] = traced.labels[order[i].item];
  for (size_t i = 0; traced.hasSpecular && i < count; ++i) {
    const TracedPhoton& source = *traced.photons[order[i].item];
    if (source.specular == source.diffuse) continue;
    photons_[i].specular = static_cast<uint32_t>(specular_.size());
    specular_.push_back(source.specular);
  }
  if (firstVolume_ == 0) return;
  grid_ = PhotonGrid(frame, std::span(order).first(firstVolume_), std::move(positions));
  search_ = std::make_unique<Search>(grid_.Positions());
}

std::span<const uint32_t> PhotonMap::Find(const Point3& position, float radius, PhotonLookup& lookup) const {
  if (!search_) return {};
  const Point3 relative = position - center_;
  if (grid_.Find(relative, radius, lookup.found, lookup.distances)) {
    for (const uint32_t index : lookup.found) Prefetch(&photons_[index]);
    return lookup.found;
  }
  lookup.found.clear();
  lookup.distances.clear();
  WithinRadius result(radius * radius, &photons_[0], lookup);
  search_->Run(relative, result);
  return lookup.found;
}

std::span<const BeamHit> PhotonMap::FindAlong(const Ray& ray, float tMax, PhotonLookup& lookup) const {
  lookup.beamHits.clear();
  beamSearch_.Find(volume_, ray, tMax, firstVolume_, lookup.boxes, lookup.beamHits);
  return lookup.beamHits;
}

std::span<const BeamCrossing> PhotonMap::FindBeams(const Ray& ray, const FineLine& line, float tMax,
                                                   PhotonLookup& lookup) const {
  lookup.crossings.clear();
  beams_.Find(ray, line, tMax, lookup.boxes, lookup.crossings);
  return lookup.crossings;
}

// Memory of the tree, which any lookup may need: a copy of the positions in the tree's order; one row pointer and one
// index per photon; and two nodes for each leaf, which is at least half full on average.
size_t PhotonMap::Bytes() const {
  constexpr size_t node = 48;
  const size_t perPhoton = sizeof(Photon) + 3 * sizeof(float) + sizeof(float*) + sizeof(int);
  return photons_.Size() * perPhoton + photons_.Size() / (kLeaf / 2) * 2 * node + specular_.size() * sizeof(Color) +
         grid_.Bytes() + densities_.Size() * sizeof(SubpathDensities) + volume_.size() * sizeof(VolumePhoton) +
         beamSearch_.Bytes() + beams_.Bytes() + ranges_.size() * sizeof(LabelRange) +
         labels_.size() * sizeof(PathLabel);
}

}  // namespace lampyr
