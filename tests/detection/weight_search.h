// Faults of weights and integrators: the proofs of this tree, and the baselines, on the integrators as they were built.
#pragma once

#include "detection/baselines.h"

namespace lampyr::test {

// From integrators without a fault.
struct WeightHelp {
  double seconds = 0;  // that the proofs take
  double truth = 0;    // mean of the furnace
};
WeightHelp PrepareWeights();

// First the weights of single paths, until one is wrong; then, block by block, whether the integrators agree with each
// other. Samples are paths.
Finding FindByProofs();
Finding FindWeightsByFurnace(const WeightHelp& help);
// Path tracing against bdpt, vcm and sppm in turn.
Finding FindWeightsByTiles(const WeightHelp& help);

}  // namespace lampyr::test
