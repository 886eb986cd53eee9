// Densities and partial weights of both subpaths, vertex by vertex (walk/partial_weight.h).
#pragma once

#include "integrators/walk/light_path.h"

namespace lampyr {

// Sets the densities and the partial weight of `vertex`, which its subpath found from `previous` by the ray of `state`.
// Without `connects`: the weight for merging alone. `flightRatio`: FlightPoints::RatioAt of `previous`, if that is the
// first vertex of a camera subpath.
void SetWeights(const PathVertex& previous, const PathState& state, bool connects, PathVertex& vertex,
                double flightRatio = 0);

// A vertex from which a subpath goes on, as far as the weights of the next vertex depend on it.
struct LeftVertex {
  PartialWeight weight;
  AreaDensity previousReverse;  // of the vertex before it, by the event
  bool scatteredDelta = false;
  SolidAngleDensity pdfDirection;
};
// The same. `edge`: factors of the walk between both. `fromPrevious`, `toPrevious`: EdgeDensity at `vertex` and at the
// previous vertex.
void SetWeights(const LeftVertex& previous, const EdgeFactors& edge, SolidAnglePerArea fromPrevious,
                SolidAnglePerArea toPrevious, bool connects, PathVertex& vertex);

// Sets the densities of the last vertex of a subpath, and those of the vertices before it that follow from the last
// one.
// `radius`: of photons in media. `isFromLight`: the camera's side is that of later vertices.
void AddDensities(const Subpath& path, const VolumeRadius& radius, bool isFromLight,
                  std::vector<SubpathDensities>& densities);
// The densities of the first vertex of a light path.
inline SubpathDensities FirstDensities(const LightEnd& end, bool isInMedium) {
  return {.forward = end.emission.value, .isInMedium = isInMedium, .extent = end.extent};
}
// Sets the densities that follow from the scattering event at vertex `count` - 1: whether it can be merged, and the
// reverse density of the vertex before it, `reverse`.
void AddEvent(bool canMerge, bool isDelta, AreaDensity reverse, size_t count, std::span<SubpathDensities> densities);

// An edge of a path at a vertex: the direction away from the vertex, and the factors of a walk that arrives there.
struct ArrivingEdge {
  Vector3 away{0.0f};
  EdgeFactors factors;
  bool isFromMedium = false;  // the other vertex is in a medium
};

// The edge by which a subpath arrives at its vertex `count` - 1.
inline ArrivingEdge EdgeBefore(const Subpath& path, size_t count) {
  const PathVertex& vertex = path[count - 1];
  return {vertex.toPrevious, vertex.factors, count > 1 && path[count - 2].IsInMedium()};
}

// The kernel of merging at a vertex in a medium, for one light path of the first pass: for points the area π r² of the
// disk in which a camera ray finds them, scene units²; for beams 2 r sinθ · (probability of passing the vertex from the
// light's side / density of colliding there), with θ between both edges, times the share of flights that are kept
// ([Křivánek14]).
double MergeSize(const Vertex& vertex, const ArrivingEdge& light, const Vector3& toCamera, const VolumeRadius& radius);
// MergeSize times the probability with which a camera path passes the vertex over the density with which it collides,
// scene units³: over the density of a connection there it is the density of merging.
double MergeVolumeInMedium(const Vertex& vertex, const ArrivingEdge& light, const ArrivingEdge& camera,
                           const VolumeRadius& radius);
// The same; of a vertex on a surface 0.
inline double MergeVolume(const Vertex& vertex, const ArrivingEdge& light, const ArrivingEdge& camera,
                          const VolumeRadius& radius) {
  return vertex.IsInMedium() ? MergeVolumeInMedium(vertex, light, camera, radius) : 0.0;
}
// Probability of passing a vertex over the density of colliding there, scene units; 0: no walk collides there.
inline double PassingPerCollision(const EdgeFactors& factors) {
  return factors.forward > 0 ? factors.through / factors.forward : 0.0;
}

// dω/dA at the first hit of an emitted path: EdgeDensity, for a light at infinity without the squared distance.
SolidAnglePerArea FirstEdgeDensity(const LightingServices& lighting, uint32_t light, float geometryTerm,
                                   double distanceSquared);

// The light's end of a path, for a light found from its first surface vertex. `edge`: FirstEdgeDensity at that vertex.
// `factors`: of media on the edge, from the light to that vertex. `lightPaths`: for each camera path.
LightEnd EndOf(const LightingServices& lighting, const FoundLight& found, bool canBeHit, SolidAnglePerArea edge,
               const EdgeFactors& factors, double lightPaths);

// Sets the partial weight of the first vertex of a light path, whose point and factors are set. `end`: receives the
// light's end of the path. False: the light does not send anything there.
bool SetFirstWeights(const SampleContext& context, const EmittedPhoton& photon, bool connects, double lightPaths,
                     PathVertex& first, LightEnd& end);

// Sets densities and partial weights of a light path while it grows; base of visitors that need them.
class WeightedLightPath : public LightPathVisitor {
 public:
  // `lightPaths`: for each camera path.
  WeightedLightPath(const SampleContext& context, bool connects, double lightPaths = 1)
      : context_(context), connects_(connects), lightPaths_(lightPaths) {}

  bool FirstHit(const EmittedPhoton& photon, PathVertex& first) override;
  void Arrived(LightPath& path, const PathState& state) final;

 protected:
  // A vertex was added to the path, and its weights are set.
  virtual void OnWeighted(const LightPath& path) = 0;
  const LightEnd& End() const { return end_; }

  const SampleContext& context_;
  const bool connects_;
  const double lightPaths_;

 private:
  LightEnd end_;
};

}  // namespace lampyr
