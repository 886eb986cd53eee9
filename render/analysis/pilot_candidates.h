// The integrators among which the pilot chooses, and what a sample of each costs.
//
// Cost is counted, not timed, so that the choice does not depend on how fast or busy a machine is.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "integrators/bidirectional/path_densities.h"
#include "integrators/walk/integrator.h"

namespace lampyr::pilot {

struct Candidate {
  const char* integrator;
  int log2LightPaths;
  bool startsWide;
  double lightPaths, connections, merging;  // samples per camera path, relative to those of the pilot
  double continuing;                        // TechniqueCounts::continuing
};
// Merges of a pass that starts wide, over those of one that does not: the mean over the first 64 passes.
inline constexpr double kWiderMerging = 3.4;
// The fraction of camera paths that continue, of those that may end early. Measured with 1/4 and 1/16 in six scenes by
// bdpt and vcm: 1/4 has less error in equal time in most of them, because what only long camera paths find is noisy
// with 1/16.
inline constexpr double kContinuing = 0.25;
constexpr Candidate Bidirectional(bool merges, int log2LightPaths, bool startsWide = false, double continuing = 1) {
  const double n = log2LightPaths < 0 ? 1.0 / (1 << -log2LightPaths) : 1 << log2LightPaths;
  const double merging = merges ? (startsWide ? kWiderMerging * n : n) : 0.0;
  return {merges ? "vcm" : "bdpt", log2LightPaths, startsWide, n, std::min(n, 1.0), merging, continuing};
}
inline constexpr size_t kWholeCandidates = 16, kBdpt = 4;  // kBdpt: with one light path
inline constexpr size_t kCandidates = 27;
inline constexpr double kFewestLightPaths = 1.0 / 8;
// Those from kWholeCandidates on have camera paths that may end early. Of candidates with the same light paths and the
// same camera paths, that without merging comes first.
inline constexpr std::array<Candidate, kCandidates> kCandidateOf = {{
    {"path", 0, false, 0, 0, 0, 1},
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
    Bidirectional(false, -1, false, kContinuing),
    Bidirectional(false, 0, false, kContinuing),
    Bidirectional(false, 1, false, kContinuing),
    Bidirectional(false, 2, false, kContinuing),
    Bidirectional(true, -1, false, kContinuing),
    Bidirectional(true, 0, false, kContinuing),
    Bidirectional(true, 1, false, kContinuing),
    Bidirectional(true, 2, false, kContinuing),
    Bidirectional(true, -1, true, kContinuing),
    Bidirectional(true, 0, true, kContinuing),
    Bidirectional(true, 1, true, kContinuing),
}};
constexpr bool Merges(size_t k) {
  return kCandidateOf[k].merging > 0;
}
// kCandidates: none.
constexpr size_t Find(bool merges, int log2LightPaths, bool startsWide, double continuing) {
  for (size_t k = 1; k < kCandidates; ++k) {
    const Candidate& candidate = kCandidateOf[k];
    if (Merges(k) == merges && candidate.log2LightPaths == log2LightPaths && candidate.startsWide == startsWide &&
        candidate.continuing == continuing)
      return k;
  }
  return kCandidates;
}
// The candidate with the same techniques, with at most one light path and without more merging.
constexpr size_t WithFewestSamples(size_t k) {
  const Candidate& candidate = kCandidateOf[k];
  return k == 0 ? k : Find(Merges(k), std::min(candidate.log2LightPaths, 0), false, candidate.continuing);
}
// The candidate with the same light paths and the same camera paths that does not merge.
inline constexpr std::array<size_t, kCandidates> kWithoutMerging = [] {
  std::array<size_t, kCandidates> all{};
  for (size_t k = 1; k < kCandidates; ++k)
    all[k] = Find(false, kCandidateOf[k].log2LightPaths, false, kCandidateOf[k].continuing);
  return all;
}();
constexpr size_t WithoutMerging(size_t k) {
  return kWithoutMerging[k];
}
// The candidate that differs in camera paths that may end early; kCandidates: none.
constexpr size_t EndingOf(size_t k) {
  const Candidate& candidate = kCandidateOf[k];
  return k == 0 ? kCandidates : Find(Merges(k), candidate.log2LightPaths, candidate.startsWide, kContinuing);
}
static_assert(WithoutMerging(kWholeCandidates - 1) < kWholeCandidates && WithoutMerging(kCandidates - 1) < kCandidates);
static_assert(WithFewestSamples(kCandidates - 1) < kCandidates && EndingOf(kBdpt) == kWholeCandidates + 1);

// Counts of a pass: rays, lookups of photons, times of media.
struct PassCounts : RenderCounts {
  MediumTimes media;
  void operator+=(const PassCounts& other) {
    RenderCounts::operator+=(other);
    media += other.media;
  }
  // Shadow rays, without those of segments.
  double DirectRays() const { return static_cast<double>(shadowRays) - media.segmentRays; }
};

struct Counted {
  PassCounts path, bdpt, vcm;
  PassCounts endingBdpt, endingVcm;  // with kContinuing
  uint64_t stored = 0;               // photons of a pass of vcm
  // vcm traces the light paths of its photons anew, as in scenes with motion or with wavelengths
  // (render/both_paths.cpp).
  bool tracesAnew = false;
};

// The costs of a sample of a candidate, in two parts.
struct CandidateCost {
  double paths = 0, merging = 0;  // merging in all of the picture; what storing photons costs is in `paths`
};
// `samples`: of which `counted` tells.
std::array<CandidateCost, kCandidates> CostsOf(const Counted& counted, double samples);
// Rays by which paths go on: without shadow rays.
double RaysOf(const RenderCounts& counts);
// Cost of a sample of sppm. `counts`: light paths and camera paths of a pass; `stored`: photons of the pass.
double CostOfSppm(const PassCounts& counts, uint64_t stored, double samples);

}  // namespace lampyr::pilot
