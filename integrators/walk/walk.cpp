#include "integrators/walk/walk.h"

#include <cmath>
#include <limits>
#include <new>
#include <optional>
#include <type_traits>

#include "base/stop.h"

namespace lampyr {

namespace {

// Survival probability of Russian roulette ([Veach97 §10.4.1]): the square root of the largest channel of the
// throughput, without the scaling of `scale` (of refraction, and of guides). 1 for the first scattering event, so that
// a light seen in a mirror stays free of noise.
//
// By the square root a surviving path keeps a throughput of the root and not of 1, so that rare long paths weigh less.
// In closed boxes this is 20 % more efficient than the throughput itself as the probability, although paths are longer.
float SurvivalProbability(const Color& throughput, float scale, int depth) {
  if (depth < 2) return 1;
  return std::min(1.0f, std::sqrt(throughput.Max() * scale));
}

bool Survives(const SampleContext& context, uint32_t dimension, float survival, PathState& state) {
  state.lastSurvival = survival;
  if (survival >= 1) return true;
  context.sampler.SetDimension(dimension);
  if (context.sampler.Get1D() >= survival) return false;
  state.diffuse /= survival;
  state.specular /= survival;
  return true;
}

// The roulette of WalkSettings::continuing. The Russian roulette that follows compares to what this one leaves.
bool Continues(const SampleContext& context, uint32_t dimension, float probability, PathState& state) {
  if (!Survives(context, dimension, probability, state)) return false;
  state.pdfDirection = static_cast<double>(probability) * state.pdfDirection;
  state.emitted /= probability;
  state.most /= probability;
  return true;
}

// value = make(), constructed in its place: a copy of what was just written field by field stalls on store forwarding.
template <class T, class Make>
void MakeInPlace(T& value, const Make& make) {
  static_assert(std::is_trivially_destructible_v<T>);
  ::new (static_cast<void*>(&value)) T(make());
}

// Side for PathGuide::Find. An opaque surface has one on either side; the paths on both sides of a transmissive surface
// share one, so that either walk finds the density of the other.
uint8_t SideOf(const Vertex& vertex) {
  if (vertex.IsInMedium() || !vertex.receiver.HasNormal()) return GuideSideOf(Normal3(0.0f));
  return GuideSideOf(vertex.bsdf.IsTransmissive() ? vertex.point.Ng : vertex.receiver.normal);
}

// Roulette by what was learned at the place of the vertex, of a camera path. nullopt: nothing was.
[[gnu::noinline]] std::optional<bool> SurvivesAsLearned(const SampleContext& context, uint32_t dimension,
                                                        const PathVertex& vertex, PathState& state) {
  if (vertex.isDelta || !vertex.bsdf.IsWide()) return std::nullopt;
  // The throughput of the path that arrives, and not of the direction it goes on in: a guide gives directions from
  // which much light comes a small one.
  const float learned = context.scene.roulette->Survival(vertex.point.position, SideOf(vertex),
                                                         vertex.Throughput().Average(), state.perNoise);
  if (!(learned > 0)) return std::nullopt;
  if (!(state.Throughput().Max() > 0)) return false;  // nothing can be found any more
  // No path carries more than one that nothing ends: light of which nothing was known is not found as a bright dot.
  const float scale = state.etaScale * state.guidance;
  const float survival = std::min(std::max(learned, state.Throughput().Max() * scale / state.most), 1.0f);
  if (!Survives(context, dimension, survival, state)) return false;
  state.emitted = std::max(state.Throughput().Max() * scale, std::numeric_limits<float>::min());
  return true;
}

void SetGuide(const RenderScene& scene, Vertex& vertex) {
  const bool isGuided = scene.guide && !vertex.isDelta && vertex.bsdf.IsWide();
  vertex.SetGuide(isGuided ? scene.guide->Find(vertex.point.position, SideOf(vertex)) : nullptr);
}

// Makes a vertex of a hit whose point is set: BSDF, receiver, visibility. False: the surface has no material and is
// black, and paths end there.
// `medium`: in which the ray arrives.
bool MakeVertex(const RenderScene& scene, const std::vector<std::shared_ptr<const Material>>& materials, const Ray& ray,
                const RayHit& hit, int32_t medium, Vertex& vertex) {
  const GeometryAttributes& attributes = scene.geometry->Attributes(hit.primitive);
  const Material* material = attributes.material >= 0 ? materials[attributes.material].get() : nullptr;
  if (!material) return false;
  const SurfacePoint& point = vertex.point;
  vertex.toPrevious = -ray.direction;
  MakeInPlace(vertex.bsdf, [&] { return material->GetBsdf(point, vertex.toPrevious); });
  const Normal3& Ns = vertex.bsdf.ShadingFrame().z;  // by reference: a copy of what was just written stalls
  vertex.receiver = {point.position, glm::dot(Ns, vertex.toPrevious) < 0 ? -Ns : Ns, vertex.bsdf.IsTransmissive(),
                     attributes.link};
  // The normal of a strand is towards the path that arrives: the lights would be selected in another way for a path
  // that comes from one of them.
  if (point.strand != Strand::None) [[unlikely]]
    vertex.receiver.normal = Normal3(0.0f);
  vertex.coverage = attributes.alpha ? attributes.alpha->Alpha(point.uv, point.position, point.Ng) : 1.0f;
  vertex.isDelta = vertex.bsdf.IsDelta();
  if (!scene.media.empty()) [[unlikely]] {  // nothing reads these otherwise
    // A path leaves an opaque surface on the side on which it was hit, in the medium of the ray: an open surface, such
    // as a floor or a panel, may be hit from both sides, whatever medium it declares on the other one.
    const bool separates = SeparatesMedia(attributes) && vertex.bsdf.IsTransmissive();
    vertex.insideMedium = separates ? attributes.insideMedium : medium;
    vertex.outsideMedium = separates ? attributes.outsideMedium : medium;
    vertex.extinction = Color(1.0f);
  }
  vertex.storesPhotons = (!vertex.isDelta || !material->IsAlwaysDelta()) && material->MayGatherPhotons();
  vertex.isSeenByCamera = (attributes.visibility & visibility::kCamera) != 0;
  vertex.isSeenByIndirect = (attributes.visibility & visibility::kIndirect) != 0;
  SetGuide(scene, vertex);
  return true;
}

// The rounding error of a position in float. Not inlined: GCC 12 takes the conversion to float and back of two lanes
// for the identity.
[[gnu::noinline]] Vector3 RestOf(const Point3d& exact, const Point3& rounded) {
  return Vector3(exact - Point3d(rounded));
}

// A surface point that differs from the flight's end by more than rounding has no residual: its surface is intersected
// in float alone.
void SetResidual(const Flight& flight, Vertex& vertex) {
  const Vector3d residual = flight.end - Point3d(vertex.point.position);
  const double size = static_cast<double>(MaxAbsComponent(vertex.point.position) + flight.t);
  constexpr double kRounding = 1e-5;
  vertex.residual = glm::length(residual) <= kRounding * size ? Vector3(residual) : Vector3(0.0f);
}

}  // namespace

void Subpath::LabelsBeyond(const OutputPlan& plan, TransportMode mode, const ScatteringParts& event,
                           PathLabels& beyond) const {
  if (count_ == 0) {
    beyond.Set(start_);
  } else {
    LabelsAfter(plan, mode, LabelsAt(count_ - 1), event, beyond);
  }
}

void Subpath::LabelLast(const OutputPlan& plan, TransportMode mode, const ScatteringParts& event) {
  if (labels_.size() < vertices_.size()) labels_.resize(vertices_.size());
  --count_;
  LabelsBeyond(plan, mode, event, labels_[keepsAll_ ? count_ : count_ % 2]);
  ++count_;
}

void MakeVertexInMedium(const RenderScene& scene, const Point3d& position, const Vector3& direction, int32_t medium,
                        const PhaseBsdf& phase, const Color& extinction, Vertex& vertex) {
  MakeInPlace(vertex.point, [&] {
    SurfacePoint point;
    point.position = Point3(position);
    point.Ng = point.Ns = Normal3(0.0f);
    return point;
  });
  vertex.residual = RestOf(position, vertex.point.position);
  vertex.toPrevious = -direction;
  MakeInPlace(vertex.bsdf, [&] { return Bsdf(Frame::FromNormal(vertex.toPrevious), vertex.toPrevious, phase); });
  vertex.receiver = {vertex.point.position, Normal3(0.0f), true, 0};
  vertex.coverage = 1;
  vertex.insideMedium = vertex.outsideMedium = medium;
  vertex.extinction = extinction;
  vertex.isDelta = phase.scattering.IsBlack();
  vertex.storesPhotons = !vertex.isDelta;
  vertex.isSeenByCamera = vertex.isSeenByIndirect = true;
  SetGuide(scene, vertex);
}

namespace {

// Sets the event for labels. Not inlined: renders without layers are not to pay for them.
[[gnu::noinline]] void SetEvent(const PathVertex& vertex, const BsdfSample& sample, bool isFromLight,
                                PathState& state) {
  const Color diffuse = isFromLight ? vertex.diffuse : vertex.Throughput();
  const Color specular = isFromLight ? vertex.specular : diffuse;
  state.event =
      PartsOf(vertex, sample.wi, sample.isDelta, diffuse * sample.weightDiffuse, specular * sample.weightSpecular);
}

}  // namespace

bool Scatter(const SampleContext& context, const WalkSettings& settings, int index, PathVertex& vertex,
             PathState& state) {
  const bool isFromLight = settings.mode == TransportMode::Importance;
  const int block = isFromLight ? index + 1 : index;
  Sampler& sampler = context.sampler;
  sampler.SetDimension(settings.dimensions.Of(block, dimensions::kLobe));
  const float uLobe = sampler.Get1D();
  const BsdfSample sample = vertex.Sample(uLobe, sampler.Get2D(), settings.mode, state.lastGuidance);
  if (sample.isDispersion) [[unlikely]] {
    state.isDispersed = true;
    if (context.disperses) *context.disperses = true;
  }
  if (!sample) return false;
  state.guidance *= state.lastGuidance.forward;
  if (isFromLight) {
    const float correction = vertex.ArrivalCorrection(vertex.toPrevious) * vertex.DepartureCorrection(sample.wi);
    state.diffuse = (vertex.diffuse * sample.weightDiffuse + vertex.specular * sample.weightSpecular) * correction;
    state.specular = state.diffuse;
  } else {
    const Color throughput = vertex.Throughput();
    state.diffuse = throughput * sample.weightDiffuse;
    state.specular = throughput * sample.weightSpecular;
    if (sample.isTransmission) state.etaScale *= Sqr(sample.eta);
  }
  const EventDensities densities = DensitiesOf(sample, vertex.ScatteringCosine(vertex.toPrevious),
                                               vertex.ScatteringCosine(sample.wi), settings.mode);
  vertex.scatteredDelta = sample.isDelta;
  const bool mayEnd = settings.continuing < 1 && !state.hasScatteredWidely && !sample.isDelta && vertex.CanMerge();
  state.hasScatteredWidely |= !sample.isDelta;
  if (context.outputs) [[unlikely]]
    SetEvent(vertex, sample, isFromLight, state);
  vertex.eventForward = densities.forward;
  vertex.eventReverse = densities.reverse;
  state.pdfDirection = densities.forward;
  if (!(state.pdfDirection.value > 0)) return false;
  state.ray.origin = OffsetRayOrigin(vertex.point.position, vertex.point.positionError, vertex.point.Ng, sample.wi);
  state.ray.direction = sample.wi;
  state.ray.tMax = kInfinity;
  if (!context.scene.media.empty()) [[unlikely]]
    state.medium = vertex.MediumTowards(sample.wi);
  if (mayEnd)
    return Continues(context, settings.dimensions.Of(block, dimensions::kRoulette), settings.continuing, state);
  if (!settings.hasRoulette) return true;
  if (context.scene.roulette && !isFromLight) {
    if (const auto survives =
            SurvivesAsLearned(context, settings.dimensions.Of(block, dimensions::kRoulette), vertex, state))
      return *survives;
  }
  const Color carried = isFromLight ? state.diffuse : state.Throughput();
  // The throughput that the path would have without a guide: guided paths have a small throughput where much light is
  // expected.
  const float survival = SurvivalProbability(carried / state.emitted, state.etaScale * state.guidance, index + 1);
  return Survives(context, settings.dimensions.Of(block, dimensions::kRoulette), survival, state);
}

namespace {

// Where the ray of `state` starts.
EdgeEnd StartOf(const SampleContext& context, const PathState& state, const Subpath& path) {
  if (path.Count() > 0) return path.Last().EndTowards(state.ray.direction);
  EdgeEnd start{Point3d(state.ray.origin) + Vector3d(state.fromOrigin), state.medium};
  const bool isOnSurface = state.fromOrigin != Vector3(0.0f);
  if (state.medium >= 0 && !isOnSurface) {
    const Color extinction = context.scene.media[static_cast<size_t>(state.medium)]->At(state.ray.origin).Extinction();
    start.isFine = EdgeEnd::IsFineIn(extinction, state.ray.origin);
  }
  return start;
}

// Traces the ray of `state` through participating media. True if it hits a surface. Not inlined: scenes without media
// are not to pay for media.
[[gnu::noinline]] bool FlyOn(const SampleContext& context, const WalkSettings& settings, uint32_t kinds,
                             PathState& state, Subpath& path, PathVisitor& visitor, Flight& flight) {
  const bool isFromLight = settings.mode == TransportMode::Importance;
  const auto count = static_cast<int>(path.Count());
  Fly(context, state.ray, kinds, StartOf(context, state, path), state.Throughput(),
      settings.dimensions.OfFlight(isFromLight ? count + 1 : count), settings.wantsBeams, flight);
  if (settings.seesFlights && !flight.spans.empty()) visitor.Flew(path, state, flight);
  if (!flight.emission.IsBlack() && !context.IsCounted(state.isDispersed)) visitor.Glowed(path, state, flight.emission);
  state.passed = flight.passed;
  state.factors = flight.factors;
  state.medium = flight.medium;
  return flight.isHit;
}

// Records the event at `vertex`, by which the path goes on; true if it did.
// `foundOnArrival`, `found`: RecordedEvent.
[[gnu::noinline]] bool Record(const Subpath& path, const PathState& state, float foundOnArrival, float found,
                              PathRecords& records) {
  const PathVertex& vertex = path.Last();
  if (!vertex.bsdf.IsWide() || !records.HasRoom()) return false;
  RecordedEvent event;
  event.position = vertex.point.position;
  event.direction = state.ray.direction;
  event.side = SideOf(vertex);
  event.guidance = state.lastGuidance.forward;
  event.throughput = vertex.Throughput().Average();
  event.survival = state.lastSurvival;
  event.raysBefore = static_cast<uint32_t>(path.Count());
  if (!vertex.scatteredDelta) {
    event.unguided = static_cast<float>(vertex.eventForward.value) / state.lastGuidance.forward;
    event.unguidedReverse = static_cast<float>(vertex.eventReverse.value) / state.lastGuidance.reverse;
  }
  event.foundOnArrival = foundOnArrival;
  event.foundBefore = found;
  event.toPrevious = vertex.toPrevious;
  if (path.Count() > 1)
    event.previousDistance = glm::distance(vertex.point.position, path[path.Count() - 2].point.position);
  records.Add(event);
  return true;
}

}  // namespace

PathRecords* StartRecord(const SampleContext& context) {
  if (!context.records) [[likely]]
    return nullptr;
  const uint64_t decider = MixBits(uint64_t{context.pixel} << 32 | context.sample);
  if (!context.records->Wants(decider)) return nullptr;
  context.records->StartPath(context.pixel, context.sample);
  return context.records;
}

namespace {

inline bool MakeSurfaceVertex(const SampleContext& context, const WalkSettings& settings, const PathState& state,
                              const RayHit& hit, bool hasSteadyReceivers, PathVertex& vertex) {
  const auto* materials = &context.scene.materials;
  if (settings.materialsAfterWide && state.hasScatteredWidely)
    materials = context.scene.wavelengths ? &context.scene.tunedAfterWide : settings.materialsAfterWide;
  if (!MakeVertex(context.scene, *materials, state.ray, hit, state.medium, vertex)) return false;
  if (context.scene.wavelengths) [[unlikely]]
    vertex.bsdf.SetLane(context.lane);
  if (hasSteadyReceivers) {
    const Material& material = *(*materials)[context.scene.geometry->Attributes(hit.primitive).material];
    vertex.receiver.isTransmissive = material.MayTransmit();
    if (material.HasMappedNormal()) [[unlikely]]
      vertex.receiver.normal = Normal3(0.0f);
  }
  return true;
}

// Adds the vertex that Subpath::Next gave, with what the path has carried to it.
inline void Append(const SampleContext& context, TransportMode mode, const PathState& state, PathVertex& vertex,
                   Subpath& path) {
  vertex.factors = state.factors;
  vertex.diffuse = state.diffuse;
  vertex.specular = state.specular;
  vertex.isDispersed = state.isDispersed;
  path.Add();
  if (context.outputs) [[unlikely]]
    path.LabelLast(*context.outputs, mode, state.event);
}

}  // namespace

void Walk(const SampleContext& context, const WalkSettings& settings, PathState& state, Subpath& path,
          PathVisitor& visitor) {
  bool isRecorded = false;  // the last event
  if (context.scene.roulette && settings.mode == TransportMode::Radiance)
    state.perNoise = context.scene.roulette->PerNoise(context.pixel);
  const GeometryScene& geometry = *context.scene.geometry;
  const bool hasMedia = !context.scene.media.empty();
  std::optional<Flight> flight;  // in scenes with media
  for (;;) {
    CheckStop();
    const bool isCameraRay = settings.mode == TransportMode::Radiance && path.Count() == 0;
    ++(isCameraRay ? context.counts.cameraRays : context.counts.indirectRays);
    const uint32_t kinds = isCameraRay ? visibility::kCamera : visibility::kIndirect;
    RayHit hit;
    bool isHit, collides = false;
    if (!hasMedia) [[likely]] {
      isHit = context.scene.Intersect(state.ray, kinds, hit, state.passed);
    } else {
      isHit = FlyOn(context, settings, kinds, state, path, visitor, flight.emplace());
      hit = flight->hit;
      collides = flight->collidesWith != nullptr;
    }
    if (isRecorded) [[unlikely]]
      settings.records->SetDistance(collides ? flight->t : isHit ? hit.t : kInfinity);
    state.diffuse *= state.passed;
    state.specular *= state.passed;
    if (!isHit && !collides) {
      if (!context.IsCounted(state.isDispersed)) visitor.Escaped(path, state);
      return;
    }
    state.length += collides ? flight->t : hit.t;
    PathVertex& vertex = path.Next();
    if (!collides) [[likely]] {
      MakeInPlace(vertex.point, [&] { return geometry.GetSurfacePoint(state.ray, hit); });
      if (flight) SetResidual(*flight, vertex);
      if (!visitor.Met(path, state, hit, vertex.point,
                       geometry.Attributes(hit.primitive).light >= 0 && !context.IsCounted(state.isDispersed)))
        return;
    } else if (!visitor.Collided(path, state)) {
      return;
    }
    const auto index = static_cast<int>(path.Count());
    if (index >= settings.maxDepth) return;
    if (collides) [[unlikely]] {
      const MediumCoefficients& here = flight->coefficients;
      MakeVertexInMedium(context.scene, flight->end, state.ray.direction, flight->medium,
                         {here.scattering, flight->collidesWith->Asymmetry()}, here.Extinction(), vertex);
    } else {
      if (!MakeSurfaceVertex(context, settings, state, hit, path.HasSteadyReceivers(), vertex)) return;
    }
    Append(context, settings.mode, state, vertex, path);
    const float foundOnArrival = settings.records ? visitor.Found() : 0;
    if (!visitor.Arrived(path, state)) return;
    if (!Scatter(context, settings, index, path.Last(), state)) return;
    isRecorded = settings.records && Record(path, state, foundOnArrival, visitor.Found(), *settings.records);
    if (!visitor.Scattered(path, state)) return;
  }
}

}  // namespace lampyr
