#include "integrators/bdpt/bdpt_integrator.h"

#include "integrators/common/adjoint.h"
#include "integrators/common/camera_connection.h"
#include "integrators/common/roulette.h"

namespace lampyr {

namespace {

// The two paths take turns in the sampler's dimensions, so that neither runs into the other.
constexpr uint32_t CameraDimension(int vertex, uint32_t which) {
  return dimensions::OfVertex(2 * vertex, which);
}
constexpr uint32_t LightDimension(int vertex, uint32_t which) {
  return dimensions::OfVertex(2 * vertex + 1, which);
}

// Vertices of one path each, reused from sample to sample.
struct Workspace {
  std::vector<PathVertex> light, camera;
};

// The place of vertex `index`, made where there is none yet: other vertices may move.
PathVertex& PlaceOf(std::vector<PathVertex>& vertices, size_t index) {
  if (index >= vertices.size()) vertices.resize(std::max<size_t>(8, 2 * index));
  return vertices[index];
}

// A ray on its way to the next vertex, and what it carries.
struct Flight {
  Ray ray;
  Color diffuse, specular;
  double pdf = 0;  // 1/sr at the last vertex
  float etaScale = 1;
};

class BdptIntegrator final : public BidirectionalIntegrator {
 public:
  BdptIntegrator(const RenderScene& scene, const BdptSettings& settings)
      : geometry_(*scene.geometry),
        lighting_(*scene.lighting),
        camera_(*scene.camera),
        materials_(scene.materials),
        settings_(settings),
        connectsByDirection_(scene.camera->ConnectsByDirection()) {}

  Color Sample(const Ray* ray, float time, Sampler& sampler, SplatList& splats, RenderCounts& counts,
               PathObserver* observer) const override;

 private:
  // One sample's state: both subpaths, where it draws from and what it adds to.
  struct Run {
    Workspace& paths;
    Sampler& sampler;
    SplatList& splats;
    RenderCounts& counts;
    PathObserver* observer;
    float time;
    size_t lightCount = 0, cameraCount = 0;
    LightEnd end;  // of the light subpath

    std::span<const PathVertex> Light(size_t count) const { return {paths.light.data(), count}; }
    std::span<const PathVertex> Camera(size_t count) const { return {paths.camera.data(), count}; }
  };

  void TraceLight(Run& run) const;
  Color TraceCamera(Run& run, const Ray& ray) const;
  bool MakeVertex(const Ray& ray, const RayHit& hit, const SurfacePoint& point, PathVertex& vertex) const;
  bool Scatter(PathVertex& vertex, TransportMode mode, int depth, uint32_t lobeDimension, uint32_t rouletteDimension,
               float scale, Sampler& sampler, Flight& flight) const;

  void ConnectLightToCamera(Run& run, const EmittedPhoton& photon) const;
  void ConnectToLens(Run& run, size_t count) const;
  Color HitLight(Run& run, const Flight& flight, const FoundLight& found, double landing) const;
  Color SeenLight(Run& run, const Ray& ray, const RayHit& hit, const SurfacePoint& point) const;
  Color Background(const Run& run, const Ray& ray) const;
  Color SampleLights(Run& run) const;
  Color SampleLight(Run& run, const SelectedLight& light, const Point2& u) const;
  Color Connect(Run& run, size_t lightCount) const;
  LightEnd EndOf(const FoundLight& found, bool canBeHit, double landing) const;
  double CameraPerArea(const Ray& ray, float cosTheta, double distanceSquared) const;
  double LandingFactor(uint32_t light, float cosTheta, double distanceSquared) const;

  // The camera's end of a path with a camera subpath.
  static void SetLens(const Run& run, ConnectedPath& path) {
    path.toLens = run.paths.camera[0].toPrevious;
    path.cameraPerArea = run.paths.camera[0].pdfForward;
  }
  static Color Report(const Run& run, const ConnectedPath& path) {
    if (run.observer) run.observer->Observe(path);
    return path.value * static_cast<float>(path.weight);
  }

  const GeometryScene& geometry_;
  const LightingServices& lighting_;
  const Camera& camera_;
  const std::vector<std::shared_ptr<const Material>>& materials_;
  BdptSettings settings_;
  bool connectsByDirection_;
};

float CosineAt(const PathVertex& vertex, const Vector3& direction) {
  return glm::dot(direction, vertex.bsdf.Ng());
}

// The densities and the weight of a vertex that its subpath found from the previous one.
void Follow(const PathVertex& previous, const Flight& flight, PathVertex& vertex) {
  const double squared = LengthSquared(Vector3d(vertex.point.position) - Vector3d(previous.point.position));
  vertex.pdfForward = flight.pdf * AreaPerSolidAngle(CosineAt(vertex, flight.ray.direction), squared);
  vertex.previousPerSolidAngle = AreaPerSolidAngle(CosineAt(previous, flight.ray.direction), squared);
  vertex.weight = previous.weight.Next(previous.scatteredDelta, vertex.pdfForward,
                                       previous.eventReverse * previous.previousPerSolidAngle);
}

// Density (area) of the vertex that a camera ray sees, over that of the lens point alone: what t = 2 has and t = 1 has
// not.
double BdptIntegrator::CameraPerArea(const Ray& ray, float cosTheta, double distanceSquared) const {
  Point2 film;
  const auto densities = camera_.EvaluateRay(ray, &film);
  if (!densities) return 0;
  if (connectsByDirection_) return static_cast<double>(densities->pdfPosition.value) * AreaPerSolidAngle(cosTheta, 1);
  return static_cast<double>(densities->pdfDirection.value) * AreaPerSolidAngle(cosTheta, distanceSquared);
}

// From the densities of an emission to area at the vertex where it lands.
double BdptIntegrator::LandingFactor(uint32_t light, float cosTheta, double distanceSquared) const {
  return AreaPerSolidAngle(cosTheta, lighting_.IsAtInfinity(light) ? 1 : distanceSquared);
}

LightEnd BdptIntegrator::EndOf(const FoundLight& found, bool canBeHit, double landing) const {
  const LightEvaluation& e = found.evaluation;
  LightEnd end;
  end.light = found.light;
  end.perSolidAngle = static_cast<double>(e.solidAngleToArea);
  end.direct = static_cast<double>(found.selection.value) * static_cast<double>(e.pdfDirect.value) * end.perSolidAngle;
  const double selection = static_cast<double>(lighting_.EmissionSelectionProbability(found.light).value);
  const double position = selection * static_cast<double>(e.pdfEmit.value);
  end.emission = position * static_cast<double>(e.pdfEmitDirection.value) * landing;
  end.canBeHit = canBeHit;
  if (canBeHit && !lighting_.IsAtInfinity(found.light)) end.position = position;
  return end;
}

// False: a black surface, where paths end.
bool BdptIntegrator::MakeVertex(const Ray& ray, const RayHit& hit, const SurfacePoint& point,
                                PathVertex& vertex) const {
  const GeometryAttributes& attributes = geometry_.Attributes(hit.primitive);
  const Material* material = attributes.material >= 0 ? materials_[attributes.material].get() : nullptr;
  if (!material) return false;
  vertex.point = point;
  vertex.toPrevious = -ray.direction;
  vertex.bsdf = material->GetBsdf(point, vertex.toPrevious);
  const Normal3 Ns = vertex.bsdf.ShadingFrame().z;
  vertex.receiver = {point.position, glm::dot(Ns, vertex.toPrevious) < 0 ? -Ns : Ns, vertex.bsdf.IsTransmissive()};
  vertex.isDelta = vertex.bsdf.IsDelta();
  vertex.isSeenByCamera = (attributes.visibility & visibility::kCamera) != 0;
  vertex.isSeenByIndirect = (attributes.visibility & visibility::kIndirect) != 0;
  return true;
}

// Chooses how the path goes on, with Russian roulette; `depth` is that of the vertex, 1 for the first.
bool BdptIntegrator::Scatter(PathVertex& vertex, TransportMode mode, int depth, uint32_t lobeDimension,
                             uint32_t rouletteDimension, float scale, Sampler& sampler, Flight& flight) const {
  const bool isLight = mode == TransportMode::Importance;
  const Vector3& wo = vertex.toPrevious;
  sampler.SetDimension(lobeDimension);
  const float uLobe = sampler.Get1D();
  const auto sample = vertex.bsdf.Sample(wo, uLobe, sampler.Get2D(), mode);
  if (!sample) return false;
  if (isLight) {
    const float correction = ArrivalCorrection(vertex.bsdf, wo) * DepartureCorrection(vertex.bsdf, sample->wi);
    flight.diffuse = (vertex.diffuse * sample->weightDiffuse + vertex.specular * sample->weightSpecular) * correction;
    flight.specular = flight.diffuse;  // both lobes see the same from now on
  } else {
    const Color throughput = vertex.diffuse + vertex.specular;
    flight.diffuse = throughput * sample->weightDiffuse;
    flight.specular = throughput * sample->weightSpecular;
    if (sample->isTransmission) flight.etaScale *= Sqr(sample->eta);
  }
  const Normal3& Ns = vertex.bsdf.ShadingFrame().z;
  const EventDensities densities = DensitiesOf(*sample, AbsDot(wo, Ns), AbsDot(sample->wi, Ns), mode);
  vertex.scatteredDelta = sample->isDelta;
  vertex.eventForward = densities.forward;
  vertex.eventReverse = densities.reverse;
  flight.pdf = densities.forward;
  if (!(flight.pdf > 0)) return false;
  flight.ray = SpawnRay(vertex.point, sample->wi, flight.ray.time);
  const Color carried = isLight ? flight.diffuse : flight.diffuse + flight.specular;
  const float survival = SurvivalProbability(carried / scale, isLight ? 1 : flight.etaScale, depth);
  if (survival < 1) {
    sampler.SetDimension(rouletteDimension);
    if (sampler.Get1D() >= survival) return false;
    flight.diffuse /= survival;
    flight.specular /= survival;
  }
  return true;
}

void BdptIntegrator::TraceLight(Run& run) const {
  Sampler& sampler = run.sampler;
  sampler.SetDimension(LightDimension(0, dimensions::kLightSelection));
  const float uSelect = sampler.Get1D();
  const Point2 u = sampler.Get2D();
  sampler.SetDimension(LightDimension(0, dimensions::kDirection));
  const std::optional<EmittedPhoton> photon = lighting_.GenerateEmission(uSelect, u, sampler.Get2D(), run.time);
  if (!photon) return;
  if (photon->fromSurface) ConnectLightToCamera(run, *photon);
  if (photon->IsDark()) return;
  ++run.counts.indirectRays;
  const EmissionSample& emission = photon->emission;
  const double density = static_cast<double>(emission.pdfEmit.value) *
                         static_cast<double>(emission.pdfEmitDirection.value) *
                         static_cast<double>(photon->emissionSelection.value);
  const auto inverse = static_cast<float>(static_cast<double>(emission.emissionCosine) / density);
  Flight flight;
  flight.ray = photon->ray;
  flight.diffuse = emission.diffuse * inverse;
  flight.specular = emission.specular * inverse;
  const float emitted = std::max(flight.diffuse.Max(), flight.specular.Max());
  if (!(emitted > 0)) return;  // less than a float can say

  std::optional<RayHit> hit = photon->landing;
  while (hit && run.lightCount < static_cast<size_t>(settings_.maxDepth)) {
    const SurfacePoint point = geometry_.GetSurfacePoint(flight.ray, *hit);
    PathVertex& vertex = PlaceOf(run.paths.light, run.lightCount);
    if (!MakeVertex(flight.ray, *hit, point, vertex)) return;
    vertex.diffuse = flight.diffuse;
    vertex.specular = flight.specular;
    if (run.lightCount == 0) {
      const std::optional<FoundLight> found = lighting_.EvaluateLanding(*photon, vertex.receiver);
      if (!found) return;
      const double squared = LengthSquared(Vector3d(point.position) - Vector3d(emission.position));
      run.end = EndOf(*found, lighting_.CanBeHit(found->light),
                      LandingFactor(found->light, CosineAt(vertex, vertex.toPrevious), squared));
      if (!(run.end.emission > 0)) return;
      vertex.pdfForward = run.end.emission;
      vertex.previousPerSolidAngle = run.end.perSolidAngle;
      const double perEmission = 1 / Mis(run.end.emission);
      vertex.weight = {Mis(run.end.direct) * perEmission, run.end.canBeHit ? perEmission : 0.0};
    } else {
      Follow(run.paths.light[run.lightCount - 1], flight, vertex);
    }
    ++run.lightCount;
    const auto depth = static_cast<int>(run.lightCount);
    if (vertex.isSeenByCamera && !vertex.isDelta) ConnectToLens(run, run.lightCount);
    if (depth >= settings_.maxDepth ||
        !Scatter(vertex, TransportMode::Importance, depth, LightDimension(depth, dimensions::kLobe),
                 LightDimension(depth, dimensions::kRoulette), emitted, sampler, flight)) {
      return;
    }
    ++run.counts.indirectRays;
    RayHit next;
    if (!geometry_.Intersect(flight.ray, visibility::kIndirect, next)) return;
    hit = next;
  }
}

// (1,1): a point of an area light as the camera sees it. The ray goes from the camera, so that cut-outs and what is
// invisible to cameras are met as any camera ray meets them.
void BdptIntegrator::ConnectLightToCamera(Run& run, const EmittedPhoton& photon) const {
  const auto connection = ConnectToCamera(camera_, photon.emission.position, LightDimension(0, dimensions::kRoulette),
                                          run.sampler, run.splats);
  if (!connection) return;
  const Vector3 fromLens = photon.emission.position - connection->camera.position;
  const float distance = glm::length(fromLens);
  if (!(distance > 0)) return;
  const Ray ray{connection->camera.position, fromLens / distance, kInfinity, run.time};
  ++run.counts.cameraRays;
  RayHit hit;
  if (!geometry_.Intersect(ray, visibility::kCamera, hit)) return;
  const SurfacePoint point = geometry_.GetSurfacePoint(ray, hit);
  if (!lighting_.IsOrigin(photon, point, -ray.direction, distance)) return;
  const Color radiance = lighting_.EmissionForCamera(ray.direction, hit.t, point, run.time);
  if (radiance.IsBlack()) return;
  const double density =
      static_cast<double>(photon.emissionSelection.value) * static_cast<double>(photon.emission.pdfEmit.value);
  const float cosTheta = AbsDot(ray.direction, photon.emission.normal);
  ConnectedPath path;
  path.s = 1;
  path.t = 1;
  path.end.light = photon.light;
  path.end.position = density;
  path.end.canBeHit = true;
  path.cameraPerArea =
      static_cast<double>(connection->Weight()) * AreaPerSolidAngle(cosTheta, 1) / settings_.filmPixels;
  path.connection = &*connection;
  path.value = radiance * static_cast<float>(static_cast<double>(cosTheta * connection->Weight()) / density);
  path.weight = 1 / (1 + Mis(path.cameraPerArea / density));
  AddSplats(*connection, Report(run, path), run.splats, run.counts);
}

// (s,1): the last vertex of the light subpath, seen by the camera.
void BdptIntegrator::ConnectToLens(Run& run, size_t count) const {
  const PathVertex& vertex = run.paths.light[count - 1];
  const uint32_t lens = LightDimension(static_cast<int>(count), dimensions::kLight);
  const auto connection = ConnectToCamera(camera_, vertex.point.position, lens, run.sampler, run.splats);
  if (!connection) return;
  const Vector3 difference = connection->camera.position - vertex.point.position;
  const float squared = LengthSquared(difference);
  if (!(squared > 0)) return;
  const Vector3 toCamera = difference / std::sqrt(squared), &toLight = vertex.toPrevious;
  const BsdfEvaluation f = vertex.bsdf.Evaluate(toLight, toCamera, TransportMode::Importance);
  const Color scattered = vertex.diffuse * f.diffuse + vertex.specular * f.specular;
  if (scattered.IsBlack()) return;
  const float cosTheta = CosineAt(vertex, toCamera);
  ++run.counts.shadowRays;
  const Ray ray = SpawnRayTo(vertex.point, connection->camera.position, Vector3(0.0f), Normal3(0.0f), run.time);
  if (geometry_.Occluded(ray, visibility::kCamera)) return;
  ConnectedPath path;
  path.s = static_cast<int>(count) + 1;
  path.t = 1;
  path.light = run.Light(count);
  path.end = run.end;
  path.toLight = run.paths.light[0].toPrevious;
  path.toLens = toCamera;
  path.cameraPerArea =
      static_cast<double>(connection->Weight()) * AreaPerSolidAngle(cosTheta, 1) / settings_.filmPixels;
  path.connection = &*connection;
  path.value = scattered * (std::abs(cosTheta) * ArrivalCorrection(vertex.bsdf, toLight) * connection->Weight());
  path.weight = 1 / (1 + vertex.weight.Sum(path.cameraPerArea,
                                           static_cast<double>(f.pdfReverse.value) * vertex.previousPerSolidAngle));
  AddSplats(*connection, Report(run, path), run.splats, run.counts);
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
  path.end = EndOf(found, true, landing);
  path.toLight = flight.ray.direction;
  SetLens(run, path);
  const double pdf = flight.pdf * path.end.perSolidAngle;
  const double earlier =
      last.weight.Next(last.scatteredDelta, 1, last.eventReverse * last.previousPerSolidAngle).earlier;
  const double direct = last.scatteredDelta ? 0.0 : Mis(path.end.direct);
  path.weight = 1 / (1 + (direct + Mis(path.end.emission) * earlier) / Mis(pdf));
  return Report(run, path);
}

// s = 1: next-event estimation at the camera subpath's last vertex.
Color BdptIntegrator::SampleLights(Run& run) const {
  const auto index = static_cast<int>(run.cameraCount) - 1;
  run.sampler.SetDimension(CameraDimension(index, dimensions::kLightSelection));
  LightChoices lights;
  lighting_.SelectLights(run.paths.camera[run.cameraCount - 1].receiver, run.sampler.Get1D(), lights);
  const Point2 u = run.sampler.Get2D();
  Color sum;
  for (int i = 0; i < lights.count; ++i) sum += SampleLight(run, lights.of[i], MovedPoint(u, i));
  return sum;
}

Color BdptIntegrator::SampleLight(Run& run, const SelectedLight& light, const Point2& u) const {
  const PathVertex& vertex = run.paths.camera[run.cameraCount - 1];
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
  ++run.counts.shadowRays;
  const Color arrived = lighting_.Transmission(vertex.point, direct, run.time);
  lighting_.UpdateWithResults(vertex.receiver, direct, arrived);
  path.value *= arrived;
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
  path.end = EndOf(found, !direct.isDelta && lighting_.CanBeHit(direct.light),
                   LandingFactor(direct.light, CosineAt(vertex, sample.direction), squared));
  path.toLight = sample.direction;
  SetLens(run, path);
  const double hit = path.end.canBeHit ? Mis(static_cast<double>(f.pdfForward.value) * path.end.perSolidAngle) : 0.0;
  const double camera =
      vertex.weight.Sum(path.end.emission, static_cast<double>(f.pdfReverse.value) * vertex.previousPerSolidAngle);
  path.weight = 1 / (1 + (hit + camera) / Mis(path.end.direct));
  return Report(run, path);
}

// s > 1, t > 1: the first `lightCount` vertices of the light subpath, joined to the camera subpath's last.
Color BdptIntegrator::Connect(Run& run, size_t lightCount) const {
  const PathVertex &y = run.paths.light[lightCount - 1], &z = run.paths.camera[run.cameraCount - 1];
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
  path.value = (z.diffuse + z.specular) * fz.Sum() * leaving *
               static_cast<float>(
                   static_cast<double>(std::abs(cosY) * arriving * ArrivalCorrection(y.bsdf, y.toPrevious)) / squared);
  if (path.value.IsBlack()) return path.value;
  ++run.counts.shadowRays;
  const Ray ray = SpawnRayTo(z.point, y.point.position, y.point.positionError, y.point.Ng, run.time);
  if (geometry_.Occluded(ray, visibility::kIndirect)) return Color(0.0f);

  path.s = static_cast<int>(lightCount) + 1;
  path.t = static_cast<int>(run.cameraCount) + 1;
  path.light = run.Light(lightCount);
  path.camera = run.Camera(run.cameraCount);
  path.end = run.end;
  path.toLight = run.paths.light[0].toPrevious;
  SetLens(run, path);
  const double light = y.weight.Sum(static_cast<double>(fz.pdfForward.value) * AreaPerSolidAngle(cosY, squared),
                                    static_cast<double>(fy.pdfReverse.value) * y.previousPerSolidAngle);
  const double camera = z.weight.Sum(static_cast<double>(fy.pdfForward.value) * AreaPerSolidAngle(cosZ, squared),
                                     static_cast<double>(fz.pdfReverse.value) * z.previousPerSolidAngle);
  path.weight = 1 / (1 + light + camera);
  return Report(run, path);
}

Color BdptIntegrator::TraceCamera(Run& run, const Ray& cameraRay) const {
  Flight flight;
  flight.ray = cameraRay;
  flight.specular = Color(1.0f);
  Color radiance;
  for (;;) {
    const bool isFirst = run.cameraCount == 0;
    ++(isFirst ? run.counts.cameraRays : run.counts.indirectRays);
    RayHit hit;
    if (!geometry_.Intersect(flight.ray, isFirst ? visibility::kCamera : visibility::kIndirect, hit)) {
      if (isFirst) return Background(run, flight.ray);
      const PathVertex& last = run.paths.camera[run.cameraCount - 1];
      for (size_t i = 0; i < lighting_.InfiniteCount(); ++i) {
        const auto found = lighting_.EvaluateEscaped(i, last.receiver, flight.ray.direction, run.time, true);
        if (!found) continue;
        const double landing = LandingFactor(found->light, CosineAt(last, flight.ray.direction), 1);
        radiance += HitLight(run, flight, *found, landing);
      }
      return radiance;
    }
    const SurfacePoint point = geometry_.GetSurfacePoint(flight.ray, hit);
    if (geometry_.Attributes(hit.primitive).light >= 0) {
      if (isFirst) {
        radiance += SeenLight(run, flight.ray, hit, point);
      } else {
        const PathVertex& last = run.paths.camera[run.cameraCount - 1];
        const float distance = glm::distance(point.position, last.point.position);
        const auto found =
            lighting_.EvaluateSamples(last.receiver, flight.ray.direction, distance, point, run.time, true);
        if (found) {
          const double landing =
              LandingFactor(found->light, CosineAt(last, flight.ray.direction), Sqr(static_cast<double>(distance)));
          radiance += HitLight(run, flight, *found, landing);
        }
      }
    }
    if (run.cameraCount >= static_cast<size_t>(settings_.maxDepth)) return radiance;
    PathVertex& vertex = PlaceOf(run.paths.camera, run.cameraCount);
    if (!MakeVertex(flight.ray, hit, point, vertex)) return radiance;
    vertex.diffuse = flight.diffuse;
    vertex.specular = flight.specular;
    if (isFirst) {
      vertex.pdfForward =
          CameraPerArea(flight.ray, CosineAt(vertex, vertex.toPrevious), Sqr(static_cast<double>(hit.t)));
      vertex.previousPerSolidAngle = 0;  // the lens is not hit
      // Light paths come here but where they pass through.
      const bool isSplatted = vertex.pdfForward > 0 && vertex.isSeenByIndirect;
      vertex.weight = {isSplatted ? 1 / Mis(vertex.pdfForward) : 0.0, 0.0};
    } else {
      Follow(run.paths.camera[run.cameraCount - 1], flight, vertex);
    }
    ++run.cameraCount;
    const auto depth = static_cast<int>(run.cameraCount);
    if (!vertex.isDelta) {
      radiance += SampleLights(run);
      // As many scattering events in all as are wanted.
      const size_t most = std::min(run.lightCount, static_cast<size_t>(settings_.maxDepth - depth));
      for (size_t i = 1; i <= most; ++i) radiance += Connect(run, i);
    }
    if (!Scatter(vertex, TransportMode::Radiance, depth, CameraDimension(depth - 1, dimensions::kLobe),
                 CameraDimension(depth - 1, dimensions::kRoulette), 1, run.sampler, flight)) {
      return radiance;
    }
  }
}

// (0,2) as well: nothing else finds a light at infinity that the camera looks at.
Color BdptIntegrator::Background(const Run& run, const Ray& ray) const {
  ConnectedPath path;
  path.t = 2;
  path.end.canBeHit = true;
  path.cameraPerArea = 1;
  path.value = lighting_.EscapedEmissionForCamera(ray);
  return Report(run, path);
}

// (0,2): the camera looks at an area light, which (1,1) finds too.
Color BdptIntegrator::SeenLight(Run& run, const Ray& ray, const RayHit& hit, const SurfacePoint& point) const {
  ConnectedPath path;
  path.value = lighting_.EmissionForCamera(ray.direction, hit.t, point, run.time);
  if (path.value.IsBlack()) return path.value;
  path.s = 0;
  path.t = 2;
  const Receiver lens{ray.origin, Normal3(0.0f), false};
  if (const auto found = lighting_.EvaluateSamples(lens, ray.direction, hit.t, point, run.time, true)) {
    path.end = EndOf(*found, lighting_.CanBeHit(found->light), 0);
    path.cameraPerArea = CameraPerArea(ray, glm::dot(ray.direction, point.Ng), Sqr(static_cast<double>(hit.t)));
    if (path.cameraPerArea > 0) path.weight = 1 / (1 + Mis(path.end.position / path.cameraPerArea));
  }
  return Report(run, path);
}

Color BdptIntegrator::Sample(const Ray* ray, float time, Sampler& sampler, SplatList& splats, RenderCounts& counts,
                             PathObserver* observer) const {
  // Kept by the thread: vertices are large, and samples many.
  thread_local Workspace workspace;
  Run run{workspace, sampler, splats, counts, observer, time, 0, 0, {}};
  TraceLight(run);
  return ray ? TraceCamera(run, *ray) : Color(0.0f);
}

}  // namespace

std::unique_ptr<BidirectionalIntegrator> MakeBdptIntegrator(const RenderScene& scene, const BdptSettings& settings) {
  return std::make_unique<BdptIntegrator>(scene, settings);
}

}  // namespace lampyr
