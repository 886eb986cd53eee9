// Path tracing with next-event estimation: at each vertex lights are sampled and one BSDF direction is followed, and
// the two techniques are weighted by the power heuristic ([Veach97 §9], [Pharr23 §13.4]).
//
// Cannot find: light of delta lights through or off smooth surfaces (no caustics of point lights).
#include "integrators/path/camera_path.h"
#include "integrators/walk/integrator_type.h"

namespace lampyr {

namespace {

const Setting kRegularize{.name = "regularize",
                          .help = "Roughen mirrors, glass and gloss behind a wide bounce: less noise, and biased",
                          .fallback = false,
                          .isBiased = true};

class PathIntegrator final : public Integrator {
 public:
  // `afterWide`: the materials behind a wide scattering; empty: those of the scene.
  PathIntegrator(const CameraPathSettings& settings, std::vector<std::shared_ptr<const Material>> afterWide)
      : settings_(settings), afterWide_(std::move(afterWide)) {
    if (!afterWide_.empty()) settings_.materialsAfterWide = &afterWide_;
  }

  TracedPaths Paths() const override { return TracedPaths::Camera; }
  bool SeparatesSeenLight() const override { return true; }
  std::vector<std::shared_ptr<const Material>> MaterialsAfterWide() const override { return afterWide_; }
  Color Sample(const Ray* ray, const SampleContext& context) const override {
    return TraceCameraPath(context, settings_, *ray, nullptr);
  }

 private:
  CameraPathSettings settings_;
  const std::vector<std::shared_ptr<const Material>> afterWide_;
};

std::unique_ptr<Integrator> Create(const IntegratorInput& input) {
  CameraPathSettings settings;
  settings.maxDepth = MaxDepthOf(input.settings);
  settings.shadowRays = ShadowRaysOf(input);
  // Next-event estimation and BSDF sampling at a vertex use the same roughened material, so that their weights sum
  // to 1. In a bidirectional path the material of a vertex would differ between techniques.
  const bool regularizes = input.settings.IsOn(kRegularize.name);
  return std::make_unique<PathIntegrator>(settings, regularizes ? RoughenedMaterials(input.scene.materials)
                                                                : std::vector<std::shared_ptr<const Material>>());
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
  type.settings.insert(type.settings.end(), common_settings::kOfGuiding.begin(), common_settings::kOfGuiding.end());
  type.settings.push_back(&kRegularize);
  type.create = Create;
  type.hints = Hints;
  return type;
}

}  // namespace lampyr
