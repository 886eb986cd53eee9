// Paths from a light: emission, the first landing, scattering from there. The one tracer of all integrators that follow
// light.
#pragma once

#include <vector>

#include "integrators/common/photon_use.h"
#include "integrators/common/subpath.h"

namespace lampyr {

// Its memory is kept from path to path: vertices are large.
struct LightSubpath {
  std::vector<PathVertex> vertices;  // the first `count`
  size_t count = 0;
  uint32_t light = 0;  // that it comes from
  LightEnd end;        // where weights are wanted

  const PathVertex& Last() const { return vertices[count - 1]; }
};

class LightSubpathVisitor {
 public:
  virtual ~LightSubpathVisitor() = default;
  // The path leaves a surface that camera rays can hit.
  virtual void Emitted(const EmittedPhoton&) {}
  // The path has landed for the first time; before it has Arrived there.
  virtual void Landed(const EmittedPhoton&, const PathVertex&) {}
  // The path has come to another vertex, its last.
  virtual void Arrived(const LightSubpath& path) = 0;
};

// What is kept of the emission of a path that has landed at `first`.
PathOrigin OriginOf(const LightingServices& lighting, const EmittedPhoton& photon, const PathVertex& first);

class LightSubpathTracer {
 public:
  // What of a path's densities is known, and which techniques its weights are of.
  enum class Weights { None, Merging, All };

  // `maxDepth` vertices at most.
  LightSubpathTracer(const RenderScene& scene, int maxDepth, SubpathDimensions dimensions, Weights weights)
      : scene_(scene), maxDepth_(maxDepth), dimensions_(dimensions), weights_(weights) {}

  void Trace(float time, Sampler& sampler, RenderCounts& counts, LightSubpath& path,
             LightSubpathVisitor& visitor) const;

  const SubpathDimensions& Dimensions() const { return dimensions_; }

 private:
  bool Land(const EmittedPhoton& photon, LightSubpath& path) const;

  const RenderScene& scene_;
  int maxDepth_;
  SubpathDimensions dimensions_;
  Weights weights_;
};

}  // namespace lampyr
