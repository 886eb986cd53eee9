// Paths from a light: emission, the first landing, scattering from there. The one tracer of all integrators that follow
// light.
#pragma once

#include "integrators/walk/walk.h"

namespace lampyr {

// Its memory is kept from path to path: vertices are large.
struct LightPath {
  explicit LightPath(bool keepsAll = true) : vertices(keepsAll) {}

  Subpath vertices;    // on surfaces
  uint32_t light = 0;  // that it comes from
};

// What somebody makes of a light path while it grows.
class LightPathVisitor {
 public:
  virtual ~LightPathVisitor() = default;
  // The path leaves a surface that camera rays can hit.
  virtual void Emitted(const EmittedPhoton&) {}
  // The path has landed for the first time; before it has Arrived there. False: it ends.
  virtual bool Landed(const EmittedPhoton&, PathVertex&) { return true; }
  // The path has come to another vertex, its last.
  virtual void Arrived(LightPath& path, const PathState& state) = 0;
};

// Traces a path with `maxDepth` vertices at most.
void TraceLightPath(const SampleContext& context, int maxDepth, const PathDimensions& dimensions, LightPath& path,
                    LightPathVisitor& visitor);

}  // namespace lampyr
