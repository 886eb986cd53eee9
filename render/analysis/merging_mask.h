// The mask of merging: where in the picture a candidate merges.
#pragma once

#include <optional>

#include "render/analysis/pilot_records.h"

namespace lampyr::pilot {

// Where to merge. Σ error · Σ cost is least where in each tile that choice is made which has the least e/E + c/C, with
// E and C the sums of all choices.
//
// Where only merging finds some of the light, it merges always, and now and then everywhere else, so that the mean is
// right wherever the pilot has seen nothing of that light.
//
// `none`, `all`: the same light paths without merging and with it everywhere. Null: everywhere or nowhere is better.
std::optional<PilotCandidate> MergingInParts(const PilotCandidate& none, const PilotCandidate& all,
                                             const CandidateCost& cost, const Grid& grid, double least);

}  // namespace lampyr::pilot
