// The photons that a pass gathers, from the light paths of the pass before, the radius to gather them with, and counted
// lookups among them.
#pragma once

#include <chrono>
#include <cmath>
#include <memory>
#include <span>

#include "integrators/photon/photon_map.h"
#include "integrators/walk/integrator.h"

namespace lampyr {

// Radius of a pass relative to the first: r_i = r_1 · i^((α - 1) / 2) ([Knaus11 eq. 15]; `pass` counts from 0).
inline double RadiusScale(uint32_t pass, double alpha) {
  return std::pow(static_cast<double>(pass) + 1, 0.5 * (alpha - 1));
}

struct PhotonPass {
  std::shared_ptr<const PhotonMap> map;
  std::shared_ptr<PhotonUse> use;  // per-photon contributions; null: not recorded
  float radius = 0;                // scene units
  VolumeRadius volume;             // of photons in media
  float radiusScale = 1;           // RadiusScale of the pass, for radii derived from pixel footprints
  double lightPaths = 1;           // number of light paths that the photons come from
  uint32_t pass = 0;
};

// PhotonMap::Find, counted in `counts`. One lookup in 256 is timed, because reading the clock takes as long as a small
// lookup.
inline std::span<const uint32_t> FindPhotons(const PhotonMap& map, const Point3& position, float radius,
                                             PhotonLookup& lookup, RenderCounts& counts) {
  const bool isTimed = counts.lookups++ % 256 == 0;
  const auto start = isTimed ? std::chrono::steady_clock::now() : std::chrono::steady_clock::time_point();
  const std::span<const uint32_t> found = map.Find(position, radius, lookup);
  if (isTimed) {
    ++counts.timedLookups;
    counts.lookupSeconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }
  counts.foundPhotons += found.size();
  return found;
}

}  // namespace lampyr
