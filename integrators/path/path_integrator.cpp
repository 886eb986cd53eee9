// Path tracing with next-event estimation: at each vertex lights are sampled and one BSDF direction is followed, and
// the two techniques are weighted by the power heuristic ([Veach97 §9], [Pharr23 §13.4]).
//
// Cannot find: light of delta lights through or off smooth surfaces (no caustics of point lights).
#include "integrators/path/camera_path.h"
#include "integrators/walk/integrator_type.h"

namespace lampyr {

namespace {

class PathIntegrator final : public Integrator {
 public:
  explicit PathIntegrator(const CameraPathSettings& settings) : settings_(settings) {}

  TracedPaths Paths() const override { return TracedPaths::Camera; }
  Color Sample(const Ray* ray, const SampleContext& context) const override {
    return TraceCameraPath(context, settings_, *ray, nullptr);
  }

 private:
  CameraPathSettings settings_;
};

std::unique_ptr<Integrator> Create(const IntegratorInput& input) {
  CameraPathSettings settings;
  settings.maxDepth = MaxDepthOf(input.settings);
  settings.shadowRays = ShadowRaysOf(input);
  return std::make_unique<PathIntegrator>(settings);
}

std::vector<std::string> Hints(const RenderScene& scene) {
  const std::string lights = DeltaLightsOfCaustics(scene);
  if (lights.empty()) return {};
  return {"no path from the camera can hit a light without extent (" + lights +
          " lights: point, spot, distant and the like), so what they send through smooth glass or off mirrors is "
          "missing; --integrator " +
          std::string(scene.camera->ConnectsLightPaths() ? "bdpt finds it" : "vcm and sppm find it")};
}

}  // namespace

IntegratorType PathIntegratorType() {
  IntegratorType type;
  type.name = "path";
  type.help = "paths from the camera, with next-event estimation";
  type.settings = common_settings::kOfNextEvent;
  type.create = Create;
  type.hints = Hints;
  return type;
}

}  // namespace lampyr
