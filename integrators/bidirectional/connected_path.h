// A complete path with its technique and weight, for the integrator, its tests and the images of single techniques.
#pragma once

#include <span>

#include "integrators/bidirectional/path_densities.h"
#include "integrators/photon/photon.h"
#include "integrators/walk/flight_points.h"
#include "integrators/walk/lens.h"

namespace lampyr {

// A contributing path of technique (s,t). `light`: the s - 1 surface vertices of the light subpath, from the light on.
// `camera`: the t - 1 surface vertices of the camera subpath, from the camera on; with s = 0 only t - 2, because the
// last of its t vertices is the light's point. With `isMerged` the last vertices of both subpaths are one.
struct ConnectedPath {
  int s = 0, t = 0;
  std::span<const PathVertex> light, camera;
  LightEnd end;
  Vector3 toLight{0.0f}, toLens{0.0f};  // unit; from the first surface vertex, and from the one that the camera sees
  // Density of the vertex that the camera sees, by a camera ray, over that of the lens point; 0: t = 1 does not exist.
  AreaDensity atLens;
  EdgeFactors endFactors;   // from the light to the first vertex; not of what the camera sees directly
  EdgeFactors factors;      // of media on a connecting edge (s > 1, t > 1), from the camera's vertex to the light's
  EdgeFactors lensFactors;  // from the lens to the vertex that it sees
  double endDistance = 0;   // from the light to the first vertex, for paths of one; infinite for a light at infinity
  const FlightPoints* flightPoints = nullptr;  // that the weight accounts for
  bool isOfFlight = false;                     // the light subpath's last vertex is a point of a flight
  const VolumeRadius* volume = nullptr;        // of photons in media in the first pass
  bool isMerged = false;
  Merging merging;                             // that the weight accounts for
  double connectionCount = 1;                  // connections per light path that the weight accounts for, squared
  double splatCount = 1;                       // of t = 1 that the weight accounts for
  double continuing = 1;                       // TechniqueCounts::continuing that the weight accounts for
  double seenDensity = 0;                      // of the vertex that the camera sees, as in P_C (path_densities.h)
  const FilmConnection* connection = nullptr;  // of t = 1; null: the path contributes to the sample's own pixel
  Color value;                                 // contribution before the weight
  double weight = 1;
  TechniqueSums sums;  // if the observer wants them; of lights that the camera sees, always

  Color WeightedValue() const { return value * static_cast<float>(weight); }
};

struct BeamVertex;  // beam_merge.h

// Receives every path that contributes to a sample.
class PathObserver {
 public:
  virtual ~PathObserver() = default;
  // True if ConnectedPath::sums are to be computed, of paths with merging.
  virtual bool WantsSums() const { return false; }
  virtual void Observe(const ConnectedPath& path) = 0;
  // The camera subpath's last vertex was merged with `photon`. Of the photon's path only the photon is known: `path`
  // has no light subpath and no `end`.
  virtual void ObserveMerge(const ConnectedPath& /*path*/, const Photon& /*photon*/) {}
  // The camera subpath's last vertex was merged with a photon beam. `path` as of ObserveMerge. `flight`: index of the
  // beam's start in the map.
  virtual void ObserveBeamMerge(const ConnectedPath& /*path*/, const BeamVertex& /*beam*/, uint32_t /*flight*/) {}
};

}  // namespace lampyr
