// Bidirectional path tracing ([Veach97 §10], [Lafortune93]) and vertex connection and merging ([Georgiev12]): a path
// from the camera and a path from a light for every sample, each vertex of one connected to each of the other, and to
// photons of other light paths. A technique (s,t) has s vertices from the light and t from the camera; all are there, s
// = 0 (the light is hit by chance) and t = 1 (the light path is connected to the lens) included, and are weighted by
// the power heuristic over all of them (weights.h).
//
// Next-event estimation (s = 1) asks the lighting services for a light as path tracing does, so any selector may be
// used; its exact probabilities at the receiver are in all weights. Lights that do not trace light paths
// (traceLightPaths) are found by s = 0 and s = 1 alone.
//
// Cannot find without merging: light from delta lights that is seen through two events that cannot be connected, a
// caustic in a mirror.
#pragma once

#include <memory>

#include "integrators/walk/integrator.h"
#include "integrators/walk/shadow_roulette.h"

namespace lampyr {

struct BidirectionalSettings {
  int maxDepth = 5;       // scattering events
  double filmPixels = 1;  // of the full image: light paths per sample of a pixel
  bool merges = false;    // vertex merging as well
  // Without, merging is all there is (bidirectional photon mapping), but for lights that trace no light paths, and for
  // what cannot be merged: lights that the camera sees, or sees by deltas alone. Requires `merges`.
  bool connects = true;
  PhotonSettings photons;
  ShadowRays shadowRays;
};

std::unique_ptr<Integrator> MakeBidirectionalIntegrator(const BidirectionalSettings& settings);

}  // namespace lampyr
