#include "integrators/bdpt/bdpt_integrator.h"

#include <algorithm>
#include <cmath>

#include "base/stop.h"
#include "integrators/common/adjoint.h"
#include "integrators/common/escaped_emission.h"
#include "integrators/common/find_photons.h"
#include "integrators/common/lens.h"
#include "integrators/common/light_subpath.h"

namespace lampyr {

namespace {

// The two paths take turns in the sampler's dimensions, so that neither runs into the other.
constexpr SubpathDimensions kOfCamera{2, 0}, kOfLight{2, 1};

// Kept by the thread: vertices are large, and samples many.
struct Workspace {
  LightSubpath light;
  std::vector<PathVertex> camera;
  PhotonLookup lookup;
};

class BdptIntegrator final : public BidirectionalIntegrator {
 public:
  BdptIntegrator(const RenderScene& scene, const BdptSettings& settings)
      : scene_(scene),
        geometry_(*scene.geometry),
        lighting_(*scene.lighting),
        settings_(settings),
        light_(scene, settings.maxDepth, kOfLight,
               settings.connects ? LightSubpathTracer::Weights::All : LightSubpathTracer::Weights::Merging),
        connectsByDirection_(scene.camera->ConnectsByDirection()) {}

  Color Sample(const Ray* ray, float time, Sampler& sampler, const SampleSinks& sinks) const override;

  std::optional<PhotonSettings> Photons() const override {
    return settings_.merges ? std::optional(settings_.photons) : std::nullopt;
  }

 private:
  // One sample's state: both subpaths, where it draws from and what it adds to.
  struct Run {
    Workspace& paths;
    Sampler& sampler;
    const SampleSinks& sinks;
    float time;
    double merge = 0;  // (N π r²)^β, see partial_weight.h; 0: nothing is merged
    size_t cameraCount = 0;
    bool couldMerge = false;  // at a vertex of the camera subpath
    Color gathered{0.0f};     // by the camera subpath so far

    RenderCounts& Counts() const { return sinks.counts; }
    std::span<const PathVertex> Light(size_t count) const { return {paths.light.vertices.data(), count}; }
    std::span<const PathVertex> Camera(size_t count) const { return {paths.camera.data(), count}; }
    // Of a vertex that techniques may merge at.
    double MergeAt(const PathVertex& vertex) const { return vertex.CanMerge() ? merge : 0.0; }
  };
  struct LightVisitor;

  Color TraceCamera(Run& run, const Ray& ray) const;
  void SeeLightPoint(Run& run, const EmittedPhoton& photon) const;
  void SeeLightVertex(Run& run) const;
  Color HitLight(Run& run, const Flight& flight, const FoundLight& found, double landing) const;
  Color SeenLight(Run& run, const Flight& flight, const RayHit& hit, const SurfacePoint& point) const;
  Color Background(const Run& run, const Flight& flight) const;
  Color SampleLights(Run& run) const;
  Color SampleLight(Run& run, const SelectedLight& light, const Point2& u) const;
  Color Connect(Run& run, size_t lightCount) const;
  Color Merge(Run& run) const;
  static void ReportMerge(const Run& run, const Photon& photon, const Color& value, double weight);
  double CameraPerArea(const Ray& ray, float cosTheta, double distanceSquared) const;

  // Of a connection, before its shadow ray. Who observes paths is shown all of them.
  float WorthOf(const Run& run, const ConnectedPath& path, uint64_t decider) const {
    if (run.sinks.observer) return 1;
    return settings_.shadowRays.Worth(path.value * static_cast<float>(path.weight), run.gathered, decider);
  }
  // The camera's end of a path with a camera subpath.
  static void SetLens(const Run& run, ConnectedPath& path) {
    path.toLens = run.paths.camera[0].toPrevious;
    path.cameraPerArea = run.paths.camera[0].pdfForward;
  }
  static Color Report(const Run& run, ConnectedPath& path) {
    if (run.sinks.observer) {
      path.mergesPerDensity = std::sqrt(run.merge);
      run.sinks.observer->Observe(path);
    }
    return path.value * static_cast<float>(path.weight);
  }
  // The same of a path that lands in the sample's own pixel.
  Color Found(const Run& run, ConnectedPath& path, float worth = 1) const {
    const Color contribution = Report(run, path) * worth;
    if (run.sinks.layers) run.sinks.layers->Add(lighting_.GroupOf(path.end.light), contribution);
    return contribution;
  }
  void Splat(const Run& run, ConnectedPath& path) const {
    AddSplats(*path.connection, Report(run, path), lighting_.GroupOf(path.end.light), run.sinks.splats, run.Counts());
  }

  const RenderScene& scene_;
  const GeometryScene& geometry_;
  const LightingServices& lighting_;
  BdptSettings settings_;
  LightSubpathTracer light_;
  bool connectsByDirection_;
};

// Density (area) of the vertex that a camera ray sees, over that of the lens point alone: what t = 2 has and t = 1 has
// not.
double BdptIntegrator::CameraPerArea(const Ray& ray, float cosTheta, double distanceSquared) const {
  Point2 film;
  const auto densities = scene_.camera->EvaluateRay(ray, &film);
  if (!densities) return 0;
  if (connectsByDirection_) return static_cast<double>(densities->pdfPosition.value) * AreaPerSolidAngle(cosTheta, 1);
  return static_cast<double>(densities->pdfDirection.value) * AreaPerSolidAngle(cosTheta, distanceSquared);
}

// (1,1): a point of an area light.
void BdptIntegrator::SeeLightPoint(Run& run, const EmittedPhoton& photon) const {
  const auto seen = SeeLight(scene_, photon, run.time, kOfLight.Of(0, dimensions::kRoulette), run.sampler,
                             run.sinks.splats, run.Counts());
  if (!seen) return;
  ConnectedPath path;
  path.s = 1;
  path.t = 1;
  path.end.light = photon.light;
  path.end.position =
      static_cast<double>(photon.emissionSelection.value) * static_cast<double>(photon.emission.pdfEmit.value);
  path.end.canBeHit = true;
  path.cameraPerArea =
      static_cast<double>(seen->connection.Weight()) * AreaPerSolidAngle(seen->cosTheta, 1) / settings_.filmPixels;
  path.connection = &seen->connection;
  path.value = seen->value;
  path.weight = 1 / (1 + Mis(path.cameraPerArea / path.end.position));
  Splat(run, path);
}

// (s,1): the last vertex of the light subpath, seen by the camera.
void BdptIntegrator::SeeLightVertex(Run& run) const {
  const LightSubpath& light = run.paths.light;
  const PathVertex& vertex = light.Last();
  const uint32_t lens = kOfLight.Of(static_cast<int>(light.count), dimensions::kLight);
  const auto seen = SeeVertex(scene_, vertex, run.time, lens, run.sampler, run.sinks.splats, run.Counts());
  if (!seen) return;
  ConnectedPath path;
  path.s = static_cast<int>(light.count) + 1;
  path.t = 1;
  path.light = run.Light(light.count);
  path.end = light.end;
  path.toLight = light.vertices[0].toPrevious;
  path.toLens = seen->toCamera;
  path.cameraPerArea =
      static_cast<double>(seen->connection.Weight()) * AreaPerSolidAngle(seen->cosTheta, 1) / settings_.filmPixels;
  path.connection = &seen->connection;
  path.value = seen->value;
  const double reverse = static_cast<double>(seen->f.pdfReverse.value) * vertex.previousPerSolidAngle;
  path.weight = 1 / (1 + vertex.weight.Sum(path.cameraPerArea, reverse, run.MergeAt(vertex)));
  Splat(run, path);
}

// s = 0: the camera subpath has found a light. `landing` is that of an emission at its last vertex.
Color BdptIntegrator::HitLight(Run& run, const Flight& flight, const FoundLight& found, double landing) const {
  const LightEvaluation& e = found.evaluation;
  ConnectedPath path;
  path.value = flight.diffuse * e.diffuse + flight.specular * e.specular;
  if (path.value.IsBlack()) return path.value;
  const PathVertex& last = run.paths.camera[run.cameraCount - 1];
  path.s = 0;
  path.t = static_cast<int>(run.cameraCount) + 2;
  path.camera = run.Camera(run.cameraCount);
  path.end = EndOf(lighting_, found, true, landing);
  if (!settings_.connects && path.end.emission > 0) {
    if (run.couldMerge) return Color(0.0f);
    return Found(run, path);
  }
  path.toLight = flight.ray.direction;
  SetLens(run, path);
  const double pdf = flight.pdf * path.end.perSolidAngle;
  const PartialWeight atLight =
      last.weight.Next(last.scatteredDelta, last.CanMerge(), 1, last.eventReverse * last.previousPerSolidAngle);
  const double earlier = atLight.earlier + run.merge * atLight.merging;
  const double direct = last.scatteredDelta ? 0.0 : Mis(path.end.direct);
  path.weight = 1 / (1 + (direct + Mis(path.end.emission) * earlier) / Mis(pdf));
  return Found(run, path);
}

// s = 1: next-event estimation at the camera subpath's last vertex.
Color BdptIntegrator::SampleLights(Run& run) const {
  const auto index = static_cast<int>(run.cameraCount) - 1;
  run.sampler.SetDimension(kOfCamera.Of(index, dimensions::kLightSelection));
  LightChoices lights;
  lighting_.SelectLights(run.paths.camera[run.cameraCount - 1].receiver, run.sampler.Get1D(), lights);
  const Point2 u = run.sampler.Get2D();
  Color sum;
  for (int i = 0; i < lights.count; ++i) sum += SampleLight(run, lights.of[i], MovedPoint(u, i));
  return sum;
}

Color BdptIntegrator::SampleLight(Run& run, const SelectedLight& light, const Point2& u) const {
  const PathVertex& vertex = run.paths.camera[run.cameraCount - 1];
  if (!settings_.connects && !lighting_.EmissionSelectionProbability(light.light).IsZero()) return Color(0.0f);
  const DirectSample direct = lighting_.GenerateSamples(vertex.receiver, light, u, run.time, true);
  const auto nothingArrives = [&] {
    lighting_.UpdateWithResults(vertex.receiver, direct, Color(0.0f));
    return Color(0.0f);
  };
  if (!direct) return nothingArrives();
  const LightSample& sample = *direct.sample;
  const BsdfEvaluation f = vertex.bsdf.Evaluate(vertex.toPrevious, sample.direction, TransportMode::Radiance);
  const Color scattered = f.diffuse * sample.diffuse + f.specular * sample.specular;
  if (scattered.IsBlack()) return nothingArrives();
  const float cosTheta = AbsDot(sample.direction, vertex.bsdf.ShadingFrame().z);
  const PdfSolidAngle pdf = direct.selection * sample.pdfDirect;
  ConnectedPath path;
  path.value = (vertex.diffuse + vertex.specular) * scattered * (cosTheta / pdf.value);
  if (path.value.IsBlack()) return path.value;
  path.s = 1;
  path.t = static_cast<int>(run.cameraCount) + 1;
  path.camera = run.Camera(run.cameraCount);
  FoundLight found;
  found.light = direct.light;
  found.selection = direct.selection;
  found.evaluation.pdfDirect = sample.pdfDirect;
  found.evaluation.pdfEmit = sample.pdfEmit;
  found.evaluation.pdfEmitDirection = sample.pdfEmitDirection;
  found.evaluation.solidAngleToArea = sample.solidAngleToArea;
  const double squared = Sqr(static_cast<double>(sample.distance));
  path.end = EndOf(lighting_, found, !direct.isDelta && lighting_.CanBeHit(direct.light),
                   LandingFactor(lighting_, direct.light, CosineAt(vertex, sample.direction), squared));
  path.toLight = sample.direction;
  SetLens(run, path);
  const double hit = path.end.canBeHit ? Mis(static_cast<double>(f.pdfForward.value) * path.end.perSolidAngle) : 0.0;
  const double camera = vertex.weight.Sum(
      path.end.emission, static_cast<double>(f.pdfReverse.value) * vertex.previousPerSolidAngle, run.MergeAt(vertex));
  path.weight = 1 / (1 + (hit + camera) / Mis(path.end.direct));
  const float worth = WorthOf(run, path, ShadowRays::DeciderOf(u.x, u.y));
  if (worth == 0) return Color(0.0f);
  ++run.Counts().shadowRays;
  const Color arrived = lighting_.Transmission(vertex.point, direct, run.time);
  lighting_.UpdateWithResults(vertex.receiver, direct, arrived);
  path.value *= arrived;
  if (path.value.IsBlack()) return path.value;
  return Found(run, path, worth);
}

// s > 1, t > 1: the first `lightCount` vertices of the light subpath, joined to the camera subpath's last.
Color BdptIntegrator::Connect(Run& run, size_t lightCount) const {
  const PathVertex &y = run.paths.light.vertices[lightCount - 1], &z = run.paths.camera[run.cameraCount - 1];
  if (y.isDelta) return Color(0.0f);
  const Vector3d difference = Vector3d(z.point.position) - Vector3d(y.point.position);
  const double squared = LengthSquared(difference);
  if (!(squared > 0)) return Color(0.0f);
  const Vector3 toCamera(difference / std::sqrt(squared));
  const BsdfEvaluation fy = y.bsdf.Evaluate(y.toPrevious, toCamera, TransportMode::Importance);
  const Color leaving = y.diffuse * fy.diffuse + y.specular * fy.specular;
  if (leaving.IsBlack()) return leaving;
  const BsdfEvaluation fz = z.bsdf.Evaluate(z.toPrevious, -toCamera, TransportMode::Radiance);
  const float cosY = CosineAt(y, toCamera), cosZ = CosineAt(z, toCamera);
  const float arriving = AbsDot(toCamera, z.bsdf.ShadingFrame().z);
  ConnectedPath path;
  const double geometric =
      static_cast<double>(std::abs(cosY) * arriving * ArrivalCorrection(y.bsdf, y.toPrevious)) / squared;
  path.value =
      Product((z.diffuse + z.specular) * fz.Sum(), leaving, geometric * static_cast<double>(lighting_.FluxUnit()));
  if (path.value.IsBlack()) return path.value;
  path.s = static_cast<int>(lightCount) + 1;
  path.t = static_cast<int>(run.cameraCount) + 1;
  path.light = run.Light(lightCount);
  path.camera = run.Camera(run.cameraCount);
  path.end = run.paths.light.end;
  path.toLight = run.paths.light.vertices[0].toPrevious;
  SetLens(run, path);
  const double light = y.weight.Sum(static_cast<double>(fz.pdfForward.value) * AreaPerSolidAngle(cosY, squared),
                                    static_cast<double>(fy.pdfReverse.value) * y.previousPerSolidAngle, run.MergeAt(y));
  const double camera =
      z.weight.Sum(static_cast<double>(fy.pdfForward.value) * AreaPerSolidAngle(cosZ, squared),
                   static_cast<double>(fz.pdfReverse.value) * z.previousPerSolidAngle, run.MergeAt(z));
  path.weight = 1 / (1 + light + camera);
  const float worth = WorthOf(run, path, ShadowRays::DeciderOf(toCamera.x, toCamera.y));
  if (worth == 0) return Color(0.0f);
  ++run.Counts().shadowRays;
  const Ray ray = SpawnRayTo(z.point, y.point.position, y.point.positionError, y.point.Ng, run.time);
  path.value *= geometry_.Transmission(ray, visibility::kIndirect);
  if (path.value.IsBlack()) return path.value;
  return Found(run, path, worth);
}

void BdptIntegrator::ReportMerge(const Run& run, const Photon& photon, const Color& value, double weight) {
  ConnectedPath path;
  path.isMerged = true;
  path.s = static_cast<int>(photon.depth) + 1;
  path.t = static_cast<int>(run.cameraCount) + 1;
  path.camera = run.Camera(run.cameraCount);
  path.toLight = photon.toPrevious;
  SetLens(run, path);
  path.mergesPerDensity = std::sqrt(run.merge);
  path.value = value;
  path.weight = weight;
  run.sinks.observer->ObserveMerge(path, photon);
}

// Photons of the last pass's light paths near the camera subpath's last vertex: each could have been its next step to
// the light ([Georgiev12 §3]).
Color BdptIntegrator::Merge(Run& run) const {
  const PhotonPass& pass = *run.sinks.gather;
  const PathVertex& vertex = run.paths.camera[run.cameraCount - 1];
  const auto most = static_cast<size_t>(settings_.maxDepth) + 1;
  const double perMerge = 1 / run.merge;
  const double perDensity = static_cast<double>(lighting_.FluxUnit()) / std::sqrt(run.merge);
  const std::span<const uint32_t> found =
      FindPhotons(*pass.map, vertex.point.position, pass.radius, run.paths.lookup, run.Counts());
  Color sum;
  for (const uint32_t index : found) {
    const Photon& photon = (*pass.map)[index];
    if (photon.depth + run.cameraCount > most || !photon.IsOnSurface(vertex.bsdf.Ng())) continue;
    const Vector3& toLight = photon.toPrevious;
    const BsdfEvaluation f = vertex.bsdf.Evaluate(vertex.toPrevious, toLight, TransportMode::Radiance);
    const Color scattered = f.diffuse * photon.flux + f.specular * pass.map->SpecularFlux(photon);
    if (scattered.IsBlack()) continue;
    const double light = photon.BeforeReverse(static_cast<double>(f.pdfForward.value));
    const double camera =
        vertex.weight.BeforeReverse(static_cast<double>(f.pdfReverse.value) * vertex.previousPerSolidAngle, run.merge);
    const double weight = 1 / (1 + (light + camera) * perMerge);
    const Color value = scattered * ArrivalCorrection(vertex.bsdf, toLight);
    sum += value * static_cast<float>(weight);
    // In another order: a product that both share would not be rounded as it is where nobody wants layers.
    if (run.sinks.layers) [[unlikely]] {
      run.sinks.layers->Add(photon.group, Product(vertex.diffuse + vertex.specular, value, perDensity * weight));
    }
    if (pass.use) [[unlikely]] {
      const Color part = (vertex.diffuse + vertex.specular) * f.Sum();
      pass.use->Add(index, part.Average() * static_cast<float>(weight));
    }
    if (run.sinks.observer) [[unlikely]]
      ReportMerge(run, photon, Product(vertex.diffuse + vertex.specular, value, perDensity), weight);
  }
  return Product(vertex.diffuse + vertex.specular, sum, perDensity);
}

Color BdptIntegrator::TraceCamera(Run& run, const Ray& cameraRay) const {
  Flight flight;
  flight.ray = cameraRay;
  flight.specular = Color(1.0f);
  Color radiance;
  for (;;) {
    CheckStop();
    const bool isFirst = run.cameraCount == 0;
    ++(isFirst ? run.Counts().cameraRays : run.Counts().indirectRays);
    RayHit hit;
    Color passed;
    const bool isHit =
        geometry_.Intersect(flight.ray, isFirst ? visibility::kCamera : visibility::kIndirect, hit, passed);
    flight.diffuse *= passed;
    flight.specular *= passed;
    if (!isHit) {
      if (isFirst) return Background(run, flight);
      const PathVertex& last = run.paths.camera[run.cameraCount - 1];
      for (size_t i = 0; i < lighting_.InfiniteCount(); ++i) {
        const auto found = lighting_.EvaluateEscaped(i, last.receiver, flight.ray.direction, run.time, true);
        if (!found) continue;
        const double landing = LandingFactor(lighting_, found->light, CosineAt(last, flight.ray.direction), 1);
        radiance += HitLight(run, flight, *found, landing);
      }
      return radiance;
    }
    const SurfacePoint point = geometry_.GetSurfacePoint(flight.ray, hit);
    if (geometry_.Attributes(hit.primitive).light >= 0) {
      if (isFirst) {
        radiance += SeenLight(run, flight, hit, point);
      } else {
        const PathVertex& last = run.paths.camera[run.cameraCount - 1];
        const float distance = glm::distance(point.position, last.point.position);
        const auto found =
            lighting_.EvaluateSamples(last.receiver, flight.ray.direction, distance, point, run.time, true);
        if (found) {
          const double landing = LandingFactor(lighting_, found->light, CosineAt(last, flight.ray.direction),
                                               Sqr(static_cast<double>(distance)));
          radiance += HitLight(run, flight, *found, landing);
        }
      }
    }
    if (run.cameraCount >= static_cast<size_t>(settings_.maxDepth)) return radiance;
    PathVertex& vertex = PlaceOf(run.paths.camera, run.cameraCount);
    if (!MakeVertex(scene_, flight.ray, hit, point, vertex)) return radiance;
    vertex.diffuse = flight.diffuse;
    vertex.specular = flight.specular;
    if (isFirst) {
      vertex.pdfForward =
          CameraPerArea(flight.ray, CosineAt(vertex, vertex.toPrevious), Sqr(static_cast<double>(hit.t)));
      vertex.previousPerSolidAngle = 0;  // the lens is not hit
      // Light paths come here but where they pass through.
      const bool isSplatted = vertex.pdfForward > 0 && vertex.isSeenByIndirect;
      vertex.weight = {isSplatted && settings_.connects ? 1 / Mis(vertex.pdfForward) : 0.0, 0.0, 0.0};
    } else {
      Follow(run.paths.camera[run.cameraCount - 1], flight, settings_.connects, vertex);
    }
    ++run.cameraCount;
    const auto depth = static_cast<int>(run.cameraCount);
    if (!vertex.isDelta) {
      run.gathered = radiance;
      radiance += SampleLights(run);
      // As many scattering events in all as are wanted.
      const size_t most = std::min(run.paths.light.count, static_cast<size_t>(settings_.maxDepth - depth));
      for (size_t i = 1; settings_.connects && i <= most; ++i) {
        CheckStop();
        run.gathered = radiance;
        radiance += Connect(run, i);
      }
      if (run.merge > 0 && vertex.CanMerge()) radiance += Merge(run);
    }
    if (!Scatter(vertex, TransportMode::Radiance, depth, kOfCamera, depth - 1, 1, run.sampler, flight)) {
      return radiance;
    }
    run.couldMerge = run.couldMerge || (vertex.CanMerge() && !vertex.scatteredDelta);
  }
}

// (0,2) as well: nothing else finds a light at infinity that the camera looks at.
Color BdptIntegrator::Background(const Run& run, const Flight& flight) const {
  ConnectedPath path;
  path.t = 2;
  path.end.canBeHit = true;
  path.cameraPerArea = 1;
  path.value = EscapedEmissionForCamera(lighting_, flight.ray, flight.specular, run.sinks.layers);
  return Report(run, path);
}

// (0,2): the camera looks at an area light, which (1,1) finds too.
Color BdptIntegrator::SeenLight(Run& run, const Flight& flight, const RayHit& hit, const SurfacePoint& point) const {
  const Ray& ray = flight.ray;
  ConnectedPath path;
  path.value = flight.specular * lighting_.EmissionForCamera(ray.direction, hit.t, point, run.time);
  if (path.value.IsBlack()) return path.value;
  path.s = 0;
  path.t = 2;
  const Receiver lens{ray.origin, Normal3(0.0f), false, Receiver::kCamera};
  if (const auto found = lighting_.EvaluateSamples(lens, ray.direction, hit.t, point, run.time, true)) {
    path.end = EndOf(lighting_, *found, lighting_.CanBeHit(found->light), 0);
    path.cameraPerArea = CameraPerArea(ray, glm::dot(ray.direction, point.Ng), Sqr(static_cast<double>(hit.t)));
    if (path.cameraPerArea > 0 && settings_.connects)
      path.weight = 1 / (1 + Mis(path.end.position / path.cameraPerArea));
  }
  const Color contribution = Report(run, path);
  // Lights that are seen from one side only may have no density there, and no end of the path.
  if (run.sinks.layers) run.sinks.layers->Add(lighting_.GroupAt(point), contribution);
  return contribution;
}

// What becomes of a light subpath on its way.
struct BdptIntegrator::LightVisitor final : LightSubpathVisitor {
  LightVisitor(const BdptIntegrator& integrator, Run& aRun) : own(integrator), run(aRun) {}
  void Emitted(const EmittedPhoton& photon) override {
    if (own.settings_.connects && !run.sinks.isForPhotonsAlone) own.SeeLightPoint(run, photon);
  }
  void Landed(const EmittedPhoton& photon, const PathVertex& first) override {
    if (run.sinks.withOrigin) run.sinks.photons->SetOrigin(OriginOf(own.lighting_, photon, first));
  }
  void Arrived(const LightSubpath& path) override {
    const PathVertex& vertex = path.Last();
    if (own.settings_.connects && !run.sinks.isForPhotonsAlone) own.SeeLightVertex(run);
    if (run.sinks.photons && vertex.storesPhotons)
      run.sinks.photons->Add(vertex, path.count, own.lighting_.GroupOf(path.light));
  }

  const BdptIntegrator& own;
  Run& run;
};

Color BdptIntegrator::Sample(const Ray* ray, float time, Sampler& sampler, const SampleSinks& sinks) const {
  thread_local Workspace workspace;
  Run run{workspace, sampler, sinks, time};
  if (sinks.gather) run.merge = Mis(sinks.gather->MergesPerDensity());
  workspace.light.count = 0;
  if (settings_.connects || sinks.photons) {
    LightVisitor visitor(*this, run);
    light_.Trace(time, sampler, sinks.counts, workspace.light, visitor);
  }
  return ray ? TraceCamera(run, *ray) : Color(0.0f);
}

}  // namespace

std::unique_ptr<BidirectionalIntegrator> MakeBdptIntegrator(const RenderScene& scene, const BdptSettings& settings) {
  return std::make_unique<BdptIntegrator>(scene, settings);
}

}  // namespace lampyr
