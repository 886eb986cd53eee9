// Progressive photon mapping ([Hachisuka08], [Hachisuka09]; the radius is a function of the pass alone, as in
// [Knaus11]).
//
// A path from the camera is followed through what is smooth, or nearly, to where light is scattered widely; the light
// that arrives there is sampled, directly, and gathered from photons, indirectly. Which of the two a direction belongs
// to is told by the density with which the BSDF samples it: at every vertex directions of high density are followed,
// and photons that come from the others are gathered. Nothing is counted twice and nothing is missed, whatever lobes a
// material mixes.
//
// Finds all light, caustics seen in mirrors and through glass included. Photons blur it by the radius, which shrinks
// from pass to pass as i^((α - 1) / 2): the error vanishes, the squared one as i^(-α) at best.
//
// Lights with traceLightPaths off are sampled directly and light nothing else.
#include <cmath>

#include "integrators/path/camera_path.h"
#include "integrators/photon/find_photons.h"
#include "integrators/photon/photon_pass.h"
#include "integrators/photon/photon_settings.h"
#include "integrators/walk/footprint.h"
#include "integrators/walk/light_path.h"

namespace lampyr {

namespace {

constexpr PathDimensions kOfCamera{2, 0}, kOfLight{2, 1};

// 1/sr. A lobe that is wider than a quarter of a steradian or so is worth gathering photons for; what is narrower
// would show few of them.
constexpr float kWide = 4;

// The radius of the first pass, in pixels as they are seen at the vertex, where the user names none.
constexpr double kRadiusInPixels = 2;

const Setting kDirectPhotons{.name = "direct-photons",
                             .help = "Gather photons for direct light, too, instead of sampling lights",
                             .fallback = false};

struct SppmSettings {
  int maxDepth = 5;       // scattering events
  double filmPixels = 1;  // of the full image: light paths per pass
  PhotonSettings photons;
  // Light that comes straight from lights is gathered as well, and lights with traceLightPaths off are lost.
  bool directFromPhotons = false;
  ShadowRays shadowRays;
};

class SppmIntegrator final : public Integrator {
 public:
  explicit SppmIntegrator(const SppmSettings& settings)
      : settings_(settings),
        path_{settings.maxDepth, kOfCamera, kWide, !settings.directFromPhotons, settings.shadowRays} {}

  TracedPaths Paths() const override { return TracedPaths::Both; }
  Color Sample(const Ray* ray, const SampleContext& context) const override;
  std::optional<PhotonSettings> Photons() const override { return settings_.photons; }

 private:
  SppmSettings settings_;
  CameraPathSettings path_;
};

// Keeps photons from the vertex `firstDepth` on.
class Kept final : public LightPathVisitor {
 public:
  Kept(const SampleContext& context, size_t firstDepth) : context_(context), firstDepth_(firstDepth) {}

  bool Landed(const EmittedPhoton& photon, PathVertex& first) override {
    if (context_.withOrigin) context_.photons->SetOrigin(OriginOf(*context_.scene.lighting, photon, first));
    return true;
  }
  void Arrived(LightPath& path, const PathState&) override {
    const PathVertex& vertex = path.vertices.Last();
    if (path.vertices.Count() >= firstDepth_ && vertex.storesPhotons)
      context_.photons->Add(vertex, path.vertices.Count(), context_.scene.lighting->GroupOf(path.light));
  }

 private:
  const SampleContext& context_;
  const size_t firstDepth_;
};

// The photons of the pass, as one camera path sees them.
class Gathered final : public PhotonGatherer {
 public:
  Gathered(const SppmSettings& settings, const SampleContext& context, const Ray& ray)
      : settings_(settings), context_(context), pass_(*context.gather) {
    if (settings.photons.radius > 0) return;
    const double area = PixelArea(*context.scene.camera, ray, settings.filmPixels, 1);
    perLength_ = static_cast<float>(kRadiusInPixels * std::sqrt(area)) * pass_.radiusScale;
  }

  Color Gather(const PathVertex& vertex, int events, float length) const override {
    thread_local PhotonLookup lookup;
    const float radius = RadiusAt(length);
    const std::span<const uint32_t> found =
        FindPhotons(*pass_.map, vertex.point.position, radius, lookup, context_.counts);
    Color sum;
    for (const uint32_t index : found) {
      const Photon& photon = (*pass_.map)[index];
      // The vertex is counted by both paths.
      if (static_cast<int>(photon.depth) + events > settings_.maxDepth + 1) continue;
      if (!photon.IsOnSurface(vertex.bsdf.Ng())) continue;
      const BsdfEvaluation f = vertex.Evaluate(photon.toPrevious, TransportMode::Radiance);
      if (f.pdfForward.value > kWide) continue;
      sum += (f.diffuse * photon.flux + f.specular * pass_.map->SpecularFlux(photon)) *
             vertex.ArrivalCorrection(photon.toPrevious);
      if (context_.layers) [[unlikely]]
        AddToLayers(photon, vertex, f, PerArea(radius));
      if (pass_.use) [[unlikely]]
        pass_.use->Add(index, (vertex.Throughput() * f.Sum()).Average() * Importance(length));
    }
    if (sum.IsBlack()) return sum;
    return Product(vertex.Throughput(), sum, PerArea(radius));
  }

 private:
  float RadiusAt(float length) const {
    if (settings_.photons.radius > 0) return pass_.radius;
    return context_.scene.camera->ConnectsByDirection() ? perLength_ : perLength_ * length;
  }

  // The weight of a photon for emission guiding, beside what is scattered of it: the smaller the radius, the more, in
  // parts of what it would be where the radius is that of the scene seen from its rim.
  float Importance(float length) const {
    if (settings_.photons.radius > 0 || context_.scene.camera->ConnectsByDirection()) return 1;
    return Sqr(context_.scene.lighting->SceneSphere().radius / length);
  }

  // W/m², of a photon within the radius that carries a unit of flux.
  double PerArea(float radius) const {
    const double area = static_cast<double>(kPi) * static_cast<double>(radius) * static_cast<double>(radius);
    return static_cast<double>(context_.scene.lighting->FluxUnit()) / (pass_.lightPaths * area);
  }
  // Apart from the sum of all: a product that both shared would be rounded otherwise than where there are no layers.
  [[gnu::noinline]] void AddToLayers(const Photon& photon, const PathVertex& vertex, const BsdfEvaluation& f,
                                     double perArea) const {
    const Color scattered = f.diffuse * photon.flux + f.specular * pass_.map->SpecularFlux(photon);
    context_.layers->Add(
        photon.group, Product(vertex.Throughput(), scattered * vertex.ArrivalCorrection(photon.toPrevious), perArea));
  }

  const SppmSettings& settings_;
  const SampleContext& context_;
  const PhotonPass& pass_;
  float perLength_ = 0;
};

Color SppmIntegrator::Sample(const Ray* ray, const SampleContext& context) const {
  if (context.photons) {
    thread_local LightPath path(false);
    Kept kept(context, settings_.directFromPhotons ? 1 : 2);
    TraceLightPath(context, settings_.maxDepth, kOfLight, path, kept);
  }
  if (!ray || !context.gather) return Color(0.0f);
  const Gathered gathered(settings_, context, *ray);
  return TraceCameraPath(context, path_, *ray, &gathered);
}

}  // namespace

IntegratorType SppmIntegratorType() {
  IntegratorType type;
  type.name = "sppm";
  type.help = "direct light as path finds it, all other light from photons where it is scattered widely";
  type.settings = common_settings::kOfNextEvent;
  type.settings.insert(type.settings.end(), photon_settings::kAll.begin(), photon_settings::kAll.end());
  type.settings.push_back(&kDirectPhotons);
  type.create = [](const IntegratorInput& input) {
    SppmSettings settings;
    settings.maxDepth = MaxDepthOf(input.settings);
    settings.filmPixels = input.FilmPixels();
    settings.photons = PhotonSettingsOf(input);
    settings.directFromPhotons = input.settings.IsOn(kDirectPhotons.name);
    settings.shadowRays = ShadowRaysOf(input);
    return std::make_unique<SppmIntegrator>(settings);
  };
  type.gathersPhotons = [](const Settings&) { return true; };
  return type;
}

}  // namespace lampyr
