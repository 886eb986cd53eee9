#include "integrators/light/light_integrator.h"

#include "integrators/common/lens.h"
#include "integrators/common/light_subpath.h"

namespace lampyr {

namespace {

class LightIntegrator final : public LightPathIntegrator {
 public:
  LightIntegrator(const RenderScene& scene, const LightPathSettings& settings)
      : scene_(scene), tracer_(scene, settings.maxDepth, SubpathDimensions{}, LightSubpathTracer::Weights::None) {}

  void TracePath(float time, Sampler& sampler, SplatList& splats, RenderCounts& counts) const override;

 private:
  const RenderScene& scene_;
  LightSubpathTracer tracer_;
};

void LightIntegrator::TracePath(float time, Sampler& sampler, SplatList& splats, RenderCounts& counts) const {
  struct Seen final : LightSubpathVisitor {
    const LightIntegrator& own;
    float time;
    Sampler& sampler;
    SplatList& splats;
    RenderCounts& counts;

    Seen(const LightIntegrator& integrator, float t, Sampler& s, SplatList& list, RenderCounts& c)
        : own(integrator), time(t), sampler(s), splats(list), counts(c) {}
    uint32_t GroupOf(uint32_t light) const { return own.scene_.lighting->GroupOf(light); }
    void Emitted(const EmittedPhoton& photon) override {
      if (const auto seen = SeeLight(own.scene_, photon, time, dimensions::kLens, sampler, splats, counts))
        AddSplats(seen->connection, seen->value, GroupOf(photon.light), splats, counts);
    }
    void Arrived(const LightSubpath& path) override {
      const uint32_t lens = own.tracer_.Dimensions().Of(static_cast<int>(path.count), dimensions::kLight);
      if (const auto seen = SeeVertex(own.scene_, path.Last(), time, lens, sampler, splats, counts))
        AddSplats(seen->connection, seen->value, GroupOf(path.light), splats, counts);
    }
  };
  // Kept by the thread: vertices are large, and paths many.
  thread_local LightSubpath path;
  Seen visitor(*this, time, sampler, splats, counts);
  tracer_.Trace(time, sampler, counts, path, visitor);
}

}  // namespace

std::unique_ptr<LightPathIntegrator> MakeLightIntegrator(const RenderScene& scene, const LightPathSettings& settings) {
  return std::make_unique<LightIntegrator>(scene, settings);
}

}  // namespace lampyr
