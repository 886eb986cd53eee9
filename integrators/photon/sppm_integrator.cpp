// Progressive photon mapping ([Hachisuka08], [Hachisuka09]; the radius is a function of the pass alone, as in
// [Knaus11]).
//
// Camera paths are followed over smooth or nearly smooth surfaces to where light is scattered widely. There direct
// light is sampled, and indirect light is gathered from photons. Directions are divided between the two by the density
// with which the BSDF samples them: at every vertex directions of high density are followed, and photons from all other
// directions are gathered. No light is counted twice or missed, whatever lobes a material mixes.
//
// Participating media do the same with the directions of their phase functions. Their photons are gathered by the rays
// that pass them (volume_estimate.h), where the radius is small against the mean free path; in media that are denser,
// camera paths follow all directions.
//
// Finds all light, including caustics seen in mirrors and through glass. Photons blur it by the radius, which shrinks
// from pass to pass as i^((α - 1) / 2): the error vanishes, the squared error as i^(-α) at best.
//
// Of lights with traceLightPaths off only direct light is found.
#include <algorithm>
#include <cmath>

#include "integrators/path/camera_path.h"
#include "integrators/photon/merge_bias.h"
#include "integrators/photon/photon_pass.h"
#include "integrators/photon/photon_settings.h"
#include "integrators/photon/volume_estimate.h"
#include "integrators/walk/footprint.h"
#include "integrators/walk/light_path.h"
#include "integrators/walk/path_layers.h"

namespace lampyr {

namespace {

constexpr PathDimensions kCameraDimensions{2, 0}, kLightDimensions{2, 1};

// 1/sr. Photons are gathered for lobes wider than about a quarter of a steradian; a narrower lobe would find few of
// them.
constexpr float kWide = 4;

// Radius of the first pass by default, in pixel footprints at the vertex; of photons in media, in times that of
// PhotonSettingsOf, which is one pixel.
constexpr double kRadiusInPixels = 2;

// In media, photons whose radius is more than a tenth of a mean free path are not gathered, and camera paths follow all
// directions there. Near boundaries photons miss light: of a lit ball of ten mean free paths 12 % times this ratio.
constexpr double kMostMeanFreePaths = 0.1;

const Setting kDirectPhotons{.name = "direct-photons",
                             .help = "Gather photons for direct light, too, instead of sampling lights",
                             .fallback = false};

struct SppmSettings {
  int maxDepth = 5;       // scattering events
  double filmPixels = 1;  // of the full image: light paths per pass
  PhotonSettings photons;
  // Direct light is gathered from photons, too; lights with traceLightPaths off are then lost.
  bool directFromPhotons = false;
  ShadowRays shadowRays;
};

class SppmIntegrator final : public Integrator {
 public:
  SppmIntegrator(const SppmSettings& settings, std::unique_ptr<const GlowingMedia> glowing)
      : settings_(settings),
        path_{settings.maxDepth,           kCameraDimensions,   kWide,
              !settings.directFromPhotons, settings.shadowRays, glowing != nullptr},
        glowing_(std::move(glowing)) {}

  TracedPaths Paths() const override { return TracedPaths::Both; }
  bool SeparatesSeenLight() const override { return true; }
  bool FollowsCameraPaths() const override { return false; }
  Color Sample(const Ray* ray, const SampleContext& context) const override;
  std::optional<PhotonSettings> Photons() const override { return settings_.photons; }

 private:
  SppmSettings settings_;
  CameraPathSettings path_;
  std::unique_ptr<const GlowingMedia> glowing_;
};

// Stores the photons of a light path from its second vertex on, or from its first. Photons from glowing media are
// direct light at their first vertex, too, which the rays traced for emission find.
class PhotonRecorder final : public LightPathVisitor {
 public:
  PhotonRecorder(const SampleContext& context, const SppmSettings& settings)
      : context_(context), firstDepth_(settings.directFromPhotons ? 1 : 2), photons_(settings.photons) {}

  // Emission guiding does not learn from paths that start in media: their origin has no flux.
  void Glowed(LightPath&, const EmittedInMedium&) override {
    if (context_.withOrigin) context_.photons->SetOrigin(PathOrigin());
  }
  bool FirstHit(const EmittedPhoton& photon, PathVertex& first) override {
    if (context_.withOrigin) context_.photons->SetOrigin(OriginOf(*context_.scene.lighting, photon, first));
    return true;
  }
  void Arrived(LightPath& path, const PathState&) override {
    const PathVertex& vertex = path.vertices.Last();
    if (path.vertices.Count() < firstDepth_ || !vertex.storesPhotons) return;
    if (context_.IsCounted(vertex.isDispersed)) return;
    if (vertex.IsInMedium() && !MayBeGathered(vertex)) return;
    context_.photons->Add(vertex, path.vertices.Count(), LabelsOfLast(context_, path.vertices));
  }

 private:
  // In a medium: false if the radius is too large for the medium in all passes that may gather the photon. Dense media
  // would otherwise fill with photons that are never gathered.
  bool MayBeGathered(const PathVertex& vertex) const {
    const Point3& at = vertex.point.position;
    if (photons_.volume.OfGathered(at, vertex.extinction) > 0) return true;
    const VolumeRadius last = photons_.volume.Scaled(RadiusScale(context_.lastGathering, photons_.alpha));
    return last.OfGathered(at, vertex.extinction) > 0;
  }

  const SampleContext& context_;
  const size_t firstDepth_;
  const PhotonSettings& photons_;
};

// Gathers the photons of the pass along one camera path.
class RadianceEstimate final : public PhotonGatherer {
 public:
  // `lookup`: of the thread.
  RadianceEstimate(const SppmSettings& settings, const SampleContext& context, const Ray& ray, PhotonLookup& lookup)
      : settings_(settings), context_(context), pass_(*context.gather), lookup_(lookup) {
    if (settings.photons.radius > 0) return;
    const double area = PixelArea(*context.scene.camera, ray, settings.filmPixels, 1);
    perLength_ = static_cast<float>(kRadiusInPixels * std::sqrt(area)) * pass_.radiusScale;
  }

  void Find(const PathVertex& vertex, float length) override {
    found_ = FindPhotons(*pass_.map, vertex.point.position, RadiusAt(length), lookup_, context_.counts);
    if (pass_.use) pass_.use->Fetch(found_.first(std::min(found_.size(), kFetched)));
  }

  Color Gather(const Subpath& path, float length) override {
    const PathVertex& vertex = path.Last();
    const auto events = static_cast<int>(path.Count());
    const float radius = RadiusAt(length);
    if (pass_.use) pass_.use->FetchSums(found_.first(std::min(found_.size(), kFetched)));
    lookup_.used.clear();
    const float sheetDistance = Photon::SheetDistance(vertex.point.position, radius);
    Color sum, bias;
    for (size_t i = 0; i < found_.size(); ++i) {
      const uint32_t index = found_[i];
      const Photon& photon = (*pass_.map)[index];
      // Both depths count the vertex.
      if (static_cast<int>(photon.depth) + events > settings_.maxDepth + 1) continue;
      if (!photon.IsOnSurface(vertex.bsdf.Ng(), pass_.map->OffsetFrom(vertex.point.position, index), sheetDistance))
        continue;
      const BsdfEvaluation f = vertex.Evaluate(photon.toPrevious, TransportMode::Radiance);
      if (f.pdfForward.value > kWide) continue;
      // The terms of the sum are not shared: they would be rounded differently than without the bias.
      const Color before = sum;
      sum += (f.diffuse * photon.flux + f.specular * pass_.map->SpecularFlux(photon)) *
             vertex.ArrivalCorrection(photon.toPrevious, photon.normal.Unpack());
      bias += (sum - before) * BiasFactor(lookup_.distances[i], radius);
      if (context_.layers) [[unlikely]]
        AddPhotonToLayers(index, path, f, PerArea(radius));
      if (pass_.use) lookup_.used.push_back({index, (vertex.Throughput() * f.Sum()).Average() * Importance(length)});
    }
    if (pass_.use) pass_.use->Add(lookup_.used);
    if (sum.IsBlack()) return sum;
    if (context_.mergeBias) *context_.mergeBias += Product(vertex.Throughput(), bias, PerArea(radius));
    return Product(vertex.Throughput(), sum, PerArea(radius));
  }

  bool GathersInMedium(const PathVertex& vertex) const override {
    return pass_.volume.OfGathered(vertex.point.position, vertex.extinction) > 0;
  }

  Color GatherAlong(const Subpath& path, const PathState& state, const Flight& flight) override {
    if (!pass_.map->HasPoints()) return Color();
    const float importance = Sqr(RadiusAt(context_.scene.lighting->SceneSphere().radius));
    return VolumeEstimate(context_, {settings_.maxDepth, kWide, importance}, lookup_).Gather(path, state, flight);
  }

 private:
  float RadiusAt(float length) const {
    if (settings_.photons.radius > 0) return pass_.radius;
    return context_.scene.camera->ConnectsByDirection() ? perLength_ : perLength_ * length;
  }

  // Weight of a photon for emission guiding, besides its scattering: proportional to 1 / radius², relative to that at a
  // path length of the scene's radius.
  float Importance(float length) const {
    if (settings_.photons.radius > 0 || context_.scene.camera->ConnectsByDirection()) return 1;
    return Sqr(context_.scene.lighting->SceneSphere().radius / length);
  }

  // Irradiance (W/m²) by a photon within the radius that carries a unit of flux.
  double PerArea(float radius) const {
    const double area = static_cast<double>(kPi) * static_cast<double>(radius) * static_cast<double>(radius);
    return static_cast<double>(context_.scene.lighting->FluxUnit()) / (pass_.lightPaths * area);
  }
  // Not inlined into the sum: a shared product would be rounded differently than without layers.
  [[gnu::noinline]] void AddPhotonToLayers(uint32_t index, const Subpath& path, const BsdfEvaluation& f,
                                           double perArea) const {
    const Photon& photon = (*pass_.map)[index];
    const PathVertex& vertex = path.Last();
    const Color diffuse = f.diffuse * photon.flux, specular = f.specular * pass_.map->SpecularFlux(photon);
    const float correction = vertex.ArrivalCorrection(photon.toPrevious, photon.normal.Unpack());
    AddArrivingToLayers(context_, path, PartsOf(vertex, photon.toPrevious, false, diffuse, specular),
                        pass_.map->LabelsOf(index),
                        Product(vertex.Throughput(), (diffuse + specular) * correction, perArea));
  }

  const SppmSettings& settings_;
  const SampleContext& context_;
  // Photons of a lookup whose use is fetched ahead.
  static constexpr size_t kFetched = 64;

  const PhotonPass& pass_;
  PhotonLookup& lookup_;
  std::span<const uint32_t> found_;  // in `lookup_`
  float perLength_ = 0;
};

Color SppmIntegrator::Sample(const Ray* ray, const SampleContext& context) const {
  if (context.photons) {
    thread_local LightPath path(false);
    PhotonRecorder recorder(context, settings_);
    TraceLightPath(context, settings_.maxDepth, kLightDimensions, path, recorder, glowing_.get());
  }
  if (ray && context.isForSeenLight) return TraceCameraPath(context, path_, *ray, nullptr);
  if (!ray || !context.gather) return Color(0.0f);
  thread_local PhotonLookup lookup;
  RadianceEstimate estimate(settings_, context, *ray, lookup);
  return TraceCameraPath(context, path_, *ray, &estimate);
}

}  // namespace

IntegratorType SppmIntegratorType() {
  IntegratorType type;
  type.name = "sppm";
  type.help = "direct light as path finds it, all other light from photons at the first diffuse or glossy vertices";
  type.settings = common_settings::kOfNextEvent;
  type.settings.insert(type.settings.end(), photon_settings::kAll.begin(), photon_settings::kAll.end());
  type.settings.push_back(&kDirectPhotons);
  type.create = [](const IntegratorInput& input) {
    SppmSettings settings;
    settings.maxDepth = MaxDepthOf(input.settings);
    settings.filmPixels = input.FilmPixels();
    settings.photons = PhotonSettingsOf(input);
    if (!(settings.photons.radius > 0)) settings.photons.volume = settings.photons.volume.Scaled(kRadiusInPixels);
    settings.photons.volume.mostMeanFreePaths = kMostMeanFreePaths;
    settings.directFromPhotons = input.settings.IsOn(kDirectPhotons.name);
    settings.shadowRays = ShadowRaysOf(input);
    return std::make_unique<SppmIntegrator>(settings, GlowingMediaOf(input));
  };
  type.gathersPhotons = [](const Settings&) { return true; };
  // For --stats and --auto-layers: these counts do not vary.
  type.counted = [](const Settings&) { return CountedTechniques{.lightPaths = true, .merging = true}; };
  type.hints = [](const RenderScene& scene) -> std::vector<std::string> {
    const std::string without = LightsWithoutPaths(scene);
    if (without.empty()) return {};
    return {"lights with \"traceLightPaths\" off (" + without +
            " lights) leave no photons, and their indirect light is missing (with --direct-photons their direct light, "
            "too); --integrator path, bdpt and vcm find it"};
  };
  return type;
}

}  // namespace lampyr
