// Photon lookups with counters and timing.
#pragma once

#include <chrono>
#include <span>

#include "integrators/photon/photon_map.h"
#include "integrators/walk/integrator.h"

namespace lampyr {

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
