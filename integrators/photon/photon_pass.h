// The photons that a pass gathers, from the light paths of the pass before, the radius to gather them with, and counted
// lookups among them.
#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <span>

#include "integrators/photon/photon_map.h"
#include "integrators/walk/integrator.h"

namespace lampyr {

// Area of merging in a pass that starts wide, relative to that of one that does not: 4 at first, 2.5 after 100 passes,
// and 1 from pass 960 on, so that long renders are no more blurred than others.
inline double Widening(uint32_t pass) {
  return std::max(4 / std::sqrt(1 + static_cast<double>(pass) / 64), 1.0);
}

// Radius of a pass relative to the first: r_i = r_1 · i^((α - 1) / 2) ([Knaus11 eq. 15]; `pass` counts from 0). If it
// starts wide, relative to the first of one that does not.
inline double RadiusScale(uint32_t pass, double alpha, bool startsWide = false) {
  return std::pow(static_cast<double>(pass) + 1, 0.5 * (alpha - 1)) * (startsWide ? std::sqrt(Widening(pass)) : 1.0);
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

// find(), counted in `counts`. One lookup in 256 is timed, because reading the clock takes as long as a small lookup.
template <class Find>
auto CountedLookup(RenderCounts& counts, const Find& find) {
  const bool isTimed = counts.lookups++ % 256 == 0;
  const auto start = isTimed ? std::chrono::steady_clock::now() : std::chrono::steady_clock::time_point();
  const auto found = find();
  if (isTimed) {
    ++counts.timedLookups;
    counts.lookupSeconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }
  counts.foundPhotons += found.size();
  return found;
}

// PhotonMap::Find, counted.
inline std::span<const uint32_t> FindPhotons(const PhotonMap& map, const Point3& position, float radius,
                                             PhotonLookup& lookup, RenderCounts& counts) {
  return CountedLookup(counts, [&] { return map.Find(position, radius, lookup); });
}
// PhotonMap::FindAlong, counted.
inline std::span<const BeamHit> FindPhotonsAlong(const PhotonMap& map, const Ray& ray, float tMax, PhotonLookup& lookup,
                                                 RenderCounts& counts) {
  return CountedLookup(counts, [&] { return map.FindAlong(ray, tMax, lookup); });
}

}  // namespace lampyr
