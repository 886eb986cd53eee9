// Masks of a candidate: where in the picture it merges, and where its camera paths may end early.
#pragma once

#include <optional>
#include <span>

#include "render/analysis/pilot_records.h"

namespace lampyr::pilot {

// Candidates that differ in merging alone.
struct CameraPaths {
  const PilotCandidate* none = nullptr;  // merges nowhere
  const PilotCandidate* all = nullptr;   // everywhere; null: there is no merging
  CandidateCost cost;
};

// The product Σ error · Σ cost is minimised by the choice with the least e/E + c/C in each tile, where E and C are the
// sums over all tiles. A choice is merging or not, and one of the options, which differ in where camera paths end.
//
// Where only merging finds some of the light, it merges always or with the probability that minimises error × cost, and
// now and then everywhere else, so that the mean is right wherever the pilot has seen nothing of that light.
//
// `options`: the same light paths with camera paths that always continue, and with those that may end early, if there
// are any. Null: the first option without masks is better.
std::optional<PilotCandidate> InParts(std::span<const CameraPaths> options, const Grid& grid, double least);

}  // namespace lampyr::pilot
