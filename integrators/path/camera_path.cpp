#include "integrators/path/camera_path.h"

#include <bit>

#include "integrators/path/lit_segment.h"
#include "integrators/walk/lens.h"
#include "integrators/walk/partial_weight.h"
#include "integrators/walk/path_layers.h"

namespace lampyr {

namespace {

class CameraPath final : public PathVisitor, NextEventVisitor {
 public:
  CameraPath(const SampleContext& context, const CameraPathSettings& settings, PhotonGatherer* gatherer)
      : context_(context),
        lighting_(*context.scene.lighting),
        settings_(settings),
        nextEvent_{settings.dimensions, false, settings.shadowRays},
        gatherer_(gatherer),
        emissionOnly_(context.isForSeenLight) {}

  void Escaped(const Subpath& path, const PathState& state) override {
    if (path.Count() == 0) {
      radiance_ += EscapedEmissionForCamera(context_, state.ray, state.specular * context_.seenShare);
      return;
    }
    for (size_t i = 0; i < lighting_.InfiniteCount(); ++i) {
      const auto found = lighting_.EvaluateEscaped(i, path.Last().receiver, state.ray.direction, context_.time, false);
      if (found) AddFound(path, state, *found);
    }
  }

  bool Met(const Subpath& path, const PathState& state, const RayHit& hit, const SurfacePoint& point,
           bool isLight) override {
    if (isLight && path.Count() == 0) {
      const Color seen = state.specular * context_.seenShare *
                         lighting_.EmissionForCamera(state.ray.direction, hit.t, point, context_.time);
      if (context_.layers)
        AddFoundToLayers(context_, path, state.event, context_.outputs->OfLight(lighting_.LightAt(point)), seen);
      radiance_ += seen;
    } else if (isLight) {
      const Receiver& receiver = path.Last().receiver;
      const float distance = glm::distance(point.position, receiver.position);
      const auto found =
          lighting_.EvaluateSamples(receiver, state.ray.direction, distance, point, context_.time, false);
      if (found) AddFound(path, state, *found);
    }
    return !emissionOnly_;
  }

  void Flew(Subpath& path, const PathState& state, const Flight& flight) override {
    segment_ = LitSegment();
    if (emissionOnly_ || static_cast<int>(path.Count()) >= settings_.maxDepth) return;
    if (context_.IsCounted(state.isDispersed)) return;
    if (gatherer_) radiance_ += gatherer_->GatherAlong(path, state, flight);
    if (!settings_.samplesLights) return;
    segment_ = LitSegment(context_.scene, state.ray, flight, path.Count() == 0);
    arrivesAfter_ = static_cast<double>(flight.t);
    if (!(segment_.Share() > 0)) return;
    const MediumTimes before = context_.mediumTimes ? *context_.mediumTimes : MediumTimes();
    const uint64_t rays = context_.counts.shadowRays;
    if (SampleSegment(path, state, flight) && context_.mediumTimes) [[unlikely]]
      CountSegment(before, context_.counts.shadowRays - rays);
  }

  void Glowed(const Subpath& path, const PathState& state, const Color& radiance) override {
    Color seen = state.Throughput() * radiance;
    if (path.Count() == 0) seen *= context_.seenShare;
    if (context_.layers) AddFoundToLayers(context_, path, state.event, context_.outputs->OfMedia(), seen);
    radiance_ += seen;
  }

  // A ray traced for emission alone ends at a collision: photons hold the light that is scattered there.
  bool Collided(const Subpath&, const PathState&) override { return !emissionOnly_; }

  bool Arrived(Subpath& path, const PathState& state) override {
    const PathVertex& vertex = path.Last();
    if (segment_.Share() > 0 || arrival_.segment.Share() > 0) [[unlikely]]
      SetArrival(vertex);
    if (vertex.isDelta || context_.IsCounted(vertex.isDispersed)) return true;
    const auto events = static_cast<int>(path.Count());
    const bool gathers = gatherer_ && vertex.GathersPhotons();  // in media the ray has gathered on its way
    if (gathers) gatherer_->Find(vertex, state.length);
    path_ = &path;
    if (SamplesLights(vertex))
      radiance_ += SampleDirectLight(context_, nextEvent_, vertex, events - 1, radiance_, *this);
    if (gathers) radiance_ += gatherer_->Gather(path, state.length);
    return true;
  }

  // Directions from which photons are gathered are still traced for the emission of the surface they hit, and of the
  // media on the way: next-event estimation alone would miss a panel that touches the floor, and misses all media.
  bool Scattered(const Subpath& path, const PathState& state) override {
    emissionOnly_ = !path.Last().scatteredDelta && Gathers(path.Last()) &&
                    state.pdfDirection.value <= static_cast<double>(settings_.gatherBelow);
    return !emissionOnly_ || (settings_.samplesLights && HasEmissionToFind());
  }

  float Found() const override { return radiance_.Average(); }
  const Color& Radiance() const { return radiance_; }

 private:
  // True if photons are gathered for the light that is scattered there.
  bool Gathers(const PathVertex& vertex) const {
    return vertex.GathersPhotons() || (vertex.IsInMedium() && gatherer_ && gatherer_->GathersInMedium(vertex));
  }
  bool SamplesLights(const PathVertex& vertex) const { return settings_.samplesLights || !Gathers(vertex); }

  bool HasEmissionToFind() const { return lighting_.HasLightThatCanBeHit() || settings_.mediaGlow; }

  // A vertex in a medium at which the walk has collided, with the data that determine the density of sampling its
  // distance for a light.
  struct Arrival {
    LitSegment segment;
    double t = 0;
    double collision = 0;  // density of a collision there (EdgeFactors::forward)
    uint64_t seed = 0;     // of the apexes' random numbers

    // The density of sampling the distance for this light, over that of a collision.
    double RatioOf(const LightingServices& lighting, uint32_t light, int patch) const {
      if (!(segment.Share() > 0)) return 0;
      Rng apex(seed, light);
      return segment.Density(lighting, light, patch, t, apex.NextPoint2()) / collision;
    }
  };

  void SetArrival(const PathVertex& vertex) {
    arrival_ = Arrival();
    if (vertex.IsInMedium() && segment_.Share() > 0) {
      const Point3& at = vertex.point.position;
      arrival_ = {segment_, arrivesAfter_, vertex.factors.forward,
                  MixBits(ShadowRays::DeciderOf(at.x, at.y)) ^ std::bit_cast<uint32_t>(at.z)};
    }
    segment_ = LitSegment();
  }

  // Adds the cost of sampling a segment to the counts. `before`: times before the segment. `rays`: shadow rays of the
  // segment.
  void CountSegment(const MediumTimes& before, uint64_t rays) const {
    // Time to estimate the lights along a segment, measured in scenes/lighthouse and prism.
    constexpr double kNanoseconds = 350;
    MediumTimes& times = *context_.mediumTimes;
    times.segments += kNanoseconds + times.connections - before.connections;
    times.segmentRays += static_cast<double>(rays);
    times.connections = before.connections;
  }

  // Samples a distance on the ray for a light, and adds direct light from the vertex there. False: no distance is
  // sampled on this ray, which is decided at random first.
  bool SampleSegment(Subpath& path, const PathState& state, const Flight& flight) {
    const auto edge = static_cast<int>(path.Count());
    const auto pair = [&](uint32_t which) {
      context_.sampler.SetDimension(settings_.dimensions.OfSegment(edge, which));
      return context_.sampler.Get2D();
    };
    const Point2 choice = pair(dimensions::kSegmentChoice), uApex = pair(dimensions::kSegmentApex);
    const uint64_t decider = MixBits(ShadowRays::DeciderOf(choice.x, choice.y));
    if (segment_.Share() < 1 && UnitFloat(static_cast<uint32_t>(decider)) >= segment_.Share()) return false;
    const auto sample = segment_.Generate(lighting_, choice, uApex);
    if (!sample) return true;
    const auto point = PointOnFlight(context_, flight, sample->t, decider);
    if (!point) return true;
    PathVertex& vertex = path.Next();
    MakeVertexInMedium(context_.scene, point->position, state.ray.direction, point->index,
                       {point->coefficients.scattering, point->medium->Asymmetry()}, point->coefficients.Extinction(),
                       vertex);
    vertex.factors = point->factors;
    const Color scale =
        point->transmittance / static_cast<float>(static_cast<double>(segment_.Share()) * sample->density);
    vertex.diffuse = state.diffuse * scale;
    vertex.specular = state.specular * scale;
    sampledFor_ = &*sample;
    sampled_ = &vertex;
    NextEventSettings settings = nextEvent_;
    settings.learns = false;
    path.Add();  // for the connection alone
    path_ = &path;
    if (context_.outputs) path.LabelLast(*context_.outputs, TransportMode::Radiance, state.event);
    radiance_ +=
        SampleLight(context_, settings, vertex, sample->light, pair(dimensions::kSegmentLight), radiance_, *this);
    path.Drop();
    sampledFor_ = nullptr;
    return true;
  }

  // A light found by BSDF sampling, weighted against next-event estimation.
  void AddFound(const Subpath& path, const PathState& state, const FoundLight& found) {
    const PathVertex& last = path.Last();
    const Color diffuse = state.diffuse * found.evaluation.diffuse;
    const Color specular = state.specular * found.evaluation.specular;
    Color radiance = diffuse + specular;
    if (!last.scatteredDelta && SamplesLights(last)) {
      const PdfSolidAngle direction(static_cast<float>(state.pdfDirection.value * state.factors.forward));
      const PdfSolidAngle direct = found.selection * found.evaluation.pdfDirect;
      if (arrival_.segment.Share() > 0) {
        const double along = arrival_.RatioOf(lighting_, found.light, found.patch) *
                             static_cast<double>(found.evaluation.pdfDirect.value);
        radiance *= Weight(static_cast<double>(direction.value), static_cast<double>(direct.value), along);
      } else {
        radiance *= PowerHeuristic(direction, direct);
      }
    }
    if (context_.layers) {
      const ScatteringParts event{state.event.ofDiffuse, state.event.ofSpecular, diffuse, specular};
      AddFoundToLayers(context_, path, event, context_.outputs->OfLight(found.light), radiance);
    }
    radiance_ += radiance;
  }

  float Weigh(const LightConnection& light) override {
    const DirectSample& direct = light.direct;
    if (sampledFor_ || arrival_.segment.Share() > 0) return WeighInMedium(light);
    if (direct.isDelta) return 1;
    return PowerHeuristic(direct.selection * direct.sample->pdfDirect,
                          static_cast<float>(light.factors.forward) * light.f.pdfForward);
  }

  // MIS weight of next-event estimation at a vertex in a medium, which both a collision and distance sampling for a
  // light can make. Densities of the vertex are relative to that of a collision.
  float WeighInMedium(const LightConnection& light) const {
    const DirectSample& direct = light.direct;
    const auto pdfDirect = static_cast<double>(direct.sample->pdfDirect.value);
    const double hit = direct.isDelta ? 0.0 : light.factors.forward * static_cast<double>(light.f.pdfForward.value);
    double own, other;
    if (sampledFor_) {
      own = segment_.Density(*sampledFor_) / sampled_->factors.forward * pdfDirect;
      other =
          static_cast<double>(lighting_.SelectionProbability(sampled_->receiver, direct.light, direct.patch).value) *
          pdfDirect;
    } else {
      own = static_cast<double>(direct.selection.value) * pdfDirect;
      other = arrival_.RatioOf(lighting_, direct.light, direct.patch) * pdfDirect;
    }
    return Weight(own, other, hit);
  }

  // Weight of the technique with the density `own` against two others, by the power heuristic.
  static float Weight(double own, double other, double third) {
    return static_cast<float>(Mis(own) / (Mis(own) + Mis(other) + Mis(third)));
  }
  void Arrived(const LightConnection& light, const Color&, const Color& contribution) override {
    if (context_.layers)
      AddFoundToLayers(context_, *path_, light.Parts(path_->Last()), context_.outputs->OfLight(light.direct.light),
                       contribution);
  }

  const SampleContext& context_;
  const LightingServices& lighting_;
  const CameraPathSettings& settings_;
  const NextEventSettings nextEvent_;
  PhotonGatherer* gatherer_;
  bool emissionOnly_;        // the ray is traced for emission alone: other light from there is gathered
  LitSegment segment_;       // segment of the last ray
  double arrivesAfter_ = 0;  // distance at which the walk ends on that ray
  Arrival arrival_;          // at the last vertex
  // Set while a vertex with a distance sampled for a light is connected:
  const Subpath* path_ = nullptr;  // lights are sampled at its last vertex
  const LitSegment::Sample* sampledFor_ = nullptr;
  const PathVertex* sampled_ = nullptr;
  Color radiance_;
};

}  // namespace

Color TraceCameraPath(const SampleContext& context, const CameraPathSettings& settings, const Ray& ray,
                      PhotonGatherer* gatherer) {
  thread_local Subpath path(false);
  path.Clear();
  PathState state;
  state.ray = ray;
  state.medium = context.scene.MediumOf(ray);
  state.specular = Color(1.0f);
  CameraPath visitor(context, settings, gatherer);
  const WalkSettings walk{.mode = TransportMode::Radiance,
                          .maxDepth = settings.maxDepth,
                          .dimensions = settings.dimensions,
                          .materialsAfterWide = settings.materialsAfterWide,
                          .seesFlights = true,
                          .wantsBeams = gatherer != nullptr,
                          .records = StartRecord(context)};
  Walk(context, walk, state, path, visitor);
  if (walk.records) walk.records->EndPath(visitor.Found(), path.Count() + 1);
  return visitor.Radiance();
}

}  // namespace lampyr
