#include "integrators/common/light_subpath.h"

#include <algorithm>

#include "base/stop.h"

namespace lampyr {

// The weight of the first vertex is that of the selection there: next-event estimation from it would have chosen this
// light so often. False: the light does not send anything there.
bool LightSubpathTracer::Land(const EmittedPhoton& photon, LightSubpath& path) const {
  PathVertex& vertex = path.vertices[0];
  const std::optional<FoundLight> found = scene_.lighting->EvaluateLanding(photon, vertex.receiver);
  if (!found) return false;
  const double squared = LengthSquared(Vector3d(vertex.point.position) - Vector3d(photon.emission.position));
  const double landing = LandingFactor(*scene_.lighting, found->light, CosineAt(vertex, vertex.toPrevious), squared);
  path.end = EndOf(*scene_.lighting, *found, scene_.lighting->CanBeHit(found->light), landing);
  if (!(path.end.emission > 0)) return false;
  vertex.pdfForward = path.end.emission;
  vertex.previousPerSolidAngle = path.end.perSolidAngle;
  vertex.weight = {};
  if (weights_ == Weights::Merging) return true;
  const double perEmission = 1 / Mis(path.end.emission);
  vertex.weight = {Mis(path.end.direct) * perEmission, path.end.canBeHit ? perEmission : 0.0, 0.0};
  return true;
}

PathOrigin OriginOf(const LightingServices& lighting, const EmittedPhoton& photon, const PathVertex& first) {
  PathOrigin origin;
  origin.light = photon.light;
  origin.start = photon.emission.position;
  origin.landing = first.point.position;
  // A light carries its radiance in both; a multiplier may have put out one of them.
  origin.flux = std::max(first.diffuse.Average(), first.specular.Average());
  origin.pdfUnguided = photon.pdfUnguided;
  origin.gain = lighting.EmissionGain(photon);
  return origin;
}

void LightSubpathTracer::Trace(float time, Sampler& sampler, RenderCounts& counts, LightSubpath& path,
                               LightSubpathVisitor& visitor) const {
  path.count = 0;
  sampler.SetDimension(dimensions_.Of(0, dimensions::kLightSelection));
  const float uSelect = sampler.Get1D();
  const Point2 u = sampler.Get2D();
  sampler.SetDimension(dimensions_.Of(0, dimensions::kDirection));
  const std::optional<EmittedPhoton> photon = scene_.lighting->GenerateEmission(uSelect, u, sampler.Get2D(), time);
  if (!photon) return;
  path.light = photon->light;
  if (photon->fromSurface) visitor.Emitted(*photon);
  if (photon->IsDark()) return;
  ++counts.indirectRays;
  const EmissionSample& emission = photon->emission;
  const double density =
      static_cast<double>(emission.pdfEmit.value) * static_cast<double>(emission.pdfEmitDirection.value) *
      static_cast<double>(photon->emissionSelection.value) * static_cast<double>(scene_.lighting->FluxUnit());
  const auto inverse = static_cast<float>(static_cast<double>(emission.emissionCosine) / density);
  Flight flight;
  flight.ray = photon->ray;
  flight.diffuse = emission.diffuse * inverse;
  flight.specular = emission.specular * inverse;
  const float emitted = std::max((flight.diffuse * photon->passed).Max(), (flight.specular * photon->passed).Max());
  if (!flight.diffuse.IsValid() || !flight.specular.IsValid()) {
    ++counts.droppedSamples;
    return;
  }
  if (!(emitted > 0)) return;  // less than a float can say

  std::optional<RayHit> hit = photon->landing;
  while (hit && path.count < static_cast<size_t>(maxDepth_)) {
    CheckStop();
    const SurfacePoint point = scene_.geometry->GetSurfacePoint(flight.ray, *hit);
    PathVertex& vertex = PlaceOf(path.vertices, path.count);
    if (!MakeVertex(scene_, flight.ray, *hit, point, vertex)) return;
    vertex.diffuse = flight.diffuse;
    vertex.specular = flight.specular;
    if (path.count == 0) {
      // Filters act on the emitted radiance, before the transmittance of thin surfaces, as in next-event estimation.
      if (!scene_.lighting->FilterLanding(*photon, vertex.receiver, vertex.diffuse, vertex.specular)) return;
      vertex.diffuse *= photon->passed;
      vertex.specular *= photon->passed;
    }
    if (weights_ != Weights::None) {
      if (path.count > 0) {
        Follow(path.Last(), flight, weights_ == Weights::All, vertex);
      } else if (!Land(*photon, path)) {
        return;
      }
    }
    if (path.count == 0) visitor.Landed(*photon, vertex);
    ++path.count;
    visitor.Arrived(path);
    const auto depth = static_cast<int>(path.count);
    if (depth >= maxDepth_ ||
        !Scatter(vertex, TransportMode::Importance, depth, dimensions_, depth, emitted, sampler, flight)) {
      return;
    }
    ++counts.indirectRays;
    RayHit next;
    Color passed;
    if (!scene_.geometry->Intersect(flight.ray, visibility::kIndirect, next, passed)) return;
    flight.diffuse *= passed;
    flight.specular *= passed;
    hit = next;
  }
}

}  // namespace lampyr
