#include "render/analysis/pilot_candidates.h"

namespace lampyr::pilot {

namespace {

// Unit costs in nanoseconds: of rays fitted to the times of path, bdpt, vcm and sppm in 21 scenes, of merging to those
// of vcm over bdpt in 24 (scripts/fit_costs.py). The ratio of vcm's cost to bdpt's is off by 11 % typically, and by a
// third at most; that of bdpt's to path's by 15 %, and in fog, where path is slower than its rays tell, by half.
struct Costs {
  double ray = 260, shadowRay = 350, connection = 530, lookup = 122, found = 460, stored = 167;
  double gathered = 100;  // found by sppm
};

// Measured with 1/8 to 2 light paths for each camera path, in six scenes: the weights of bidirectional techniques make
// a camera path so many times as costly, and the rest of a light path and its connections costs so much of what rays
// cost on their own. Further light paths of a sample, measured with 4 in three scenes, have no camera path beside them.
constexpr double kCameraPathWithWeights = 1.12, kSideBySide = 0.75, kAlone = 1.1;

// Costs of the parts of all samples of the pilot, nanoseconds.
struct PartCosts {
  double path = 0, light = 0, connections = 0;
  double lightRays = 0;  // of `light`, without connections to the lens
};

PartCosts PartCostsOf(const Counted& counted, bool isEnding) {
  constexpr Costs costs;
  double pathRays = RaysOf(counted.path), direct = counted.path.DirectRays();
  const double lightRays = std::max(RaysOf(counted.bdpt) - pathRays, 0.0);
  double more = std::max(static_cast<double>(counted.bdpt.shadowRays) - direct, 0.0);
  // Time in media for each ray of a kind.
  const auto perOne = [](double time, double count) { return count > 0 ? std::max(time, 0.0) / count : 0.0; };
  const MediumTimes &ofPath = counted.path.media, &ofBdpt = counted.bdpt.media;
  const double pathMedia = perOne(ofPath.walks, pathRays), directMedia = perOne(ofPath.connections, direct),
               lightMedia = perOne(ofBdpt.walks - ofPath.walks, lightRays),
               moreMedia = perOne(ofBdpt.connections - ofPath.connections, more);
  // Nearly each ray of a light path ends at a vertex that is connected to the lens.
  const double splats = std::min(more, lightRays);
  more -= splats;
  if (isEnding) {
    // Shorter camera paths have fewer rays, fewer next events and fewer connections.
    const double fewerRays = std::clamp(RaysOf(counted.bdpt) - RaysOf(counted.endingBdpt), 0.0, pathRays);
    const double fewer = std::max(
        static_cast<double>(counted.bdpt.shadowRays) - static_cast<double>(counted.endingBdpt.shadowRays), 0.0);
    const double fewerDirect = std::min(fewer, direct * fewerRays / std::max(pathRays, 1.0));
    pathRays -= fewerRays;
    direct -= fewerDirect;
    more = std::max(more - (fewer - fewerDirect), 0.0);
  }
  const double ofLightRays = (costs.ray + lightMedia) * lightRays, connection = costs.connection + moreMedia;
  return {(costs.ray + pathMedia) * pathRays + (costs.shadowRay + directMedia) * direct,
          ofLightRays + connection * splats, connection * more, ofLightRays};
}

}  // namespace

double RaysOf(const RenderCounts& counts) {
  return static_cast<double>(counts.cameraRays + counts.indirectRays);
}

double CostOfSppm(const PassCounts& counts, uint64_t stored, double samples) {
  constexpr Costs costs;
  return (costs.ray * RaysOf(counts) + costs.shadowRay * static_cast<double>(counts.shadowRays) +
          counts.media.segments + costs.stored * static_cast<double>(stored) +
          costs.lookup * static_cast<double>(counts.lookups) +
          costs.gathered * static_cast<double>(counts.foundPhotons) + counts.media.walks + counts.media.connections) /
         samples;
}

std::array<CandidateCost, kCandidates> CostsOf(const Counted& counted, double samples) {
  constexpr Costs costs;
  const PartCosts ofWhole = PartCostsOf(counted, false), ofEnding = PartCostsOf(counted, true);
  // Only path samples lights along segments.
  const double segments = counted.path.media.segments + costs.shadowRay * counted.path.media.segmentRays;
  std::array<CandidateCost, kCandidates> all{};
  for (size_t k = 0; k < kCandidates; ++k) {
    const Candidate& candidate = kCandidateOf[k];
    const bool isEnding = candidate.continuing < 1;
    const PartCosts& parts = isEnding ? ofEnding : ofWhole;
    const double n = candidate.lightPaths;
    all[k].paths = (n > 0 ? kCameraPathWithWeights * parts.path : parts.path + segments) / samples;
    all[k].paths += kSideBySide * std::min(n, 1.0) * (parts.light + parts.connections) / samples;
    all[k].paths += kAlone * std::max(n - 1, 0.0) * parts.light / samples;
    if (!Merges(k)) continue;
    const RenderCounts& lookups = isEnding ? counted.endingVcm : counted.vcm;
    if (counted.tracesAnew) all[k].paths += kAlone * n * parts.lightRays / samples;
    all[k].paths += costs.stored * n * static_cast<double>(counted.stored) / samples;
    all[k].merging = (costs.lookup * static_cast<double>(lookups.lookups) +
                      costs.found * candidate.merging * static_cast<double>(lookups.foundPhotons)) /
                     samples;
  }
  return all;
}

}  // namespace lampyr::pilot
