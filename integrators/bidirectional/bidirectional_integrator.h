// Bidirectional path tracing ([Veach97 §10], [Lafortune93]) and vertex connection and merging ([Georgiev12]). Each
// sample traces a camera subpath and a light subpath. Each vertex of one is connected to each of the other, and camera
// vertices are merged with photons of other light paths. A technique (s,t) has s vertices from the light and t from the
// camera. All techniques are used, including s = 0 (the camera subpath hits the light) and t = 1 (the light subpath is
// connected to the lens), and are weighted by the power heuristic over all of them (weights.h).
//
// Next-event estimation (s = 1) selects lights through the lighting services as path tracing does, so any selector may
// be used; its exact probabilities at the receiver enter all weights. Lights that do not trace light paths
// (traceLightPaths) are found by s = 0 and s = 1 alone.
//
// Without merging it cannot find light of delta lights along paths of which no edge can be connected, such as a caustic
// seen in a mirror.
#pragma once

#include <memory>

#include "integrators/walk/flight_points.h"
#include "integrators/walk/shadow_roulette.h"
#include "integrators/walk/technique_counts.h"

namespace lampyr {

struct BidirectionalSettings {
  int maxDepth = 5;       // scattering events
  double filmPixels = 1;  // pixels of the full image, and light paths per sample of all pixels
  double splatCount = 1;  // sample count of splats in weights (SplatCount)
  bool merges = false;    // vertex merging
  // Vertex connection. Without it light is found by merging alone (bidirectional photon mapping), except for lights
  // that trace no light paths, and for lights that the camera sees directly or over deltas only, which cannot be
  // merged. If false, `merges` is required.
  bool connects = true;
  PhotonSettings photons;
  TechniqueCounts counts;
  ShadowRays shadowRays;
  std::shared_ptr<const FlightPoints> flightPoints;  // null: light paths are connected to the lens at vertices alone
};

std::unique_ptr<Integrator> MakeBidirectionalIntegrator(const BidirectionalSettings& settings);

}  // namespace lampyr
