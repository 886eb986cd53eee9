// Faults of weights and integrators: the proofs of this tree, and the baselines, on the integrators as they were built.
#pragma once

#include "detection/baselines.h"

namespace lampyr::test {

// Mean of the furnace, by integrators without a fault.
double TrueMeanOfLamp();

// First the weights of single paths, until one is wrong; then, block by block, whether the integrators agree with each
// other. Samples are paths.
Finding FindByProofs();
Finding FindWeightsByFurnace(double truth, double seconds);
// Path tracing against bdpt in three scenes and vcm in one, each with a part of the time. Not sppm: the test finds its
// blur, which is no fault.
Finding FindWeightsByTiles(double seconds);

}  // namespace lampyr::test
