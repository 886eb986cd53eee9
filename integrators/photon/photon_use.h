// Per-photon image contribution, recorded for emission guiding.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "base/large_pages.h"
#include "integrators/walk/vertex.h"

namespace lampyr {

// Emission and first hit of a light path.
struct PathOrigin {
  uint32_t light = 0;
  Point3 start{0.0f}, firstHit{0.0f};
  // Emitted flux over the density of its emission, mean of the channels; in LightingServices::FluxUnit.
  float flux = 0;
  float pdfUnguided = 0;  // EmittedPhoton::pdfUnguided
  float gain = 1;         // density of its emission, over that without a guide
};

// The origin of a light path whose first hit is `first`. `lighting`: the view that emitted it.
inline PathOrigin OriginOf(const LightingServices& lighting, const EmittedPhoton& photon, const PathVertex& first) {
  PathOrigin origin;
  origin.light = photon.light;
  origin.start = photon.emission.position;
  origin.firstHit = first.point.position;
  // Both parts hold the light's radiance; a multiplier may have set one of them to 0.
  origin.flux = std::max(first.diffuse.Average(), first.specular.Average());
  origin.pdfUnguided = photon.pdfUnguided;
  origin.gain = lighting.EmissionGain(photon);
  return origin;
}

class PhotonUse {
 public:
  // `paths`: for each photon of the map, and then for each flight, the index of its path in `origins`. Of a flight it
  // may be 0xffffffff: not known, and its use is not recorded.
  PhotonUse(std::vector<uint32_t> paths, std::vector<PathOrigin> origins)
      : paths_(std::move(paths)), origins_(std::move(origins)), sums_(origins_.size()) {}

  // `part`: fraction of the photon's flux that reached the camera, per density of photons; 0 or more.
  struct Contribution {
    uint32_t photon;
    float part;
  };
  // Adds the contributions of a lookup's photons, and overwrites them. May be called from any thread: sums are
  // integers, independent of the order. All at once, because an atomic addition waits for the reads before it, and
  // reads after it wait for the addition: between photons it would keep the processor from reading several of them at a
  // time.
  void Add(std::span<Contribution> contributions) {
    for (Contribution& contribution : contributions) {
      contribution.photon = paths_[contribution.photon];
      __builtin_prefetch(&sums_[contribution.photon]);
    }
    constexpr float most = 0x1p16f;
    for (const auto& [path, part] : contributions) {
      sums_[path].fetch_add(static_cast<uint64_t>(std::min(part, most) * kUnit), std::memory_order_relaxed);
    }
  }
  // Fetches into the cache what Add needs of the photons: first the indices of their paths, then their sums.
  void Fetch(std::span<const uint32_t> photons) const {
    for (const uint32_t photon : photons) Prefetch(&paths_[photon]);
  }
  void FetchSums(std::span<const uint32_t> photons) const {
    for (const uint32_t photon : photons) Prefetch(&sums_[paths_[photon]]);
  }
  const std::vector<PathOrigin>& Origins() const { return origins_; }
  // Sum over all photons of a path.
  double Sum(size_t path) const {
    return static_cast<double>(sums_[path].load(std::memory_order_relaxed)) / static_cast<double>(kUnit);
  }

  // Memory per photon besides the photon itself, if it is the only one of its path.
  static constexpr uint64_t kMostBytesPerPhoton = sizeof(uint32_t) + sizeof(uint64_t) + sizeof(PathOrigin);

 private:
  static constexpr float kUnit = 0x1p24f;

  std::vector<uint32_t> paths_;
  std::vector<PathOrigin> origins_;
  std::vector<std::atomic<uint64_t>> sums_;
};

}  // namespace lampyr
