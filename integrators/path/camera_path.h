// Camera paths that look for light at each vertex by next-event estimation and by BSDF sampling, weighted by the power
// heuristic. The whole of path tracing, and the camera paths of photon mapping.
#pragma once

#include "integrators/walk/next_event.h"

namespace lampyr {

// Photon gathering, for light from directions that a camera path does not follow.
class PhotonGatherer {
 public:
  virtual ~PhotonGatherer() = default;
  // Light of photons scattered at `vertex` towards the previous one, times the vertex's throughput. Only photons from
  // directions that the BSDF samples with a density of at most CameraPathSettings::gatherBelow. `events`: scattering
  // events of the path, this one included. `length`: path length from the camera, scene units.
  virtual Color Gather(const PathVertex& vertex, int events, float length) const = 0;
};

struct CameraPathSettings {
  int maxDepth = 5;  // scattering events
  PathDimensions dimensions{};
  // 1/sr. A sampled direction whose density is not higher ends the path: of the surface that it hits only the emission
  // is used, all other light from there is gathered. 0: all directions are followed.
  float gatherBelow = 0;
  // Next-event estimation; without it, lights are found by BSDF sampling alone, except at vertices that gather no
  // photons.
  bool samplesLights = true;
  ShadowRays shadowRays;
  const std::vector<std::shared_ptr<const Material>>* materialsAfterWide = nullptr;  // as in WalkSettings
};

// Estimates the radiance arriving along `ray`. `gatherer` may be null if gatherBelow is 0; it adds to
// SampleContext::layers itself.
Color TraceCameraPath(const SampleContext& context, const CameraPathSettings& settings, const Ray& ray,
                      const PhotonGatherer* gatherer);

}  // namespace lampyr
