#include "integrators/common/subpath.h"

#include <algorithm>

#include "integrators/common/adjoint.h"
#include "integrators/common/roulette.h"

namespace lampyr {

PathVertex& PlaceOf(std::vector<PathVertex>& vertices, size_t index) {
  if (index >= vertices.size()) vertices.resize(std::max<size_t>(8, 2 * index));
  return vertices[index];
}

bool MakeVertex(const RenderScene& scene, const Ray& ray, const RayHit& hit, const SurfacePoint& point,
                PathVertex& vertex) {
  const GeometryAttributes& attributes = scene.geometry->Attributes(hit.primitive);
  const Material* material = attributes.material >= 0 ? scene.materials[attributes.material].get() : nullptr;
  if (!material) return false;
  vertex.point = point;
  vertex.toPrevious = -ray.direction;
  vertex.bsdf = material->GetBsdf(point, vertex.toPrevious);
  const Normal3 Ns = vertex.bsdf.ShadingFrame().z;
  vertex.receiver = {point.position, glm::dot(Ns, vertex.toPrevious) < 0 ? -Ns : Ns, vertex.bsdf.IsTransmissive(),
                     attributes.link};
  vertex.coverage = attributes.alpha ? attributes.alpha->Alpha(point.uv, point.position) : 1.0f;
  vertex.isDelta = vertex.bsdf.IsDelta();
  vertex.storesPhotons = !vertex.isDelta || !material->IsAlwaysDelta();
  vertex.isSeenByCamera = (attributes.visibility & visibility::kCamera) != 0;
  vertex.isSeenByIndirect = (attributes.visibility & visibility::kIndirect) != 0;
  return true;
}

bool Scatter(PathVertex& vertex, TransportMode mode, int depth, const SubpathDimensions& from, int block, float scale,
             Sampler& sampler, Flight& flight) {
  const bool isLight = mode == TransportMode::Importance;
  const Vector3& wo = vertex.toPrevious;
  sampler.SetDimension(from.Of(block, dimensions::kLobe));
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
    sampler.SetDimension(from.Of(block, dimensions::kRoulette));
    if (sampler.Get1D() >= survival) return false;
    flight.diffuse /= survival;
    flight.specular /= survival;
  }
  return true;
}

void Follow(const PathVertex& previous, const Flight& flight, bool connects, PathVertex& vertex) {
  const double squared = LengthSquared(Vector3d(vertex.point.position) - Vector3d(previous.point.position));
  vertex.pdfForward = flight.pdf * AreaPerSolidAngle(CosineAt(vertex, flight.ray.direction), squared);
  vertex.previousPerSolidAngle = AreaPerSolidAngle(CosineAt(previous, flight.ray.direction), squared);
  vertex.weight = previous.weight.Next(previous.scatteredDelta, previous.CanMerge(), vertex.pdfForward,
                                       previous.eventReverse * previous.previousPerSolidAngle);
  if (!connects) vertex.weight.connect = 0;
}

double LandingFactor(const LightingServices& lighting, uint32_t light, float cosTheta, double distanceSquared) {
  return AreaPerSolidAngle(cosTheta, lighting.IsAtInfinity(light) ? 1 : distanceSquared);
}

LightEnd EndOf(const LightingServices& lighting, const FoundLight& found, bool canBeHit, double landing) {
  const LightEvaluation& e = found.evaluation;
  LightEnd end;
  end.light = found.light;
  end.perSolidAngle = static_cast<double>(e.solidAngleToArea);
  end.direct = static_cast<double>(found.selection.value) * static_cast<double>(e.pdfDirect.value) * end.perSolidAngle;
  const double selection = static_cast<double>(lighting.EmissionSelectionProbability(found.light).value);
  const double position = selection * static_cast<double>(e.pdfEmit.value);
  end.emission = position * static_cast<double>(e.pdfEmitDirection.value) * landing;
  end.canBeHit = canBeHit;
  if (canBeHit && !lighting.IsAtInfinity(found.light)) end.position = position;
  return end;
}

}  // namespace lampyr
