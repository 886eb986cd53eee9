#include "integrators/common/lens.h"

#include <cmath>

#include "integrators/common/adjoint.h"
#include "integrators/common/subpath.h"

namespace lampyr {

std::optional<SeenFromLens> SeeLight(const RenderScene& scene, const EmittedPhoton& photon, float time,
                                     uint32_t lensDimension, Sampler& sampler, const SplatList& splats,
                                     RenderCounts& counts) {
  const Point3& position = photon.emission.position;
  const auto connection = ConnectToCamera(*scene.camera, position, lensDimension, sampler, splats);
  if (!connection) return std::nullopt;
  const Vector3 fromLens = position - connection->camera.position;
  const float distance = glm::length(fromLens);
  if (!(distance > 0)) return std::nullopt;
  const Ray ray{connection->camera.position, fromLens / distance, kInfinity, time};
  ++counts.cameraRays;
  RayHit hit;
  Color passed;
  if (!scene.geometry->Intersect(ray, visibility::kCamera, hit, passed)) return std::nullopt;
  const SurfacePoint point = scene.geometry->GetSurfacePoint(ray, hit);
  if (!scene.lighting->IsOrigin(photon, point, -ray.direction, distance)) return std::nullopt;
  const Color radiance = passed * scene.lighting->EmissionForCamera(ray.direction, hit.t, point, time);
  if (radiance.IsBlack()) return std::nullopt;
  const double density =
      static_cast<double>(photon.emissionSelection.value) * static_cast<double>(photon.emission.pdfEmit.value);
  SeenFromLens seen{*connection, -ray.direction, Color(), AbsDot(ray.direction, photon.emission.normal), {}};
  seen.value = radiance * static_cast<float>(static_cast<double>(seen.cosTheta * connection->Weight()) / density);
  return seen;
}

std::optional<SeenFromLens> SeeVertex(const RenderScene& scene, const PathVertex& vertex, float time,
                                      uint32_t lensDimension, Sampler& sampler, const SplatList& splats,
                                      RenderCounts& counts) {
  if (!vertex.isSeenByCamera || vertex.isDelta) return std::nullopt;
  const Point3& position = vertex.point.position;
  const auto connection = ConnectToCamera(*scene.camera, position, lensDimension, sampler, splats);
  if (!connection) return std::nullopt;
  const Vector3 difference = connection->camera.position - position;
  const float squared = LengthSquared(difference);
  if (!(squared > 0)) return std::nullopt;
  SeenFromLens seen{*connection, difference / std::sqrt(squared), Color(), 0, {}};
  const Vector3& toLight = vertex.toPrevious;
  seen.f = vertex.bsdf.Evaluate(toLight, seen.toCamera, TransportMode::Importance);
  const Color scattered = vertex.diffuse * seen.f.diffuse + vertex.specular * seen.f.specular;
  if (scattered.IsBlack()) return std::nullopt;
  ++counts.shadowRays;
  const Ray ray = SpawnRayTo(vertex.point, connection->camera.position, Vector3(0.0f), Normal3(0.0f), time);
  const Color arriving = scene.geometry->Transmission(ray, visibility::kCamera);
  if (arriving.IsBlack()) return std::nullopt;
  seen.cosTheta = CosineAt(vertex, seen.toCamera);
  const float importance = std::abs(seen.cosTheta) * ArrivalCorrection(vertex.bsdf, toLight) * connection->Weight();
  seen.value =
      Product(scattered, arriving, static_cast<double>(importance) * static_cast<double>(scene.lighting->FluxUnit()));
  return seen;
}

}  // namespace lampyr
