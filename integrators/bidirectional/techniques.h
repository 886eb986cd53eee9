// The techniques of a bidirectional sample. Each makes paths in one way, weighs them (weights.h) and returns what they
// contribute to the sample's own pixel, or splats it.
#pragma once

#include "integrators/bidirectional/bidirectional_integrator.h"
#include "integrators/bidirectional/connected_path.h"
#include "integrators/bidirectional/subpath_weights.h"
#include "integrators/photon/photon_map.h"
#include "integrators/walk/next_event.h"

namespace lampyr {

// The two paths of a sample take turns in the sampler's dimensions, so that neither runs into the other.
inline constexpr PathDimensions kOfCamera{2, 0}, kOfLight{2, 1};

// A sample under way: both subpaths, and what the camera subpath has gathered so far.
struct BidirectionalSample {
  const SampleContext& context;
  const BidirectionalSettings& settings;
  const LightPath& light;
  LightEnd lightEnd;  // of `light`
  Subpath& camera;
  PhotonLookup& lookup;
  double merge = 0;         // (N π r²)^β; 0: nothing is merged
  bool couldMerge = false;  // at a vertex of the camera subpath
  Color radiance;

  const LightingServices& Lighting() const { return *context.scene.lighting; }
  // Of a vertex that techniques may merge at.
  double MergeAt(const PathVertex& vertex) const { return vertex.CanMerge() ? merge : 0.0; }
  bool IsObserved() const { return context.observer != nullptr; }
  // Which shadow rays are traced: an observer is shown all of them.
  ShadowRays WantedShadowRays() const { return IsObserved() ? ShadowRays{0, 0} : settings.shadowRays; }

  // The ends of a path with a camera subpath, or with the light subpath of this sample.
  void SetCamera(ConnectedPath& path) const;
  void SetLight(ConnectedPath& path, size_t count) const;
  // What a path contributes; observers are told of it.
  Color Report(ConnectedPath& path) const;
  // The same of a path that lands in the sample's own pixel, in the layer of its light; `worth`: ShadowRays::Worth.
  Color Found(ConnectedPath& path, float worth = 1) const;
};

// Density (area) of the vertex that a camera ray sees, over that of the point on the lens alone: what t = 2 has and
// t = 1 has not.
AreaDensity DensityAtLens(const Camera& camera, const Ray& ray, float geometryTerm, double distanceSquared);

// (0,2): the camera looks at an area light, or past everything at lights at infinity.
Color SeeLightAt(const BidirectionalSample& sample, const PathState& state, const RayHit& hit,
                 const SurfacePoint& point);
Color SeeBackground(const BidirectionalSample& sample, const PathState& state);
// s = 0, t > 2: the camera subpath has found a light by scattering: an area light at `point`, or those at infinity.
Color HitLightAt(const BidirectionalSample& sample, const PathState& state, const SurfacePoint& point);
Color HitInfiniteLights(const BidirectionalSample& sample, const PathState& state);

// s = 1: next-event estimation at the camera subpath's last vertex.
Color EstimateDirectLight(const BidirectionalSample& sample);

// s > 1, t > 1: the first `lightCount` vertices of the light subpath, connected to the camera subpath's last.
Color Connect(const BidirectionalSample& sample, size_t lightCount);

// t = 1: the light, or the last vertex of the light subpath, connected to the lens.
void SplatLight(const BidirectionalSample& sample, const EmittedPhoton& photon);
void SplatVertex(const BidirectionalSample& sample);

// Photons near the camera subpath's last vertex: each could have been its next step to the light ([Georgiev12 §3]).
Color Merge(const BidirectionalSample& sample);

}  // namespace lampyr
