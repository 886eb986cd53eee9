// Densities and partial weights of both subpaths, vertex by vertex (walk/partial_weight.h).
#pragma once

#include "integrators/walk/light_path.h"

namespace lampyr {

// Sets the densities and the weight of a vertex that its subpath found from the previous one by the ray of `state`.
// Without `connects`, the weight is that of merging alone.
void SetWeights(const PathVertex& previous, const PathState& state, bool connects, PathVertex& vertex);

// From the densities of an emission to area where it lands: EdgeDensity, without the distance of a light at infinity.
SolidAnglePerArea LandingEdge(const LightingServices& lighting, uint32_t light, float geometryTerm,
                              double distanceSquared);

// `landing`: LandingEdge at the first surface vertex.
LightEnd EndOf(const LightingServices& lighting, const FoundLight& found, bool canBeHit, SolidAnglePerArea landing);

// A visitor that sets the weights of a light path while it grows, for those who go on with it.
class WeighedLightPath : public LightPathVisitor {
 public:
  WeighedLightPath(const SampleContext& context, bool connects) : context_(context), connects_(connects) {}

  bool Landed(const EmittedPhoton& photon, PathVertex& first) override;
  void Arrived(LightPath& path, const PathState& state) final;

 protected:
  // The path has come to another vertex, whose weights are set.
  virtual void Weighed(const LightPath& path) = 0;
  const LightEnd& End() const { return end_; }

  const SampleContext& context_;
  const bool connects_;

 private:
  LightEnd end_;
};

}  // namespace lampyr
