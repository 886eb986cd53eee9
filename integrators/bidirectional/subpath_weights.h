// Densities and partial weights of both subpaths, vertex by vertex (walk/partial_weight.h).
#pragma once

#include "integrators/walk/light_path.h"

namespace lampyr {

// Sets the densities and the partial weight of `vertex`, which its subpath found from `previous` by the ray of `state`.
// Without `connects`: the weight for merging alone.
void SetWeights(const PathVertex& previous, const PathState& state, bool connects, PathVertex& vertex);

// The densities of the last vertex of a subpath, and what is known of those before it once that one is there.
// `radius`: of photons in media; null: no merging there. `isFromLight`: the camera's side is that of later vertices.
void AddDensities(const Subpath& path, const VolumeRadius* radius, bool isFromLight,
                  std::vector<SubpathDensities>& densities);

// SubpathDensities::mergeVolume of a vertex. `factors`: of the edge towards it from the camera's side.
float MergeVolumeInMedium(const Vertex& vertex, const EdgeFactors& factors, const VolumeRadius& radius);
inline float MergeVolume(const Vertex& vertex, const EdgeFactors& factors, const VolumeRadius& radius) {
  return vertex.IsInMedium() ? MergeVolumeInMedium(vertex, factors, radius) : 0.0f;
}

// dω/dA at the first hit of an emitted path: EdgeDensity, for a light at infinity without the squared distance.
SolidAnglePerArea FirstEdgeDensity(const LightingServices& lighting, uint32_t light, float geometryTerm,
                                   double distanceSquared);

// The light's end of a path, for a light found from its first surface vertex. `edge`: FirstEdgeDensity at that vertex.
// `factors`: of media on the edge, from the light to that vertex. `lightPaths`: for each camera path.
LightEnd EndOf(const LightingServices& lighting, const FoundLight& found, bool canBeHit, SolidAnglePerArea edge,
               const EdgeFactors& factors, double lightPaths);

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
