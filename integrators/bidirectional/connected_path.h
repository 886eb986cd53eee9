// A whole path at the moment it is weighed: for the integrator, for its proofs and for images of single techniques.
#pragma once

#include <span>

#include "integrators/photon/photon.h"
#include "integrators/walk/lens.h"

namespace lampyr {

// A path that contributes: `light` subpath (s - 1 surface vertices, from the light on), then `camera` subpath (t - 1
// surface vertices, from the camera on). With s = 0 the light's point follows the camera's last vertex. Where it
// merges, the last vertices of both subpaths are one.
struct ConnectedPath {
  int s = 0, t = 0;
  std::span<const PathVertex> light, camera;
  LightEnd end;
  Vector3 toLight{0.0f}, toLens{0.0f};  // unit; from the first surface vertex, and from the one that the camera sees
  AreaDensity atLens;  // of the vertex that the camera sees, by a camera ray, over that of the point on the lens
  bool isMerged = false;
  double mergesPerDensity = 0;                 // N π r² of merging, which the weight accounts for; 0: there is none
  const FilmConnection* connection = nullptr;  // where it lands, for t = 1; null: in the sample's own pixel
  Color value;                                 // unweighted
  double weight = 1;
};

// Is told of every path that a sample is made of.
class PathObserver {
 public:
  virtual ~PathObserver() = default;
  virtual void Observe(const ConnectedPath& path) = 0;
  // The camera subpath's last vertex is merged with a photon, whose path is told by it alone: `path` has no light
  // subpath, and its end is not known.
  virtual void ObserveMerge(const ConnectedPath& /*path*/, const Photon& /*photon*/) {}
};

}  // namespace lampyr
