#include "integrators/walk/lens.h"

#include <bit>
#include <cmath>

#include "sampling/rng.h"

namespace lampyr {

namespace {

std::optional<FilmConnection> ConnectToCamera(const SampleContext& context, const Point3& position,
                                              uint32_t dimension) {
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
  if (!connection) return std::nullopt;
  FilmConnection result{*connection, camera.CopiesOf(connection->film)};
  bool reaches = splats.Reaches(connection->film);
  for (int i = 0; i < result.copies.count; ++i) {
    reaches = reaches || splats.Reaches(result.copies.points[static_cast<size_t>(i)]);
  }
  if (!reaches) return std::nullopt;
  return result;
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
  if (!scene.geometry->Intersect(ray, visibility::kCamera, hit, passed)) return false;
  const SurfacePoint point = scene.geometry->GetSurfacePoint(ray, hit);
  if (!scene.lighting->IsOrigin(photon, point, -ray.direction, distance)) return false;
  if (!scene.media.empty()) {
    Ray before = ray;
    before.tMax = hit.t;
    const EdgeEnd lens{Point3d(ray.origin), scene.MediumOf(ray)}, light{Point3d(photon.emission.position)};
    passed = TransmittanceOf(context, before, visibility::kCamera, lens, light, DeciderOf(photon.emission.position),
                             seen.factors);
  }
  radiance = passed * scene.lighting->EmissionForCamera(ray.direction, hit.t, point, context.time);
  return !radiance.IsBlack();
}

}  // namespace

std::optional<SeenFromLens> SeeLight(const SampleContext& context, const EmittedPhoton& photon,
                                     uint32_t lensDimension) {
  const Point3& position = photon.emission.position;
  const auto connection = ConnectToCamera(context, position, lensDimension);
  if (!connection) return std::nullopt;
  const Vector3 fromLens = position - connection->camera.position;
  const float distance = glm::length(fromLens);
  if (!(distance > 0)) return std::nullopt;
  const Ray ray{connection->camera.position, fromLens / distance, kInfinity, context.time};
  ++context.counts.cameraRays;
  SeenFromLens seen{*connection, -ray.direction, Color(), AbsDot(ray.direction, photon.emission.normal), {}};
  Color radiance;
  if (!SeesOrigin(context, photon, ray, distance, seen, radiance)) return std::nullopt;
  const double density =
      static_cast<double>(photon.emissionSelection.value) * static_cast<double>(photon.emission.pdfEmit.value);
  seen.value = radiance * static_cast<float>(static_cast<double>(seen.geometryTerm * connection->Weight()) / density);
  return seen;
}

std::optional<SeenFromLens> SeeGlow(const SampleContext& context, const EmittedInMedium& emitted,
                                    uint32_t lensDimension) {
  const auto connection = ConnectToCamera(context, emitted.position, lensDimension);
  if (!connection) return std::nullopt;
  const Vector3 difference = connection->camera.position - emitted.position;
  const float squared = LengthSquared(difference);
  if (!(squared > 0)) return std::nullopt;
  SeenFromLens seen{*connection, difference / std::sqrt(squared), Color(), 1, {}, {}};
  ++context.counts.shadowRays;
  SurfacePoint point;  // no surface: no normal, no error
  point.position = emitted.position;
  point.Ng = point.Ns = Normal3(0.0f);
  const Ray ray = SpawnRayTo(point, connection->camera.position, Vector3(0.0f), Normal3(0.0f), context.time);
  EdgeFactors factors;
  const uint64_t decider = Hash(std::bit_cast<uint32_t>(ray.direction.x), std::bit_cast<uint32_t>(ray.direction.y));
  const Color extinction = context.scene.media[static_cast<size_t>(emitted.medium)]->At(emitted.position).Extinction();
  const EdgeEnd glow{Point3d(emitted.position), emitted.medium, Color(1.0f),
                     EdgeEnd::IsFineIn(extinction, emitted.position)};
  const EdgeEnd lens{Point3d(connection->camera.position)};
  const Color arriving = TransmittanceOf(context, ray, visibility::kCamera, glow, lens, decider, factors);
  if (arriving.IsBlack()) return std::nullopt;
  seen.factors = factors.Reversed();
  seen.value = Product(emitted.emission, arriving, static_cast<double>(connection->Weight()) / emitted.density);
  return seen;
}

std::optional<SeenFromLens> SeeVertex(const SampleContext& context, const PathVertex& vertex, uint32_t lensDimension) {
  if (!vertex.isSeenByCamera || vertex.isDelta) return std::nullopt;
  const RenderScene& scene = context.scene;
  const Point3& position = vertex.point.position;
  const auto connection = ConnectToCamera(context, position, lensDimension);
  if (!connection) return std::nullopt;
  const Vector3 difference = connection->camera.position - position;
  const float squared = LengthSquared(difference);
  if (!(squared > 0)) return std::nullopt;
  SeenFromLens seen{*connection, difference / std::sqrt(squared), Color(), 0, {}};
  seen.f = vertex.Evaluate(seen.toCamera, TransportMode::Importance);
  const Color scattered = vertex.diffuse * seen.f.diffuse + vertex.specular * seen.f.specular;
  if (scattered.IsBlack()) return std::nullopt;
  ++context.counts.shadowRays;
  const Ray ray = SpawnRayTo(vertex.point, connection->camera.position, Vector3(0.0f), Normal3(0.0f), context.time);
  Color arriving;
  if (scene.media.empty()) [[likely]] {
    arriving = scene.geometry->Transmittance(ray, visibility::kCamera);
  } else {
    EdgeFactors fromVertex;
    const EdgeEnd lens{Point3d(connection->camera.position)};
    arriving = TransmittanceOf(context, ray, visibility::kCamera, vertex.EndTowards(ray.direction), lens,
                               DeciderOf(position), fromVertex);
    seen.factors = fromVertex.Reversed();
  }
  if (arriving.IsBlack()) return std::nullopt;
  seen.geometryTerm = vertex.GeometryTerm(seen.toCamera);
  const float importance = seen.geometryTerm * vertex.ArrivalCorrection(vertex.toPrevious) * connection->Weight();
  seen.value =
      Product(scattered, arriving, static_cast<double>(importance) * static_cast<double>(scene.lighting->FluxUnit()));
  return seen;
}

void AddSplats(const FilmConnection& connection, const Color& value, uint32_t group, SplatList& splats,
               RenderCounts& counts) {
  bool isValid = splats.Add(connection.camera.film, value, group);
  for (int i = 0; i < connection.copies.count; ++i) {
    isValid &= splats.Add(connection.copies.points[static_cast<size_t>(i)], value, group);
  }
  if (!isValid) ++counts.droppedSamples;
}

Color EscapedEmissionForCamera(const SampleContext& context, const Ray& ray, const Color& throughput) {
  const LightingServices& lighting = *context.scene.lighting;
  Color sum;
  for (size_t i = 0; i < lighting.InfiniteCount(); ++i) {
    const Color seen = lighting.EscapedEmissionForCamera(i, ray);
    sum += seen;
    if (context.layers) context.layers->Add(lighting.GroupOfInfinite(i), throughput * seen);
  }
  return throughput * sum;
}

}  // namespace lampyr
