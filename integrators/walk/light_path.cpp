#include "integrators/walk/light_path.h"

#include <algorithm>
#include <limits>

#include "integrators/walk/integrator_type.h"
#include "sampling/warp.h"

namespace lampyr {

namespace {

// Adds what applies to the first segment alone: the light filter, and the distance within which surfaces and media
// block the emission without being lit (EmissionSample::shinesFrom). All other segments are those of any path.
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
  void Flew(Subpath&, const PathState& state, const Flight& flight) override {
    visitor_.Flew(path_, state, flight, &photon_);
  }
  bool Arrived(Subpath& path, const PathState& state) override {
    if (path.Count() == 1 && (ScattersTooNear(path.Last(), state) || !SetFirst(path.Last(), state))) {
      path.Clear();
      return false;
    }
    visitor_.Arrived(path_, state);
    return static_cast<int>(path.Count()) < maxDepth_;
  }

 private:
  bool ScattersTooNear(const PathVertex& first, const PathState& state) const {
    return first.IsInMedium() && state.length < photon_.emission.shinesFrom;
  }
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
  if (!context.scene.media.empty()) [[unlikely]] {
    if (context.scene.lighting->KindOf(photon.light) == LightKind::Area)
      state.fromOrigin = emission.position - photon.ray.origin;
    state.medium = context.scene.MediumOfLight(
        photon.light, glm::dot(photon.emission.normal, photon.emission.direction) < 0, photon.ray);
  }
  state.diffuse = emission.diffuse * inverse;
  state.specular = emission.specular * inverse;
  state.emitted = std::max(state.diffuse.Max(), state.specular.Max());
  if (!state.diffuse.IsValid() || !state.specular.IsValid()) {
    ++context.counts.droppedSamples;
    return false;
  }
  return state.emitted > 0;  // 0 also if the flux underflows float
}

// Passes on the vertices of a path that starts in a medium.
class MediumWalkVisitor final : public PathVisitor {
 public:
  MediumWalkVisitor(int maxDepth, LightPath& path, LightPathVisitor& visitor)
      : maxDepth_(maxDepth), path_(path), visitor_(visitor) {}

  void Flew(Subpath&, const PathState& state, const Flight& flight) override {
    visitor_.Flew(path_, state, flight, nullptr);
  }
  bool Arrived(Subpath& path, const PathState& state) override {
    visitor_.Arrived(path_, state);
    return static_cast<int>(path.Count()) < maxDepth_;
  }

 private:
  const int maxDepth_;
  LightPath& path_;
  LightPathVisitor& visitor_;
};

// Sets the path state of an emission in a medium: its flux is 4π times what a direction receives. False as in Emit.
bool EmitInMedium(const SampleContext& context, const EmittedInMedium& emitted, const Point2& uDirection,
                  PathState& state) {
  const double inverse =
      4 * static_cast<double>(kPi) / (emitted.density * static_cast<double>(context.scene.lighting->FluxUnit()));
  state.ray = {emitted.position, SampleUniformSphere(uDirection), kInfinity, context.time};
  state.medium = emitted.medium;
  state.diffuse = state.specular = Product(emitted.emission, Color(1.0f), inverse);
  state.emitted = state.diffuse.Max();
  if (!state.diffuse.IsValid()) {
    ++context.counts.droppedSamples;
    return false;
  }
  return state.emitted > 0;
}

// Arguments of TraceLightPath, and the random numbers of the starting point.
struct PathRequest {
  const SampleContext& context;
  const int maxDepth;
  const PathDimensions& dimensions;
  const Point2 place;
  LightPath& path;
  LightPathVisitor& visitor;
};

WalkSettings WalkOf(const PathRequest& request) {
  return {.mode = TransportMode::Importance,
          .maxDepth = request.maxDepth,
          .dimensions = request.dimensions,
          .seesFlights = request.visitor.WantsFlights(),
          .wantsBeams = request.visitor.WantsBeams()};
}

void TraceFromMedium(const PathRequest& request, double uSelect, const GlowingMedia& glowing) {
  const SampleContext& context = request.context;
  Sampler& sampler = context.sampler;
  sampler.SetDimension(request.dimensions.Of(0, dimensions::kLobe));
  const Vector3 u(request.place.x, request.place.y, sampler.Get1D());
  const auto point = glowing.Emission().Sample(uSelect, u, context.time);
  if (!point) return;
  if (context.outputs) request.path.vertices.SetStart(context.outputs->OfMedia());
  const Color emission = context.scene.wavelengths
                             ? context.scene.media[static_cast<size_t>(point->medium)]->At(point->position).emission
                             : point->emission;
  const EmittedInMedium emitted{point->position, point->medium, emission, point->density * glowing.Probability()};
  request.visitor.Glowed(request.path, emitted);
  if (request.maxDepth < 1) return;
  sampler.SetDimension(request.dimensions.Of(0, dimensions::kDirection));
  PathState state;
  if (!EmitInMedium(context, emitted, sampler.Get2D(), state)) return;
  MediumWalkVisitor visitor(request.maxDepth, request.path, request.visitor);
  Walk(context, WalkOf(request), state, request.path.vertices, visitor);
}

// `probability`: of starting a path at a light.
void TraceFromLight(const PathRequest& request, float uSelect, double probability) {
  const SampleContext& context = request.context;
  const LightingServices& lighting = *context.scene.lighting;
  context.sampler.SetDimension(request.dimensions.Of(0, dimensions::kDirection));
  std::optional<EmittedPhoton> photon =
      lighting.GenerateEmission(uSelect, request.place, context.sampler.Get2D(), context.time);
  if (!photon) return;
  if (probability < 1) {
    const double selection = static_cast<double>(photon->emissionSelection.value) * probability;
    photon->emissionSelection = PdfDiscrete(static_cast<float>(selection));
  }
  if (context.outputs) request.path.vertices.SetStart(context.outputs->OfLight(photon->light));
  if (photon->fromSurface) request.visitor.Emitted(*photon);
  PathState state;
  if (request.maxDepth < 1 || photon->IsDark() || !Emit(context, *photon, state)) return;
  LightWalkVisitor visitor(context, *photon, state, request.maxDepth, request.path, request.visitor);
  Walk(context, WalkOf(request), state, request.path.vertices, visitor);
}

// The sphere within which flights pass through media, with their margin.
BoundingSphere SphereOfMedia(const RenderScene& scene) {
  BoundingSphere sphere = scene.lighting->SceneSphere();
  sphere.radius *= 1 + 1e-4f;
  return sphere;
}

// Power of the lights that start paths, W: the mean of the channels.
double PowerOfLights(const RenderScene& scene) {
  double power = 0;
  const std::vector<PlacedLight>& lights = scene.lighting->Lights();
  for (size_t i = 0; i < lights.size(); ++i) {
    if (scene.lighting->EmissionSelectionProbability(static_cast<uint32_t>(i)).IsZero()) continue;
    LightContext light;
    light.transform = &lights[i].transform;
    light.scene = scene.lighting->SceneSphere();
    const double estimate = static_cast<double>(lights[i].light->GetPowerEstimate(light).Average());
    // Positive even if the estimates of all lights are 0: lights that start paths get a share of the paths.
    if (estimate > 0) power += std::min(estimate, static_cast<double>(std::numeric_limits<float>::max()));
    power = std::max(power, static_cast<double>(std::numeric_limits<float>::min()));
  }
  return power;
}

}  // namespace

GlowingMedia::GlowingMedia(const RenderScene& scene)
    : emission_(scene.media, *scene.geometry, SphereOfMedia(scene), scene.exterior, scene.unbounded) {
  // The least share of either, so that a weak glow is seen beside the sun, and a weak light beside a fire.
  constexpr double kLeast = 1.0 / 16;
  const double glow = emission_.Power(), lights = PowerOfLights(scene);
  if (!(glow > 0)) return;
  probability_ = lights > 0 ? std::clamp(glow / (glow + lights), kLeast, 1 - kLeast) : 1.0;
}

std::unique_ptr<const GlowingMedia> GlowingMediaOf(const IntegratorInput& input) {
  const auto& media = input.scene.media;
  if (std::none_of(media.begin(), media.end(), [](const auto& medium) { return medium->IsEmissive(); })) return nullptr;
  return std::make_unique<const GlowingMedia>(input.scene);
}

void TraceLightPath(const SampleContext& context, int maxDepth, const PathDimensions& dimensions, LightPath& path,
                    LightPathVisitor& visitor, const GlowingMedia* glowing) {
  path.vertices.Clear();
  context.sampler.SetDimension(dimensions.Of(0, dimensions::kLightSelection));
  const float uSelect = context.sampler.Get1D();
  const PathRequest request{context, maxDepth, dimensions, context.sampler.Get2D(), path, visitor};
  const double ofMedia = glowing ? glowing->Probability() : 0;
  float ofLights = uSelect;
  if (ofMedia > 0) [[unlikely]] {
    const double u = WithMoreBits(uSelect, request.place.x, request.place.y, context.time);
    if (u < ofMedia) return TraceFromMedium(request, u / ofMedia, *glowing);
    ofLights = std::min(static_cast<float>((u - ofMedia) / (1 - ofMedia)), kOneMinusEpsilon);
  }
  TraceFromLight(request, ofLights, 1 - ofMedia);
}

}  // namespace lampyr
