#include "integrators/light/light_integrator.h"

#include "integrators/walk/lens.h"
#include "integrators/walk/light_path.h"

namespace lampyr {

namespace {

// Connects the light, and each vertex, to the camera.
class Seen final : public LightPathVisitor {
 public:
  explicit Seen(const SampleContext& context) : context_(context) {}
  void Emitted(const EmittedPhoton& photon) override {
    Add(SeeLight(context_, photon, dimensions::kLens), photon.light);
  }
  void Arrived(LightPath& path, const PathState&) override {
    const uint32_t lens = PathDimensions().Of(static_cast<int>(path.vertices.Count()), dimensions::kLight);
    Add(SeeVertex(context_, path.vertices.Last(), lens), path.light);
  }

 private:
  void Add(const std::optional<SeenFromLens>& seen, uint32_t light) {
    if (!seen) return;
    AddSplats(seen->connection, seen->value, context_.scene.lighting->GroupOf(light), *context_.splats,
              context_.counts);
  }

  const SampleContext& context_;
};

class LightIntegrator final : public Integrator {
 public:
  explicit LightIntegrator(const LightPathSettings& settings) : settings_(settings) {}

  TracedPaths Paths() const override { return TracedPaths::Light; }
  Color Sample(const Ray*, const SampleContext& context) const override {
    thread_local LightPath path(false);
    Seen visitor(context);
    TraceLightPath(context, settings_.maxDepth, {}, path, visitor);
    return Color(0.0f);
  }

 private:
  LightPathSettings settings_;
};

}  // namespace

std::unique_ptr<Integrator> MakeLightIntegrator(const LightPathSettings& settings) {
  return std::make_unique<LightIntegrator>(settings);
}

}  // namespace lampyr
