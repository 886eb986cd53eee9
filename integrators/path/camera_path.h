// Camera paths that look for light at each vertex by next-event estimation and by BSDF sampling, weighted by the power
// heuristic. The whole of path tracing, and the camera paths of photon mapping.
#pragma once

#include "integrators/walk/next_event.h"

namespace lampyr {

// Photon gathering, for light from directions that a camera path does not follow: at vertices on surfaces, and along
// rays in media.
class PhotonGatherer {
 public:
  virtual ~PhotonGatherer() = default;
  // Looks for the photons near `vertex`, and fetches them into the cache while other work goes on. `length`: path
  // length from the camera, scene units.
  virtual void Find(const PathVertex& vertex, float length) = 0;
  // Light of the photons found last, scattered at the last vertex of `path` towards the previous one, times the
  // vertex's throughput. Only photons from directions that the BSDF samples with a density of at most
  // CameraPathSettings::gatherBelow.
  virtual Color Gather(const Subpath& path, float length) = 0;
  // False if photons are not gathered where a path collides with a medium: all directions are followed from there.
  virtual bool GathersInMedium(const PathVertex& vertex) const = 0;
  // Light of the photons in media that the ray of `state` passes, scattered towards its start, times the throughput
  // there. Only places that gather (GathersInMedium) count, and only directions as above. `path`: its vertices before
  // the ray.
  virtual Color GatherAlong(const Subpath& path, const PathState& state, const Flight& flight) = 0;
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
  bool mediaGlow = false;  // some medium of the scene emits light, which rays traced for emission alone find
  const std::vector<std::shared_ptr<const Material>>* materialsAfterWide = nullptr;  // as in WalkSettings
};

// Estimates the radiance arriving along `ray`. `gatherer` may be null if gatherBelow is 0; it adds to
// SampleContext::layers itself.
Color TraceCameraPath(const SampleContext& context, const CameraPathSettings& settings, const Ray& ray,
                      PhotonGatherer* gatherer);

}  // namespace lampyr
