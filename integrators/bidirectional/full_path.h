// A whole path with all its densities, and the weights of its techniques computed twice: from the explicit products of
// densities, and by the recursion that the integrator uses. Slow; the integrator's proof, not its means.
#pragma once

#include <vector>

#include "integrators/bidirectional/connected_path.h"

namespace lampyr {

// Surface vertices are 1 … n from the light on; 0 is the light's point, n + 1 the lens. Of deltas, coefficients
// (walk/partial_weight.h).
struct FullPath {
  LightEnd end;
  std::vector<AreaDensity> fromLight;   // [i]: of vertex i, sampled from i - 1; [1] is not used (LightEnd::emission)
  std::vector<AreaDensity> fromCamera;  // [i]: of vertex i, sampled from i + 1
  std::vector<bool> isDelta;            // [i]: the event at vertex i is one
  bool lensSeesIt = true;               // a light path may reach vertex n
  double mergesPerDensity = 0;          // N π r²; 0: there is no merging
  int technique = 0;                    // of the path that it was made from

  int SurfaceCount() const { return static_cast<int>(isDelta.size()) - 2; }
  // Techniques are s = 0 … n + 1, and merging at vertex i = 1 … n, which is technique n + 1 + i.
  int TechniqueCount() const { return 2 * SurfaceCount() + 2; }
  bool CanMerge(int i) const {
    return mergesPerDensity > 0 && !isDelta[static_cast<size_t>(i)] && (i < SurfaceCount() || lensSeesIt);
  }
};

FullPath Unfold(const ConnectedPath& path);

// Of all techniques, by their densities; those that cannot make the path have 0.
std::vector<double> WeightsByDensities(const FullPath& path);
// Weights of all techniques by partial weights, from the functions that the integrator calls (weights.h).
std::vector<double> WeightsByRecursion(const FullPath& path);

}  // namespace lampyr
