#include "integrators/light/light_integrator.h"

#include "integrators/common/adjoint.h"
#include "integrators/common/camera_connection.h"
#include "integrators/common/roulette.h"

namespace lampyr {

namespace {

// The path so far: flux (W) over density. In two parts until the first surface, because a light may show diffuse and
// specular lobes different radiance; the same from there on.
struct LightPath {
  Ray ray;
  Color fluxDiffuse, fluxSpecular;
  float emitted = 0;  // largest channel of the flux at the start
  int depth = 0;      // scattering events so far
};

class LightIntegrator final : public LightPathIntegrator {
 public:
  LightIntegrator(const RenderScene& scene, const LightPathSettings& settings)
      : geometry_(*scene.geometry),
        lighting_(*scene.lighting),
        camera_(*scene.camera),
        materials_(scene.materials),
        settings_(settings) {}

  void TracePath(float time, Sampler& sampler, SplatList& splats, RenderCounts& counts) const override;

 private:
  void ConnectLight(const EmittedPhoton& photon, Sampler& sampler, SplatList& splats, RenderCounts& counts) const;
  void ConnectSurface(const LightPath& path, const SurfacePoint& point, const Bsdf& bsdf, Sampler& sampler,
                      SplatList& splats, RenderCounts& counts) const;
  bool Scatter(LightPath& path, const SurfacePoint& point, const Bsdf& bsdf, Sampler& sampler) const;

  const GeometryScene& geometry_;
  const LightingServices& lighting_;
  const Camera& camera_;
  const std::vector<std::shared_ptr<const Material>>& materials_;
  LightPathSettings settings_;
};

// An area light as the camera sees it. The ray goes from the camera to the light, so that cut-outs and what is
// invisible to cameras are met as any camera ray meets them.
void LightIntegrator::ConnectLight(const EmittedPhoton& photon, Sampler& sampler, SplatList& splats,
                                   RenderCounts& counts) const {
  const auto connection = ConnectToCamera(camera_, photon.emission.position, dimensions::kLens, sampler, splats);
  if (!connection) return;
  const Vector3 fromLens = photon.emission.position - connection->camera.position;
  const float distance = glm::length(fromLens);
  if (!(distance > 0)) return;
  Ray ray{connection->camera.position, fromLens / distance, kInfinity, photon.ray.time};
  ++counts.cameraRays;
  RayHit hit;
  if (!geometry_.Intersect(ray, visibility::kCamera, hit)) return;
  const SurfacePoint point = geometry_.GetSurfacePoint(ray, hit);
  if (!lighting_.IsOrigin(photon, point, -ray.direction, distance)) return;
  const Color radiance = lighting_.EmissionForCamera(ray.direction, hit.t, point, ray.time);
  if (radiance.IsBlack()) return;
  const float density = photon.emissionSelection.value * photon.emission.pdfEmit.value;
  const float cosTheta = AbsDot(ray.direction, photon.emission.normal);
  AddSplats(*connection, radiance * (cosTheta / density * connection->Weight()), splats, counts);
}

void LightIntegrator::ConnectSurface(const LightPath& path, const SurfacePoint& point, const Bsdf& bsdf,
                                     Sampler& sampler, SplatList& splats, RenderCounts& counts) const {
  const uint32_t lens = dimensions::OfVertex(path.depth + 1, dimensions::kLight);
  const auto connection = ConnectToCamera(camera_, point.position, lens, sampler, splats);
  if (!connection) return;
  const Vector3 difference = connection->camera.position - point.position;
  const float distanceSquared = LengthSquared(difference);
  if (!(distanceSquared > 0)) return;
  const Vector3 toCamera = difference / std::sqrt(distanceSquared), toLight = -path.ray.direction;
  const BsdfEvaluation f = bsdf.Evaluate(toLight, toCamera, TransportMode::Importance);
  const Color scattered = path.fluxDiffuse * f.diffuse + path.fluxSpecular * f.specular;
  if (scattered.IsBlack()) return;
  const float cosines = AbsDot(toCamera, bsdf.Ng()) * ArrivalCorrection(bsdf, toLight);
  ++counts.shadowRays;
  const Ray ray = SpawnRayTo(point, connection->camera.position, Vector3(0.0f), Normal3(0.0f), path.ray.time);
  if (geometry_.Occluded(ray, visibility::kCamera)) return;
  AddSplats(*connection, scattered * (cosines * connection->Weight()), splats, counts);
}

// Continues the path by the BSDF and Russian roulette. False: it ends here.
bool LightIntegrator::Scatter(LightPath& path, const SurfacePoint& point, const Bsdf& bsdf, Sampler& sampler) const {
  const Vector3 toLight = -path.ray.direction;
  sampler.SetDimension(dimensions::OfVertex(path.depth + 1, dimensions::kLobe));
  const float uLobe = sampler.Get1D();
  const auto sample = bsdf.Sample(toLight, uLobe, sampler.Get2D(), TransportMode::Importance);
  if (!sample) return false;
  Color flux = path.fluxDiffuse * sample->weightDiffuse + path.fluxSpecular * sample->weightSpecular;
  flux *= ArrivalCorrection(bsdf, toLight) * DepartureCorrection(bsdf, sample->wi);
  path.ray = SpawnRay(point, sample->wi, path.ray.time);
  ++path.depth;
  // Importance that enters glass is not scaled by η²: there is nothing to undo.
  const float survival = SurvivalProbability(flux / path.emitted, 1, path.depth);
  if (survival < 1) {
    sampler.SetDimension(dimensions::OfVertex(path.depth, dimensions::kRoulette));
    if (sampler.Get1D() >= survival) return false;
    flux /= survival;
  }
  path.fluxDiffuse = path.fluxSpecular = flux;
  return true;
}

void LightIntegrator::TracePath(float time, Sampler& sampler, SplatList& splats, RenderCounts& counts) const {
  sampler.SetDimension(dimensions::OfVertex(0, dimensions::kLightSelection));
  const float uSelect = sampler.Get1D();
  const Point2 u = sampler.Get2D();
  sampler.SetDimension(dimensions::OfVertex(0, dimensions::kDirection));
  const std::optional<EmittedPhoton> photon = lighting_.GenerateEmission(uSelect, u, sampler.Get2D(), time);
  if (!photon) return;
  if (photon->fromSurface) ConnectLight(*photon, sampler, splats, counts);
  if (photon->IsDark()) return;
  ++counts.indirectRays;

  const EmissionSample& emission = photon->emission;
  const double density = static_cast<double>(emission.pdfEmit.value) *
                         static_cast<double>(emission.pdfEmitDirection.value) *
                         static_cast<double>(photon->emissionSelection.value);
  const float inverseDensity = static_cast<float>(static_cast<double>(emission.emissionCosine) / density);
  LightPath path{photon->ray, emission.diffuse * inverseDensity, emission.specular * inverseDensity};
  path.emitted = std::max(path.fluxDiffuse.Max(), path.fluxSpecular.Max());
  if (!(path.emitted > 0)) return;  // less than a float can say

  std::optional<RayHit> hit = photon->landing;
  while (hit && path.depth < settings_.maxDepth) {
    const SurfacePoint point = geometry_.GetSurfacePoint(path.ray, *hit);
    const GeometryAttributes& attributes = geometry_.Attributes(hit->primitive);
    const Material* material = attributes.material >= 0 ? materials_[attributes.material].get() : nullptr;
    if (!material) return;  // a black surface, such as an analytic light
    const Bsdf bsdf = material->GetBsdf(point, -path.ray.direction);
    const bool isSeen = (attributes.visibility & visibility::kCamera) != 0;
    if (isSeen && !bsdf.IsDelta()) ConnectSurface(path, point, bsdf, sampler, splats, counts);
    if (path.depth + 1 >= settings_.maxDepth || !Scatter(path, point, bsdf, sampler)) return;
    ++counts.indirectRays;
    RayHit next;
    if (!geometry_.Intersect(path.ray, visibility::kIndirect, next)) return;
    hit = next;
  }
}

}  // namespace

std::unique_ptr<LightPathIntegrator> MakeLightIntegrator(const RenderScene& scene, const LightPathSettings& settings) {
  return std::make_unique<LightIntegrator>(scene, settings);
}

}  // namespace lampyr
