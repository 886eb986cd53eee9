// Light paths: emission, first hit, and the walk from there. Used by all integrators that trace paths from lights.
#pragma once

#include "integrators/walk/walk.h"

namespace lampyr {

// Reused from path to path, because vertices are large.
struct LightPath {
  explicit LightPath(bool keepsAll = true) : vertices(keepsAll) {}

  Subpath vertices;    // surface vertices
  uint32_t light = 0;  // index of the emitting light
};

// Callbacks while a light path grows.
class LightPathVisitor {
 public:
  virtual ~LightPathVisitor() = default;
  // The path starts on a surface that camera rays can hit.
  virtual void Emitted(const EmittedPhoton&) {}
  // First hit of the path, before Arrived is called for it. False: the path ends without a vertex.
  virtual bool FirstHit(const EmittedPhoton&, PathVertex&) { return true; }
  // A vertex was added to the path: the last one.
  virtual void Arrived(LightPath& path, const PathState& state) = 0;
};

// Traces a light path with at most `maxDepth` surface vertices.
void TraceLightPath(const SampleContext& context, int maxDepth, const PathDimensions& dimensions, LightPath& path,
                    LightPathVisitor& visitor);

}  // namespace lampyr
