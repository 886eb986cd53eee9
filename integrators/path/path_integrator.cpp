#include "integrators/path/path_integrator.h"

#include "integrators/path/path_walk.h"

namespace lampyr {

namespace {

class PathIntegrator final : public CameraIntegrator {
 public:
  PathIntegrator(const RenderScene& scene, const PathSettings& settings)
      : walk_(scene, {settings.maxDepth, {}, 0, true, settings.shadowRays}) {}

  Color Radiance(const Ray& ray, Sampler& sampler, RenderCounts& counts, LayerSample* layers) const override {
    return walk_.Radiance(ray, sampler, counts, nullptr, layers);
  }

 private:
  PathWalk walk_;
};

}  // namespace

std::unique_ptr<CameraIntegrator> MakePathIntegrator(const RenderScene& scene, const PathSettings& settings) {
  return std::make_unique<PathIntegrator>(scene, settings);
}

}  // namespace lampyr
