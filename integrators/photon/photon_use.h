// Per-photon image contribution, recorded for emission guiding: how much the camera's paths got by each photon.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <utility>
#include <vector>

#include "integrators/walk/vertex.h"

namespace lampyr {

// Where a light path came from and first landed.
struct PathOrigin {
  uint32_t light = 0;
  Point3 start{0.0f}, landing{0.0f};
  float flux =
      0;  // as it was emitted, over the density of its emission; in LightingServices::FluxUnit, mean of the channels
  float pdfUnguided = 0;  // EmittedPhoton::pdfUnguided
  float gain = 1;         // how much more often it is sent than without a guide
};

// What is kept of the emission of a path that has landed at `first`. `lighting`: that emitted it.
inline PathOrigin OriginOf(const LightingServices& lighting, const EmittedPhoton& photon, const PathVertex& first) {
  PathOrigin origin;
  origin.light = photon.light;
  origin.start = photon.emission.position;
  origin.landing = first.point.position;
  // A light carries its radiance in both; a multiplier may have put out one of them.
  origin.flux = std::max(first.diffuse.Average(), first.specular.Average());
  origin.pdfUnguided = photon.pdfUnguided;
  origin.gain = lighting.EmissionGain(photon);
  return origin;
}

class PhotonUse {
 public:
  // `paths`: of each photon of the map, an index into `origins`.
  PhotonUse(std::vector<uint32_t> paths, std::vector<PathOrigin> origins)
      : paths_(std::move(paths)), origins_(std::move(origins)), sums_(origins_.size()) {}

  // `part`: of the photon's flux that came to the camera by it, per density of photons; not negative. From any thread:
  // sums are integers, the same whatever the order.
  void Add(uint32_t photon, float part) {
    constexpr float most = 0x1p16f;
    sums_[paths_[photon]].fetch_add(static_cast<uint64_t>(std::min(part, most) * kUnit), std::memory_order_relaxed);
  }
  const std::vector<PathOrigin>& Origins() const { return origins_; }
  // Of all photons of a path.
  double Sum(size_t path) const {
    return static_cast<double>(sums_[path].load(std::memory_order_relaxed)) / static_cast<double>(kUnit);
  }

  // Beside the photon itself, if it is the only one of its path.
  static constexpr uint64_t kMostBytesPerPhoton = sizeof(uint32_t) + sizeof(uint64_t) + sizeof(PathOrigin);

 private:
  static constexpr float kUnit = 0x1p24f;

  std::vector<uint32_t> paths_;
  std::vector<PathOrigin> origins_;
  std::vector<std::atomic<uint64_t>> sums_;
};

}  // namespace lampyr
