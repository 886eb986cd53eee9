#include "integrators/walk/lens.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "integrators/walk/path_layers.h"
#include "sampling/rng.h"

namespace lampyr {

namespace {

// Sets `seen` with its connection to the camera, or leaves it unset if the film does not see the position. In place:
// connections are large, and a copy of what was just written stalls.
void ConnectToCamera(const SampleContext& context, const Point3& position, uint32_t dimension,
                     std::optional<SeenFromLens>& seen) {
  const Camera& camera = *context.scene.camera;
  const SplatList& splats = *context.splats;
  Point2 lens(0.5f);
  if (!camera.HasPinhole()) {
    // Points of the lens are stratified among those of light paths.
    Sampler& sampler = context.lightSampler ? *context.lightSampler : context.sampler;
    sampler.SetDimension(dimension);
    lens = sampler.Get2D();
  }
  const auto connection = camera.Connect(position, lens);
  if (!connection) return;
  const FilmCopies copies = camera.CopiesOf(connection->film);
  bool reaches = splats.Reaches(connection->film);
  for (int i = 0; i < copies.count; ++i) reaches = reaches || splats.Reaches(copies.points[static_cast<size_t>(i)]);
  if (!reaches) return;
  FilmConnection& set = seen.emplace().connection;
  set.camera = *connection;
  set.copies.count = copies.count;
  std::copy_n(copies.points.begin(), static_cast<size_t>(copies.count), set.copies.points.begin());
}

// Seed of the estimate of the transmittance between a point and the lens. It comes from the point: directions to a
// parallel camera are all the same.
uint64_t DeciderOf(const Point3& position) {
  return Hash(std::bit_cast<uint32_t>(position.x), std::bit_cast<uint32_t>(position.y),
              std::bit_cast<uint32_t>(position.z));
}

// True if the camera sees along `ray` the point of a light that `photon` started from. Sets the radiance that arrives,
// and the factors of the edge.
bool SeesOrigin(const SampleContext& context, const EmittedPhoton& photon, const Ray& ray, float distance,
                SeenFromLens& seen, Color& radiance) {
  const RenderScene& scene = context.scene;
  RayHit hit;
  Color passed;
  if (scene.media.empty()) [[likely]] {
    if (!scene.Intersect(ray, visibility::kCamera, hit, passed)) return false;
  } else {
    const EdgeEnd lens{Point3d(ray.origin), scene.MediumOf(ray)}, light{Point3d(photon.emission.position)};
    if (!TransmittanceToHit(context, ray, visibility::kCamera, lens, light, DeciderOf(photon.emission.position), hit,
                            passed, seen.factors))
      return false;
  }
  const SurfacePoint point = scene.geometry->GetSurfacePoint(ray, hit);
  if (!scene.lighting->IsOrigin(photon, point, -ray.direction, distance)) return false;
  radiance = passed * scene.lighting->EmissionForCamera(ray.direction, hit.t, point, context.time);
  return !radiance.IsBlack();
}

}  // namespace

std::optional<SeenFromLens> SeeLight(const SampleContext& context, const EmittedPhoton& photon,
                                     uint32_t lensDimension) {
  const Point3& position = photon.emission.position;
  std::optional<SeenFromLens> seen;
  if (context.IsCounted(false)) return seen;
  ConnectToCamera(context, position, lensDimension, seen);
  if (!seen) return seen;
  const Point3& lens = seen->connection.camera.position;
  const Vector3 fromLens = position - lens;
  const float distance = glm::length(fromLens);
  const Ray ray{lens, fromLens / distance, kInfinity, context.time};
  Color radiance;
  if (distance > 0) {
    ++context.counts.cameraRays;
    seen->toCamera = -ray.direction;
    seen->geometryTerm = AbsDot(ray.direction, photon.emission.normal);
  }
  if (!(distance > 0) || !SeesOrigin(context, photon, ray, distance, *seen, radiance)) {
    seen.reset();
    return seen;
  }
  const double density =
      static_cast<double>(photon.emissionSelection.value) * static_cast<double>(photon.emission.pdfEmit.value);
  seen->value =
      radiance * static_cast<float>(static_cast<double>(seen->geometryTerm * seen->connection.Weight()) / density);
  return seen;
}

std::optional<SeenFromLens> SeeGlow(const SampleContext& context, const EmittedInMedium& emitted,
                                    uint32_t lensDimension) {
  std::optional<SeenFromLens> seen;
  if (context.IsCounted(false)) return seen;
  ConnectToCamera(context, emitted.position, lensDimension, seen);
  if (!seen) return seen;
  const FilmConnection& connection = seen->connection;
  const Way way(connection.camera.position - emitted.position);
  if (!(way.squared > 0)) return std::nullopt;
  seen->toCamera = way.direction;
  seen->geometryTerm = 1;
  ++context.counts.shadowRays;
  SurfacePoint point;  // no surface: no normal, no error
  point.position = emitted.position;
  point.Ng = point.Ns = Normal3(0.0f);
  const Ray ray = SpawnRayTo(point, connection.camera.position, Vector3(0.0f), Normal3(0.0f), context.time);
  EdgeFactors factors;
  const uint64_t decider = DeciderOf(emitted.position);
  const Color extinction = context.scene.media[static_cast<size_t>(emitted.medium)]->At(emitted.position).Extinction();
  const EdgeEnd glow{Point3d(emitted.position), emitted.medium, Color(1.0f),
                     EdgeEnd::IsFineIn(extinction, emitted.position)};
  const EdgeEnd lens{Point3d(connection.camera.position)};
  const Color arriving = TransmittanceOf(context, ray, visibility::kCamera, glow, lens, decider, factors);
  if (arriving.IsBlack()) return std::nullopt;
  seen->factors = factors.Reversed();
  seen->value = Product(emitted.emission, arriving, static_cast<double>(connection.Weight()) / emitted.density);
  return seen;
}

namespace {

// SeeVertex without the connection to the camera, which is `seen.connection`. False: the camera does not see the
// vertex.
bool CompleteConnection(const SampleContext& context, const PathVertex& vertex, SeenFromLens& seen) {
  const RenderScene& scene = context.scene;
  const Point3& position = vertex.point.position;
  const FilmConnection& connection = seen.connection;
  const Way way(connection.camera.position - position);
  if (!(way.squared > 0)) return false;
  seen.toCamera = way.direction;
  seen.f = vertex.Evaluate(seen.toCamera, TransportMode::Importance);
  const Color scattered = vertex.diffuse * seen.f.diffuse + vertex.specular * seen.f.specular;
  if (scattered.IsBlack()) return false;
  ++context.counts.shadowRays;
  const Ray ray = SpawnRayTo(vertex.point, connection.camera.position, Vector3(0.0f), Normal3(0.0f), context.time);
  Color arriving;
  if (scene.media.empty()) [[likely]] {
    arriving = scene.Transmittance(ray, visibility::kCamera);
  } else {
    EdgeFactors fromVertex;
    const EdgeEnd lens{Point3d(connection.camera.position)};
    arriving = TransmittanceOf(context, ray, visibility::kCamera, vertex.EndTowards(ray.direction), lens,
                               DeciderOf(position), fromVertex);
    seen.factors = fromVertex.Reversed();
  }
  if (arriving.IsBlack()) return false;
  seen.geometryTerm = vertex.GeometryTerm(seen.toCamera);
  const float importance = seen.geometryTerm * vertex.ArrivalCorrection(vertex.toPrevious) * connection.Weight();
  seen.value =
      Product(scattered, arriving, static_cast<double>(importance) * static_cast<double>(scene.lighting->FluxUnit()));
  return true;
}

}  // namespace

std::optional<SeenFromLens> SeeVertex(const SampleContext& context, const PathVertex& vertex, uint32_t lensDimension) {
  std::optional<SeenFromLens> seen;
  if (!vertex.isSeenByCamera || vertex.isDelta || context.IsCounted(vertex.isDispersed)) return seen;
  ConnectToCamera(context, vertex.point.position, lensDimension, seen);
  if (seen && !CompleteConnection(context, vertex, *seen)) seen.reset();
  return seen;
}

bool AddSplats(const FilmConnection& connection, const Color& value, SplatList& splats) {
  bool isValid = splats.Add(connection.camera.film, value);
  for (int i = 0; i < connection.copies.count; ++i) {
    isValid &= splats.Add(connection.copies.points[static_cast<size_t>(i)], value);
  }
  return isValid;
}

void AddSplats(const SampleContext& context, const FilmConnection& connection, const Color& value,
               std::span<const PathLabel> labels) {
  SplatList& splats = *context.splats;
  const bool isValid = AddSplats(connection, value, splats);
  if (!isValid) ++context.counts.droppedSamples;
  if (!context.outputs || !isValid) [[likely]]
    return;
  const PathLabel camera[] = {{OutputPlan::kCamera}};
  for (const LayerShare& part : SharesOf(*context.outputs, camera, labels)) {
    splats.AddToLayer(connection.camera.film, value, part.share, part.layer);
    for (int i = 0; i < connection.copies.count; ++i)
      splats.AddToLayer(connection.copies.points[static_cast<size_t>(i)], value, part.share, part.layer);
  }
}

std::span<const PathLabel> LabelsTowardsLens(const SampleContext& context, const Subpath& path,
                                             const SeenFromLens& seen) {
  if (!context.outputs) [[likely]]
    return {};
  thread_local PathLabels labels;
  const PathVertex& vertex = path.Last();
  path.LabelsBeyond(
      *context.outputs, TransportMode::Importance,
      PartsOf(vertex, seen.toCamera, false, vertex.diffuse * seen.f.diffuse, vertex.specular * seen.f.specular),
      labels);
  return labels.All();
}

Color EscapedEmissionForCamera(const SampleContext& context, const Ray& ray, const Color& throughput) {
  const LightingServices& lighting = *context.scene.lighting;
  Color sum;
  for (size_t i = 0; i < lighting.InfiniteCount(); ++i) {
    const Color seen = lighting.EscapedEmissionForCamera(i, ray);
    sum += seen;
    if (!context.layers) continue;
    const PathLabel camera[] = {{OutputPlan::kCamera}},
                    light[] = {{context.outputs->OfLight(lighting.InfiniteLight(i))}};
    AddToLayers(context, camera, light, throughput * seen);
  }
  return throughput * sum;
}

}  // namespace lampyr
