// Light tracing: paths start at the lights and in media that glow, and each of their vertices is connected to the
// camera ([Veach97 §10.3.1], the techniques with t = 1; particle tracing of [Dutré93]).
//
// Finds what path tracing cannot: caustics of point, spot and distant lights on anything that is not perfectly smooth.
// Cannot find: what the camera sees in or through something perfectly smooth (a mirror, a pane, glass), because delta
// vertices cannot be connected; lights at infinity seen directly (the background), which have no point to connect; and
// light of lights with traceLightPaths off, which start no paths. It refuses cameras that no path can be connected to
// (Camera::ConnectsLightPaths). These parts of the image are black; all others are
// unbiased. Objects that are small or far from the camera receive few paths, because paths follow the light and not the
// camera.
//
// Depth counts scattering events between light and camera, as for `path`. Russian roulette enters the throughput only.
#include <algorithm>

#include "integrators/walk/integrator_type.h"
#include "integrators/walk/lens.h"
#include "integrators/walk/light_path.h"

namespace lampyr {

namespace {

// Connects where the path starts, and each vertex, to the camera.
class LensConnector final : public LightPathVisitor {
 public:
  explicit LensConnector(const SampleContext& context) : context_(context) {}
  void Emitted(const EmittedPhoton& photon) override {
    const auto seen = SeeLight(context_, photon, dimensions::kLens);
    if (seen) AddStart(*seen, context_.outputs ? context_.outputs->OfLight(photon.light) : 0);
  }
  void Glowed(LightPath&, const EmittedInMedium& emitted) override {
    const auto seen = SeeGlow(context_, emitted, dimensions::kLens);
    if (seen) AddStart(*seen, context_.outputs ? context_.outputs->OfMedia() : 0);
  }
  void Arrived(LightPath& path, const PathState&) override {
    const uint32_t lens = PathDimensions().Of(static_cast<int>(path.vertices.Count()), dimensions::kLight);
    const auto seen = SeeVertex(context_, path.vertices.Last(), lens);
    if (seen) AddSplats(context_, seen->connection, seen->value, LabelsTowardsLens(context_, path.vertices, *seen));
  }

 private:
  void AddStart(const SeenFromLens& seen, uint32_t source) {
    const PathLabel label[] = {{source}};
    AddSplats(context_, seen.connection, seen.value, label);
  }

  const SampleContext& context_;
};

class LightIntegrator final : public Integrator {
 public:
  LightIntegrator(int maxDepth, std::unique_ptr<const GlowingMedia> glowing)
      : maxDepth_(maxDepth), glowing_(std::move(glowing)) {}

  TracedPaths Paths() const override { return TracedPaths::Light; }
  Color Sample(const Ray*, const SampleContext& context) const override {
    thread_local LightPath path(false);
    LensConnector visitor(context);
    TraceLightPath(context, maxDepth_, {}, path, visitor, glowing_.get());
    return Color(0.0f);
  }

 private:
  int maxDepth_;
  std::unique_ptr<const GlowingMedia> glowing_;
};

std::vector<std::string> Hints(const RenderScene& scene) {
  std::vector<std::string> hints;
  const std::vector<PlacedLight>& lights = scene.lighting->Lights();
  const bool hasBackground = std::any_of(lights.begin(), lights.end(), [](const PlacedLight& placed) {
    return placed.light->Kind() == LightKind::Infinite && placed.light->Settings().cameraVisible;
  });
  if (hasBackground) {
    hints.push_back(
        "no path from a light behind everything can be connected to the camera, so the background stays black; "
        "--integrator path and bdpt show it");
  }
  if (HasSmoothMaterial(scene)) {
    hints.push_back(
        "no path from a light can be connected to the camera at a mirror or smooth glass, so these stay black; "
        "--integrator bdpt shows them");
  }
  if (const std::string without = LightsWithoutPaths(scene); !without.empty())
    hints.push_back("lights with \"traceLightPaths\" off (" + without +
                    " lights) start no paths, and their light is missing; --integrator path and bdpt find it");
  return hints;
}

std::string Refusal(const RenderScene& scene) {
  if (scene.camera->ConnectsLightPaths()) return "";
  return "light tracing cannot see through the elements of this camera's lens: the density with which a path leaves a "
         "light for one film point is not known there; path, bdpt, vcm and sppm can";
}

}  // namespace

IntegratorType LightIntegratorType() {
  IntegratorType type;
  type.name = "light";
  type.help = "paths from the lights, each vertex connected to the camera";
  type.settings = {&common_settings::kMaxDepth};
  type.create = [](const IntegratorInput& input) {
    return std::make_unique<LightIntegrator>(MaxDepthOf(input.settings), GlowingMediaOf(input));
  };
  type.hints = Hints;
  type.refusal = Refusal;
  return type;
}

}  // namespace lampyr
