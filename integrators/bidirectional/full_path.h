// A complete path with all its densities, and the weights of its techniques computed in two ways: from explicit
// products of densities, and by the recursion that the integrator uses. Slow; for tests of the integrator.
#pragma once

#include <vector>

#include "integrators/bidirectional/connected_path.h"

namespace lampyr {

// Vertex 0 is the light's point, vertices 1 … n are on surfaces, from the light on, and n + 1 is the lens. Densities of
// delta events are coefficients (walk/partial_weight.h).
struct FullPath {
  LightEnd end;
  std::vector<AreaDensity> fromLight;   // [i]: of vertex i, sampled from i - 1; [1] is not used (LightEnd::emission)
  std::vector<AreaDensity> fromCamera;  // [i]: of vertex i, sampled from i + 1
  std::vector<bool> isDelta;            // [i]: the event at vertex i is one
  std::vector<bool> isInMedium;         // [i]: densities of vertex i are per volume
  std::vector<double> mergeVolume;      // [i]: SubpathDensities::mergeVolume of vertex i
  std::vector<bool> gathers;            // [i]: photons may be gathered at vertex i
  bool lensSeesIt = true;               // a light path may reach vertex n and be connected to the lens
  bool mergesAtLens = true;             // photons may be merged at vertex n
  Merging merging;
  double connectionCount = 1;  // connections per light path, squared
  double splatCount = 1;       // of t = 1
  double flightRatio = 0;      // FlightPoints::RatioAt of vertex n
  double seenDensity = 0;      // of vertex n by a camera ray, also where the lens is not connected
  int technique = 0;           // that made the path

  int SurfaceCount() const { return static_cast<int>(isDelta.size()) - 2; }
  // Techniques are s = 0 … n + 1, merging at vertex i = 1 … n, which is technique n + 1 + i, and the last one: s = n +
  // 1 with vertex n as a point of a flight.
  int TechniqueCount() const { return 2 * SurfaceCount() + 3; }
  bool CanMerge(int i) const {
    const auto vertex = static_cast<size_t>(i);
    return merging && !isDelta[vertex] && gathers[vertex] && (i < SurfaceCount() || mergesAtLens);
  }
  // A camera path may end at vertex `i` if it is FirstWide.
  bool CanEnd(int i) const {
    const auto vertex = static_cast<size_t>(i);
    return !isDelta[vertex] && gathers[vertex] && (i < SurfaceCount() || mergesAtLens);
  }
};

// N π r² at vertex `i`, with the probability of merging, without c.
double PerDensityAt(const FullPath& path, int i);

// The first vertex from the camera whose event is no delta; 0: there is none.
int FirstWide(const FullPath& path);

FullPath Unfold(const ConnectedPath& path);

// c of vertex `i` (path_densities.h), from explicit products.
double CorrelationAt(const FullPath& path, int i);
// Weights of all techniques from explicit densities; 0 for techniques that cannot make the path.
std::vector<double> WeightsByDensities(const FullPath& path);
// TechniqueSums from explicit densities, with merging.
TechniqueSums SumsByDensities(const FullPath& path);
// Weights of all techniques by partial weights, from the functions that the integrator calls (weights.h).
std::vector<double> WeightsByRecursion(const FullPath& path);

}  // namespace lampyr
