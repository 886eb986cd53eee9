// A path from the camera that looks for light at each vertex: next-event estimation and the BSDF's own directions,
// weighted by the power heuristic. All of path tracing, and the first part of photon mapping.
#pragma once

#include "integrators/common/shadow_roulette.h"
#include "integrators/common/subpath.h"
#include "integrators/integrator.h"

namespace lampyr {

// What light arrives from directions that are not followed.
class PhotonGatherer {
 public:
  virtual ~PhotonGatherer() = default;
  // Scattered towards wo, by directions whose density is not above PathWalkSettings::gatherBelow, times `throughput`:
  // that of the path so far, as are its scattering `events`, this one included, and its `length` from the camera.
  virtual Color Gather(const SurfacePoint& point, const Bsdf& bsdf, const Vector3& wo, const Color& throughput,
                       int events, float length) const = 0;
};

struct PathWalkSettings {
  int maxDepth = 5;  // scattering events
  SubpathDimensions dimensions;
  // 1/sr: directions of no higher density end the path, but for what shines on it by itself; 0: all are followed
  float gatherBelow = 0;
  bool samplesLights = true;  // next-event estimation; without it, lights are found by followed directions alone
  ShadowRays shadowRays;
};

class PathWalk {
 public:
  PathWalk(const RenderScene& scene, const PathWalkSettings& settings)
      : geometry_(*scene.geometry),
        lighting_(*scene.lighting),
        materials_(scene.materials),
        maxDepth_(settings.maxDepth),
        dimensions_(settings.dimensions),
        gatherBelow_(settings.gatherBelow),
        samplesLights_(settings.samplesLights),
        looksForLights_(settings.samplesLights && lighting_.HasLightThatCanBeHit()),
        shadowRays_(settings.shadowRays) {}

  // One sample of the radiance that arrives along `ray`. `gatherer` may be null where gatherBelow is 0, and adds to
  // `layers` (SampleSinks) itself.
  Color Radiance(const Ray& ray, Sampler& sampler, RenderCounts& counts, const PhotonGatherer* gatherer,
                 LayerSample* layers) const;

 private:
  struct State;

  Color Found(const State& path, uint32_t light, const Color& radiance) const;
  Color WeightedEmission(const State& path, const FoundLight& found) const;
  Color EmissionAt(const State& path, const RayHit& hit, const SurfacePoint& point) const;
  Color EscapedEmission(const State& path) const;
  Color DirectLight(const State& path, const SurfacePoint& point, const Bsdf& bsdf, const Vector3& wo,
                    const Receiver& receiver, const Color& soFar, Sampler& sampler, RenderCounts& counts) const;
  Color SampleLight(const State& path, const SurfacePoint& point, const Bsdf& bsdf, const Vector3& wo,
                    const Receiver& receiver, const SelectedLight& light, const Point2& u, const Color& soFar,
                    RenderCounts& counts) const;
  bool Scatter(State& path, const SurfacePoint& point, const Bsdf& bsdf, const Vector3& wo, const Receiver& receiver,
               Sampler& sampler) const;

  const GeometryScene& geometry_;
  const LightingServices& lighting_;
  const std::vector<std::shared_ptr<const Material>>& materials_;
  int maxDepth_;
  SubpathDimensions dimensions_;
  float gatherBelow_;
  bool samplesLights_;
  bool looksForLights_;  // also in directions that are not followed
  ShadowRays shadowRays_;
};

}  // namespace lampyr
