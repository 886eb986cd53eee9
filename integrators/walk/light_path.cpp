#include "integrators/walk/light_path.h"

#include <algorithm>

namespace lampyr {

namespace {

// Adds what applies to the first segment alone: the light filter, and the distance within which a surface blocks the
// emission without being lit (EmissionSample::shinesFrom). All other segments are those of any path.
class LightWalkVisitor final : public PathVisitor {
 public:
  LightWalkVisitor(const SampleContext& context, const EmittedPhoton& photon, const PathState& start, int maxDepth,
                   LightPath& path, LightPathVisitor& visitor)
      : context_(context),
        photon_(photon),
        diffuse_(start.diffuse),
        specular_(start.specular),
        maxDepth_(maxDepth),
        path_(path),
        visitor_(visitor) {}

  bool Met(const Subpath& path, const PathState&, const RayHit& hit, const SurfacePoint&, bool) override {
    return path.Count() > 0 || hit.t >= photon_.emission.shinesFrom;
  }
  bool Arrived(Subpath& path, const PathState& state) override {
    if (path.Count() == 1 && !SetFirst(path.Last(), state)) {
      path.Clear();
      return false;
    }
    visitor_.Arrived(path_, state);
    return static_cast<int>(path.Count()) < maxDepth_;
  }

 private:
  // Filters act on the emitted radiance, before the transmittance of thin surfaces, as in next-event estimation.
  bool SetFirst(PathVertex& first, const PathState& state) {
    first.diffuse = diffuse_;
    first.specular = specular_;
    if (!context_.scene.lighting->FilterFirstHit(photon_, first.receiver, first.diffuse, first.specular)) return false;
    first.diffuse *= state.passed;
    first.specular *= state.passed;
    return visitor_.FirstHit(photon_, first);
  }

  const SampleContext& context_;
  const EmittedPhoton& photon_;
  const Color diffuse_, specular_;  // as emitted
  const int maxDepth_;
  LightPath& path_;
  LightPathVisitor& visitor_;
};

// Sets the path state of an emission: flux in LightingServices::FluxUnit, over the density of the emission. False: it
// carries no light, or an invalid value, which is dropped and counted.
bool Emit(const SampleContext& context, const EmittedPhoton& photon, PathState& state) {
  const EmissionSample& emission = photon.emission;
  const double density =
      static_cast<double>(emission.pdfEmit.value) * static_cast<double>(emission.pdfEmitDirection.value) *
      static_cast<double>(photon.emissionSelection.value) * static_cast<double>(context.scene.lighting->FluxUnit());
  const auto inverse = static_cast<float>(static_cast<double>(emission.emissionCosine) / density);
  state.ray = photon.ray;
  state.medium =
      context.scene.MediumOfLight(photon.light, glm::dot(photon.emission.normal, photon.emission.direction) < 0);
  state.diffuse = emission.diffuse * inverse;
  state.specular = emission.specular * inverse;
  state.emitted = std::max(state.diffuse.Max(), state.specular.Max());
  if (!state.diffuse.IsValid() || !state.specular.IsValid()) {
    ++context.counts.droppedSamples;
    return false;
  }
  return state.emitted > 0;  // 0 also if the flux underflows float
}

}  // namespace

void TraceLightPath(const SampleContext& context, int maxDepth, const PathDimensions& dimensions, LightPath& path,
                    LightPathVisitor& visitor) {
  path.vertices.Clear();
  Sampler& sampler = context.sampler;
  sampler.SetDimension(dimensions.Of(0, dimensions::kLightSelection));
  const float uSelect = sampler.Get1D();
  const Point2 u = sampler.Get2D();
  sampler.SetDimension(dimensions.Of(0, dimensions::kDirection));
  const std::optional<EmittedPhoton> photon =
      context.scene.lighting->GenerateEmission(uSelect, u, sampler.Get2D(), context.time);
  if (!photon) return;
  path.light = photon->light;
  if (photon->fromSurface) visitor.Emitted(*photon);
  PathState state;
  if (maxDepth < 1 || photon->IsDark() || !Emit(context, *photon, state)) return;
  LightWalkVisitor walkVisitor(context, *photon, state, maxDepth, path, visitor);
  Walk(context, {TransportMode::Importance, maxDepth, dimensions}, state, path.vertices, walkVisitor);
}

}  // namespace lampyr
