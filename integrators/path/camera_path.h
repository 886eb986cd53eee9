// A path from the camera that looks for light at each vertex: next-event estimation and the BSDF's own directions,
// weighted by the power heuristic. All of path tracing, and the first part of photon mapping.
#pragma once

#include "integrators/walk/next_event.h"

namespace lampyr {

// Light that arrives from directions that are not followed.
class PhotonGatherer {
 public:
  virtual ~PhotonGatherer() = default;
  // Scattered towards the previous vertex, by directions whose density is not above CameraPathSettings::gatherBelow,
  // times the vertex's throughput. `events`: scattering events of the path, this one included. `length`: from the
  // camera.
  virtual Color Gather(const PathVertex& vertex, int events, float length) const = 0;
};

struct CameraPathSettings {
  int maxDepth = 5;  // scattering events
  PathDimensions dimensions{};
  // 1/sr: directions of no higher density end the path, but for the light that shines from there by itself; 0: all are
  // followed.
  float gatherBelow = 0;
  bool samplesLights = true;  // next-event estimation; without it, lights are found by followed directions alone
  ShadowRays shadowRays;
};

// An estimate of the radiance that arrives along `ray`. `gatherer` may be null where gatherBelow is 0, and adds to
// SampleContext::layers itself.
Color TraceCameraPath(const SampleContext& context, const CameraPathSettings& settings, const Ray& ray,
                      const PhotonGatherer* gatherer);

}  // namespace lampyr
