#include "integrators/photon/sppm_integrator.h"

#include <cmath>

#include "integrators/common/adjoint.h"
#include "integrators/common/find_photons.h"
#include "integrators/common/footprint.h"
#include "integrators/common/light_subpath.h"
#include "integrators/common/photon_pass.h"
#include "integrators/path/path_walk.h"

namespace lampyr {

namespace {

constexpr SubpathDimensions kOfCamera{2, 0}, kOfLight{2, 1};

// 1/sr. A lobe that is wider than a quarter of a steradian or so is worth gathering photons for; what is narrower
// would show few of them.
constexpr float kWide = 4;

// The radius of the first pass, in pixels as they are seen at the vertex, where the user names none.
constexpr double kRadiusInPixels = 2;

class SppmIntegrator final : public BidirectionalIntegrator {
 public:
  SppmIntegrator(const RenderScene& scene, const SppmSettings& settings)
      : scene_(scene),
        settings_(settings),
        light_(scene, settings.maxDepth, kOfLight, LightSubpathTracer::Weights::None),
        walk_(scene, {settings.maxDepth, kOfCamera, kWide, !settings.directFromPhotons, settings.shadowRays}) {}

  Color Sample(const Ray* ray, float time, Sampler& sampler, const SampleSinks& sinks) const override;
  std::optional<PhotonSettings> Photons() const override { return settings_.photons; }

 private:
  struct Kept;
  struct Gathered;

  const RenderScene& scene_;
  SppmSettings settings_;
  LightSubpathTracer light_;
  PathWalk walk_;
};

struct SppmIntegrator::Kept final : LightSubpathVisitor {
  Kept(const LightingServices& services, const SampleSinks& sinks, size_t first)
      : lighting(services), photons(*sinks.photons), withOrigin(sinks.withOrigin), firstDepth(first) {}
  void Landed(const EmittedPhoton& photon, const PathVertex& vertex) override {
    if (withOrigin) photons.SetOrigin(OriginOf(lighting, photon, vertex));
  }
  void Arrived(const LightSubpath& path) override {
    if (path.count >= firstDepth && path.Last().storesPhotons)
      photons.Add(path.Last(), path.count, lighting.GroupOf(path.light));
  }

  const LightingServices& lighting;
  PhotonList& photons;
  bool withOrigin;
  size_t firstDepth;
};

// The photons of the pass, as one camera path sees them.
struct SppmIntegrator::Gathered final : PhotonGatherer {
  Gathered(const SppmIntegrator& integrator, const Ray& ray, const SampleSinks& sinks)
      : own(integrator), pass(*sinks.gather), counts(sinks.counts), layers(sinks.layers) {
    if (own.settings_.photons.radius > 0) return;
    const double area = PixelArea(*own.scene_.camera, ray, own.settings_.filmPixels, 1);
    perLength = static_cast<float>(kRadiusInPixels * std::sqrt(area)) * pass.radiusScale;
  }

  float RadiusAt(float length) const {
    if (own.settings_.photons.radius > 0) return pass.radius;
    return own.scene_.camera->ConnectsByDirection() ? perLength : perLength * length;
  }

  // How much a photon counts, beside what is scattered of it: the smaller the radius, the more, in parts of what it
  // would be where the radius is that of the scene seen from its rim.
  float Importance(float length) const {
    if (own.settings_.photons.radius > 0 || own.scene_.camera->ConnectsByDirection()) return 1;
    return Sqr(own.scene_.lighting->SceneSphere().radius / length);
  }

  Color Gather(const SurfacePoint& point, const Bsdf& bsdf, const Vector3& wo, const Color& throughput, int events,
               float length) const override {
    thread_local PhotonLookup lookup;
    const float radius = RadiusAt(length);
    const std::span<const uint32_t> found = FindPhotons(*pass.map, point.position, radius, lookup, counts);
    Color sum;
    for (const uint32_t index : found) {
      const Photon& photon = (*pass.map)[index];
      // The vertex is counted by both paths.
      if (static_cast<int>(photon.depth) + events > own.settings_.maxDepth + 1) continue;
      if (!photon.IsOnSurface(bsdf.Ng())) continue;
      const BsdfEvaluation f = bsdf.Evaluate(wo, photon.toPrevious, TransportMode::Radiance);
      if (f.pdfForward.value > kWide) continue;
      sum += (f.diffuse * photon.flux + f.specular * pass.map->SpecularFlux(photon)) *
             ArrivalCorrection(bsdf, photon.toPrevious);
      if (layers) [[unlikely]]
        AddToLayers(photon, bsdf, f, throughput, PerArea(radius));
      if (pass.use) [[unlikely]]
        pass.use->Add(index, (throughput * f.Sum()).Average() * Importance(length));
    }
    if (sum.IsBlack()) return sum;
    return Product(throughput, sum, PerArea(radius));
  }

  // W/m², of a photon within the radius that carries a unit of flux.
  double PerArea(float radius) const {
    const double area = static_cast<double>(kPi) * static_cast<double>(radius) * static_cast<double>(radius);
    return static_cast<double>(own.scene_.lighting->FluxUnit()) / (pass.lightPaths * area);
  }
  // Apart from the sum of all: a product that both shared would be rounded otherwise than where there are no layers.
  [[gnu::noinline]] void AddToLayers(const Photon& photon, const Bsdf& bsdf, const BsdfEvaluation& f,
                                     const Color& throughput, double perArea) const {
    const Color scattered = f.diffuse * photon.flux + f.specular * pass.map->SpecularFlux(photon);
    layers->Add(photon.group, Product(throughput, scattered * ArrivalCorrection(bsdf, photon.toPrevious), perArea));
  }

  const SppmIntegrator& own;
  const PhotonPass& pass;
  RenderCounts& counts;
  LayerSample* layers;
  float perLength = 0;
};

Color SppmIntegrator::Sample(const Ray* ray, float time, Sampler& sampler, const SampleSinks& sinks) const {
  if (sinks.photons) {
    thread_local LightSubpath path;
    Kept kept(*scene_.lighting, sinks, settings_.directFromPhotons ? 1 : 2);
    light_.Trace(time, sampler, sinks.counts, path, kept);
  }
  if (!ray || !sinks.gather) return Color(0.0f);
  const Gathered gathered(*this, *ray, sinks);
  return walk_.Radiance(*ray, sampler, sinks.counts, &gathered, sinks.layers);
}

}  // namespace

std::unique_ptr<BidirectionalIntegrator> MakeSppmIntegrator(const RenderScene& scene, const SppmSettings& settings) {
  return std::make_unique<SppmIntegrator>(scene, settings);
}

}  // namespace lampyr
