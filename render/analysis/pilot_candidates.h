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
  // Samples of each TechniqueGroup per camera path, relative to those of the pilot.
  std::array<double, kTechniqueGroups> counts;
};
constexpr Candidate Bidirectional(bool merges, int log2LightPaths) {
  const double n = log2LightPaths < 0 ? 1.0 / (1 << -log2LightPaths) : 1 << log2LightPaths;
  return {merges ? "vcm" : "bdpt", log2LightPaths, {1, 1, n, std::min(n, 1.0), merges ? n : 0.0}};
}
inline constexpr size_t kCandidates = 13, kBdpt = 4, kFirstOfVcm = 7;  // kBdpt: with one light path
inline constexpr double kFewestLightPaths = 1.0 / 8;
inline constexpr std::array<Candidate, kCandidates> kCandidateOf = {{
    {"path", 0, {1, 1, 0, 0, 0}},
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
}};

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
