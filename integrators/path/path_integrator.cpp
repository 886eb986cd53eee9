#include "integrators/path/path_integrator.h"

#include "integrators/path/camera_path.h"

namespace lampyr {

namespace {

class PathIntegrator final : public Integrator {
 public:
  explicit PathIntegrator(const PathSettings& settings)
      : settings_{settings.maxDepth, {}, 0, true, settings.shadowRays} {}

  TracedPaths Paths() const override { return TracedPaths::Camera; }
  Color Sample(const Ray* ray, const SampleContext& context) const override {
    return TraceCameraPath(context, settings_, *ray, nullptr);
  }

 private:
  CameraPathSettings settings_;
};

}  // namespace

std::unique_ptr<Integrator> MakePathIntegrator(const PathSettings& settings) {
  return std::make_unique<PathIntegrator>(settings);
}

}  // namespace lampyr
