// The integrators among which the pilot chooses, and what a sample of each costs.
//
// Cost is counted, not timed, so that the choice does not depend on how fast or busy a machine is.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "integrators/bidirectional/path_densities.h"
#include "integrators/walk/render_scene.h"

namespace lampyr::pilot {

struct Candidate {
  const char* integrator;
  int log2LightPaths;
  bool startsWide;
  // Samples of each TechniqueGroup per camera path, relative to those of the pilot.
  std::array<double, kTechniqueGroups> counts;
};
// Merges of a pass that starts wide, over those of one that does not: the mean over the first 64 passes.
inline constexpr double kWiderMerging = 3.4;
constexpr Candidate Bidirectional(bool merges, int log2LightPaths, bool startsWide = false) {
  const double n = log2LightPaths < 0 ? 1.0 / (1 << -log2LightPaths) : 1 << log2LightPaths;
  const double merging = merges ? (startsWide ? kWiderMerging * n : n) : 0.0;
  return {merges ? "vcm" : "bdpt", log2LightPaths, startsWide, {1, 1, n, std::min(n, 1.0), merging}};
}
inline constexpr size_t kCandidates = 16, kFirstOfVcm = 7, kBdpt = 4;  // kBdpt: with one light path
inline constexpr double kFewestLightPaths = 1.0 / 8;
inline constexpr std::array<Candidate, kCandidates> kCandidateOf = {{
    {"path", 0, false, {1, 1, 0, 0, 0}},
    Bidirectional(false, -3),
    Bidirectional(false, -2),
    Bidirectional(false, -1),
    Bidirectional(false, 0),
    Bidirectional(false, 1),
    Bidirectional(false, 2),
    Bidirectional(true, -3),
    Bidirectional(true, -2),
    Bidirectional(true, -1),
    Bidirectional(true, 0),
    Bidirectional(true, 1),
    Bidirectional(true, 2),
    Bidirectional(true, -1, true),
    Bidirectional(true, 0, true),
    Bidirectional(true, 1, true),
}};
// The candidate with the same techniques, with at most one light path and without more merging.
constexpr size_t WithFewestSamples(size_t k) {
  const int less = std::min(kCandidateOf[k].log2LightPaths, 0);
  return k == 0 ? k : (k < kFirstOfVcm ? kBdpt : kFirstOfVcm + 3) - static_cast<size_t>(-less);
}
// The candidate with the same light paths that does not merge.
constexpr size_t WithoutMerging(size_t k) {
  return kBdpt + static_cast<size_t>(kCandidateOf[k].log2LightPaths - kCandidateOf[kBdpt].log2LightPaths);
}
static_assert(kCandidateOf[WithoutMerging(kCandidates - 1)].log2LightPaths ==
              kCandidateOf[kCandidates - 1].log2LightPaths);

struct Counted {
  RenderCounts path, bdpt, vcm;
  uint64_t stored = 0;  // photons of a pass of vcm
};

// The costs of a sample of a candidate, in two parts.
struct CandidateCost {
  double paths = 0, merging = 0;  // merging in all of the picture; what storing photons costs is in `paths`
};
// `samples`: of which `counted` tells.
std::array<CandidateCost, kCandidates> CostsOf(const Counted& counted, double samples);

}  // namespace lampyr::pilot
