#include "integrators/bidirectional/bidirectional_integrator.h"

#include <algorithm>
#include <cmath>

#include "base/stop.h"
#include "integrators/bidirectional/techniques.h"
#include "integrators/photon/photon_pass.h"

namespace lampyr {

void BidirectionalSample::SetCamera(ConnectedPath& path) const {
  path.t = static_cast<int>(camera.Count()) + 1;
  path.camera = camera.First(camera.Count());
  path.toLens = camera[0].toPrevious;
  path.atLens = camera[0].pdfForward;
}

void BidirectionalSample::SetLight(ConnectedPath& path, size_t count) const {
  path.s = static_cast<int>(count) + 1;
  path.light = light.vertices.First(count);
  path.end = lightEnd;
  path.toLight = light.vertices[0].toPrevious;
}

Color BidirectionalSample::Report(ConnectedPath& path) const {
  if (context.observer) {
    path.mergesPerDensity = std::sqrt(merge);
    context.observer->Observe(path);
  }
  return path.value * static_cast<float>(path.weight);
}

Color BidirectionalSample::Found(ConnectedPath& path, float worth) const {
  const Color contribution = Report(path) * worth;
  if (context.layers) context.layers->Add(Lighting().GroupOf(path.end.light), contribution);
  return contribution;
}

AreaDensity DensityAtLens(const Camera& camera, const Ray& ray, float geometryTerm, double distanceSquared) {
  Point2 film;
  const auto densities = camera.EvaluateRay(ray, &film);
  if (!densities) return AreaDensity(0);
  if (camera.ConnectsByDirection())
    return AreaDensity(static_cast<double>(densities->pdfPosition.value) * EdgeDensity(geometryTerm, 1).value);
  return SolidAngleDensity(densities->pdfDirection) * EdgeDensity(geometryTerm, distanceSquared);
}

namespace {

// The light subpath, as it grows.
class LightSide final : public WeighedLightPath {
 public:
  explicit LightSide(BidirectionalSample& sample)
      : WeighedLightPath(sample.context, sample.settings.connects),
        sample_(sample),
        isConnected_(sample.settings.connects && !sample.context.isForPhotonsAlone) {}

  void Emitted(const EmittedPhoton& photon) override {
    if (isConnected_) SplatLight(sample_, photon);
  }
  bool Landed(const EmittedPhoton& photon, PathVertex& first) override {
    if (!WeighedLightPath::Landed(photon, first)) return false;
    sample_.lightEnd = End();
    if (context_.withOrigin) context_.photons->SetOrigin(OriginOf(sample_.Lighting(), photon, first));
    return true;
  }

 private:
  void Weighed(const LightPath& path) override {
    if (isConnected_) SplatVertex(sample_);
    const PathVertex& vertex = path.vertices.Last();
    if (context_.photons && vertex.storesPhotons)
      context_.photons->Add(vertex, path.vertices.Count(), sample_.Lighting().GroupOf(path.light));
  }

  BidirectionalSample& sample_;
  const bool isConnected_;
};

// The camera subpath, as it grows.
class CameraSide final : public PathVisitor {
 public:
  explicit CameraSide(BidirectionalSample& sample) : sample_(sample) {}

  void Escaped(const Subpath& path, const PathState& state) override {
    sample_.radiance += path.Count() == 0 ? SeeBackground(sample_, state) : HitInfiniteLights(sample_, state);
  }

  bool Met(const Subpath& path, const PathState& state, const RayHit& hit, const SurfacePoint& point,
           bool isLight) override {
    if (isLight) {
      sample_.radiance +=
          path.Count() == 0 ? SeeLightAt(sample_, state, hit, point) : HitLightAt(sample_, state, point);
    }
    return true;
  }

  bool Arrived(Subpath& path, const PathState& state) override {
    PathVertex& vertex = path.Last();
    const size_t depth = path.Count();
    if (depth == 1) {
      SetFirst(vertex, state);
    } else {
      SetWeights(path[depth - 2], state, sample_.settings.connects, vertex);
    }
    if (vertex.isDelta) return true;
    sample_.radiance += EstimateDirectLight(sample_);
    if (sample_.settings.connects) {
      // As many scattering events in all as are wanted.
      const size_t most =
          std::min(sample_.light.vertices.Count(), static_cast<size_t>(sample_.settings.maxDepth) - depth);
      for (size_t i = 1; i <= most; ++i) {
        CheckStop();
        sample_.radiance += Connect(sample_, i);
      }
    }
    if (sample_.merge > 0 && vertex.CanMerge()) sample_.radiance += Merge(sample_);
    return true;
  }

  bool Scattered(const Subpath& path, const PathState&) override {
    const PathVertex& last = path.Last();
    sample_.couldMerge = sample_.couldMerge || (last.CanMerge() && !last.scatteredDelta);
    return true;
  }

 private:
  void SetFirst(PathVertex& vertex, const PathState& state) const {
    vertex.pdfForward = DensityAtLens(*sample_.context.scene.camera, state.ray, vertex.GeometryTerm(vertex.toPrevious),
                                      Sqr(static_cast<double>(state.length)));
    vertex.previousSolidAnglePerArea = {0};  // the lens is not hit
    // Light paths come here but where they pass through.
    const bool isSplatted = vertex.pdfForward.value > 0 && vertex.isSeenByIndirect;
    vertex.weight = PartialWeight::AtLens(vertex.pdfForward, isSplatted && sample_.settings.connects);
  }

  BidirectionalSample& sample_;
};

class BidirectionalIntegrator final : public Integrator {
 public:
  explicit BidirectionalIntegrator(const BidirectionalSettings& settings) : settings_(settings) {}

  TracedPaths Paths() const override { return TracedPaths::Both; }
  std::optional<PhotonSettings> Photons() const override {
    return settings_.merges ? std::optional(settings_.photons) : std::nullopt;
  }
  Color Sample(const Ray* ray, const SampleContext& context) const override;

 private:
  BidirectionalSettings settings_;
};

// Kept by the thread: vertices are large, and samples many.
struct Workspace {
  LightPath light;
  Subpath camera;
  PhotonLookup lookup;
};

Color BidirectionalIntegrator::Sample(const Ray* ray, const SampleContext& context) const {
  thread_local Workspace workspace;
  workspace.light.vertices.Clear();
  workspace.camera.Clear();
  BidirectionalSample sample{context,          settings_, workspace.light, {},     workspace.camera,
                             workspace.lookup, 0,         false,           Color()};
  if (context.gather) sample.merge = Mis(context.gather->MergesPerDensity());
  if (settings_.connects || context.photons) {
    LightSide visitor(sample);
    TraceLightPath(context, settings_.maxDepth, kOfLight, workspace.light, visitor);
  }
  if (!ray) return Color(0.0f);
  PathState state;
  state.ray = *ray;
  state.specular = Color(1.0f);
  CameraSide visitor(sample);
  Walk(context, {TransportMode::Radiance, settings_.maxDepth, kOfCamera}, state, workspace.camera, visitor);
  return sample.radiance;
}

}  // namespace

std::unique_ptr<Integrator> MakeBidirectionalIntegrator(const BidirectionalSettings& settings) {
  return std::make_unique<BidirectionalIntegrator>(settings);
}

}  // namespace lampyr
