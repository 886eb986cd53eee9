#include "integrators/bidirectional/bidirectional_integrator.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/stop.h"
#include "integrators/bidirectional/techniques.h"
#include "integrators/photon/photon_pass.h"
#include "integrators/photon/photon_settings.h"
#include "integrators/walk/footprint.h"
#include "integrators/walk/path_layers.h"

namespace lampyr {

void BidirectionalSample::SetCamera(ConnectedPath& path) const {
  path.t = static_cast<int>(camera.Count()) + 1;
  path.camera = camera.First(camera.Count());
  path.toLens = camera[0].toPrevious;
  path.lensFactors = camera[0].factors;
  path.atLens = camera[0].pdfForward;
}

void BidirectionalSample::SetLight(ConnectedPath& path, size_t count) const {
  path.s = static_cast<int>(count) + 1;
  path.light = light.vertices.First(count);
  path.end = lightEnd;
  path.endFactors = light.vertices[0].factors;
  path.toLight = light.vertices[0].toPrevious;
}

void BidirectionalSample::Report(ConnectedPath& path) const {
  if (!context.observer) return;
  if (path.t > 1) {
    path.merging = merging;
    path.connectionCount = connectionCount;
    path.continuing = static_cast<double>(continuing);
  }
  path.seenDensity = path.t > 1 ? seenDensity : path.atLens.value;
  path.splatCount = settings.splatCount;
  path.volume = &settings.photons.volume;
  path.flightPoints = settings.flightPoints.get();
  context.observer->Observe(path);
}

PathEnds BidirectionalSample::EndsOfConnection(size_t lightCount, const ReverseDensities& reverse, bool isSeen,
                                               double ratio) const {
  const PathVertex& first = light.vertices[0];
  const bool goesOn = lightCount > 1;
  const AreaDensity hit = goesOn ? first.PreviousReverse(first.eventReverse) : reverse.previous;
  return {.direct = lightEnd.direct.value,
          .hit = lightEnd.canBeHit ? hit.value : 0.0,
          .firstIsDelta = goesOn && first.scatteredDelta,
          .splatCount = isSeen ? settings.splatCount : 0.0,
          .flightRatio = ratio};
}

namespace {

// Merging radius of the first pass by default, in pixel footprints: a blur no wider than that of most pixel filters.
constexpr double kRadiusInPixels = 1;
// Upper bound of the merging radius, in radii of the scene: beyond it all photons are found.
constexpr double kMostRadius = 2;

}  // namespace

float BidirectionalSample::MergeRadiusAt(double footprint) const {
  const PhotonPass& pass = *context.gather;
  const auto size = static_cast<double>(Lighting().SceneSphere().radius);
  const double radius = settings.photons.radius > 0
                            ? static_cast<double>(pass.radius)
                            : kRadiusInPixels * std::sqrt(footprint) * static_cast<double>(pass.radiusScale);
  return radius < kLeastRadius * size ? 0.0f : static_cast<float>(std::min(radius, kMostRadius * size));
}

Merging BidirectionalSample::MergingAt(double distance, double footprint, const Point2& film) const {
  const auto probability = static_cast<double>(settings.counts.merging.At(film));
  if (!(probability > 0)) return {};
  // Parallel rays have no angle: they take the distance at which a field of view of 53 degrees is as wide as the image.
  if (context.scene.camera->ConnectsByDirection()) distance = std::sqrt(footprint * settings.filmPixels);
  const auto radius = static_cast<double>(MergeRadiusAt(footprint));
  if (!(radius > 0)) return {};
  return Merging::At(radius, distance, context.gather->lightPaths, lightPaths, settings.filmPixels, probability,
                     static_cast<double>(context.gather->radiusScale));
}

AreaDensity DensityAtLens(const Camera& camera, const Ray& ray, float geometryTerm, double distanceSquared) {
  Point2 film;
  const auto densities = camera.EvaluateRay(ray, &film);
  if (!densities) return AreaDensity(0);
  if (camera.ConnectsByDirection())
    return AreaDensity(static_cast<double>(densities->pdfPosition.value) * EdgeDensity(geometryTerm, 1).value);
  return SolidAngleDensity(densities->pdfDirection) * EdgeDensity(geometryTerm, distanceSquared);
}

namespace {

// Visitor of the light subpath.
class LightSide final : public WeightedLightPath {
 public:
  // `sampler`: of the light path.
  LightSide(BidirectionalSample& sample, Sampler& sampler)
      : WeightedLightPath(sample.context, sample.settings.connects, sample.lightPaths),
        sample_(sample),
        isConnected_(sample.settings.connects && !sample.context.isForPhotonsAlone &&
                     sample.context.scene.camera->ConnectsLightPaths()),
        sampler_(sampler),
        flightsBelow_(sample.context.photons ? FlightsBelow(sample.settings.photons.volume, sampler, kLightDimensions)
                                             : 1.0) {}

  bool WantsFlights() const override { return WantsBeams() || sample_.settings.flightPoints; }
  bool WantsBeams() const override { return flightsBelow_ < 1; }
  void Flew(LightPath& path, const PathState& state, const Flight& flight, const EmittedPhoton* photon) override {
    if (WantsBeams() && !context_.IsCounted(state.isDispersed))
      AddFlight(context_, sample_.settings.photons.volume, flightsBelow_, path, state, flight, *photon);
    hasLeftFirst_ = hasLeftFirst_ || path.vertices.Count() > 0;
    start_ = {flight.line.start, path.vertices.Count() == 0 && sample_.Lighting().IsAtInfinity(photon->light)};
    if (isConnected_ && sample_.settings.flightPoints)
      SplatFlight(sample_, start_, state, flight, *photon, sampler_, path);
  }
  // The path has flown on from its first vertex, so that the event there is set.
  bool HasLeftFirst() const { return hasLeftFirst_; }

  void Emitted(const EmittedPhoton& photon) override {
    if (isConnected_) SplatLight(sample_, photon);
  }
  bool FirstHit(const EmittedPhoton& photon, PathVertex& first) override {
    if (!WeightedLightPath::FirstHit(photon, first)) return false;
    sample_.lightEnd = End();
    if (context_.withOrigin) context_.photons->SetOrigin(OriginOf(sample_.Lighting(), photon, first));
    return true;
  }

 private:
  void OnWeighted(const LightPath& path) override {
    if (sample_.settings.merges) {
      AddDensities(path.vertices, sample_.settings.photons.volume, true, sample_.lightDensities);
      if (path.vertices.Count() == 1)
        sample_.lightDensities[0] = FirstDensities(End(), path.vertices.Last().IsInMedium());
    }
    if (isConnected_) SplatVertex(sample_, start_);
    const PathVertex& vertex = path.vertices.Last();
    if (context_.photons && vertex.storesPhotons && !context_.IsCounted(vertex.isDispersed) &&
        path.vertices.Count() <= PhotonList::kDeepest && !IsOnBeam(vertex, sample_.settings.photons.volume))
      context_.photons->Add(vertex, path.vertices.Count(), LabelsOfLast(context_, path.vertices), FlightRatio(vertex));
  }
  double FlightRatio(const PathVertex& vertex) const {
    if (!sample_.settings.flightPoints) return 0;
    return sample_.settings.flightPoints->RatioAt(vertex, vertex.toPrevious, start_.DistanceTo(vertex),
                                                  vertex.factors.forward);
  }

  BidirectionalSample& sample_;
  const bool isConnected_;
  Sampler& sampler_;
  const double flightsBelow_;  // AddFlight
  FlightStartPoint start_;     // of the last flight through a medium
  bool hasLeftFirst_ = false;
};

// Visitor of the camera subpath.
class CameraSide final : public PathVisitor {
 public:
  // `beam`, `kept`: storage of the thread.
  CameraSide(BidirectionalSample& sample, BeamVertex& beam, std::vector<SubpathDensities>& kept)
      : sample_(sample), beam_(beam), kept_(kept) {}

  void Escaped(const Subpath& path, const PathState& state) override {
    sample_.radiance += path.Count() == 0 ? SeeBackground(sample_, state) : HitInfiniteLights(sample_, state);
  }

  bool Met(const Subpath& path, const PathState& state, const RayHit& hit, const SurfacePoint& point,
           bool isLight) override {
    if (isLight) {
      sample_.radiance +=
          path.Count() == 0 ? SeeLightAt(sample_, state, hit, point) : HitLightAt(sample_, state, point);
    }
    if (sample_.context.isForSeenLight) return false;
    // Beyond the first wide scattering the radius is known before the vertex is made.
    if (state.hasScatteredWidely && sample_.merging && sample_.isMerged)
      sample_.context.gather->map->PrefetchCells(point.position, sample_.mergeRadius);
    return true;
  }

  // Photons in media along the ray. Each gets a vertex of the camera subpath of its own, the same as after a collision
  // there except for the density.
  void Flew(Subpath& path, const PathState& state, const Flight& flight) override {
    if (sample_.context.isForSeenLight) return;
    if (!sample_.context.gather || !sample_.isMerged || sample_.context.IsCounted(state.isDispersed)) return;
    if (static_cast<int>(path.Count()) >= sample_.settings.maxDepth) return;
    const PhotonMap& map = *sample_.context.gather->map;
    if (map.HasPoints()) MergePoints(map, path, state, flight);
    if (!map.Beams().IsEmpty()) MergeBeams(map, path, state, flight);
  }

  void Glowed(const Subpath& path, const PathState& state, const Color& radiance) override {
    Color seen = state.Throughput() * radiance;
    if (path.Count() == 0) seen *= sample_.context.seenShare;
    if (sample_.context.layers)
      AddFoundToLayers(sample_.context, path, state.event, sample_.context.outputs->OfMedia(), seen);
    sample_.radiance += seen;
    if (sample_.IsObserved()) [[unlikely]]
      ReportGlow(path, seen);
  }

  bool Collided(const Subpath&, const PathState&) override { return !sample_.context.isForSeenLight; }

  bool Arrived(Subpath& path, const PathState& state) override {
    PathVertex& vertex = path.Last();
    const size_t depth = path.Count();
    Weigh(path, state);
    if (vertex.isDelta) return true;
    const bool isCounted = sample_.context.IsCounted(vertex.isDispersed);
    const bool merges = CanMergePhotons(sample_) && !isCounted;
    const std::span<const uint32_t> photons = merges ? FindPhotonsToMerge(sample_) : std::span<const uint32_t>();
    if (!isCounted) sample_.radiance += EstimateDirectLight(sample_);
    if (!photons.empty()) FetchPathsOf(sample_, photons);
    if (sample_.isConnected) {
      // The two subpaths together have at most maxDepth scattering events.
      const size_t most =
          std::min(sample_.light.vertices.Count(), static_cast<size_t>(sample_.settings.maxDepth) - depth);
      for (size_t i = 1; i <= most; ++i) {
        CheckStop();
        sample_.radiance += Connect(sample_, i);
      }
    }
    if (!photons.empty()) sample_.radiance += Merge(sample_, photons);
    return true;
  }

  bool Scattered(const Subpath& path, const PathState&) override {
    const PathVertex& last = path.Last();
    sample_.couldMerge = sample_.couldMerge || (sample_.merging && last.CanMerge() && !last.scatteredDelta);
    return true;
  }
  float Found() const override { return sample_.radiance.Average(); }

 private:
  // For the pilot: no technique but that of camera paths finds light that media emit along them. Beyond a vertex where
  // camera paths may end, not all of them do.
  void ReportGlow(const Subpath& camera, const Color& seen) {
    size_t first = 0;
    while (first < camera.Count() && camera[first].isDelta) ++first;
    ConnectedPath path;
    path.sums.isBeyond = first < camera.Count() && camera[first].CanMerge();
    path.s = 0;
    path.t = static_cast<int>(camera.Count()) + 2;
    path.value = seen;
    path.sums.Of(path.sums.isBeyond ? BeyondOf(TechniqueGroup::Hit) : TechniqueGroup::Hit).Add(1);
    sample_.context.observer->Observe(path);
  }
  // Cost of merging with a beam, in merges with photons on surfaces.
  static constexpr uint64_t kPhotonsPerBeam = 4;

  // The state of the camera subpath that a vertex for one merge changes, and that is restored after it.
  struct Before {
    Merging merging;
    double continuesHere;
    double seenDensity;
    double flightRatio;
    bool lensSeesIt;
    size_t densities;  // number
  };
  bool IsTooDeep(const Subpath& path, size_t photonDepth) const {
    return photonDepth + path.Count() + 1 > static_cast<size_t>(sample_.settings.maxDepth) + 1;
  }
  void MergePoints(const PhotonMap& map, Subpath& path, const PathState& state, const Flight& flight) {
    const Before before = Keep();
    VolumeMerge merge;
    for (const BeamHit& hit : FindPhotonsAlong(map, state.ray, flight.t, sample_.lookup, sample_.context.counts)) {
      if (IsTooDeep(path, map[hit.index].depth)) continue;
      if (!SetPointVertex(sample_.context, state, flight, hit, path.Next(), merge)) continue;
      Extend(path, state, hit.t);
      if (sample_.merging) sample_.radiance += MergeInMedium(sample_, merge);
      Restore(path, before);
    }
  }
  void MergeBeams(const PhotonMap& map, Subpath& path, const PathState& state, const Flight& flight) {
    const Before before = Keep();
    const std::span<const BeamCrossing> crossings = CountedLookup(
        sample_.context.counts, [&] { return map.FindBeams(state.ray, flight.line, flight.t, sample_.lookup); });
    sample_.context.counts.foundPhotons += (kPhotonsPerBeam - 1) * crossings.size();
    for (const BeamCrossing& crossing : crossings) {
      if (IsTooDeep(path, map.Beams().StartOf(map.Beams()[crossing.beam]).depth)) continue;
      VolumeMerge merge;
      if (!SetCrossingVertex(sample_.context, state, flight, crossing, path.Next(), merge)) continue;
      Extend(path, state, static_cast<float>(crossing.t));
      if (sample_.merging && SetBeamOf(sample_, crossing, beam_, merge))
        sample_.radiance += MergeInMedium(sample_, merge);
      Restore(path, before);
    }
  }
  Before Keep() {
    const std::vector<SubpathDensities>& densities = sample_.cameraDensities;
    const size_t changed = std::min<size_t>(densities.size(), 2);  // by the next vertex
    kept_.assign(densities.end() - static_cast<std::ptrdiff_t>(changed), densities.end());
    return {sample_.merging,     sample_.continuesHere, sample_.seenDensity,
            sample_.flightRatio, sample_.lensSeesIt,    densities.size()};
  }
  // Adds the vertex that was made in the place of the next one, `t` along the ray.
  void Extend(Subpath& path, const PathState& state, float t) {
    path.Add();
    if (sample_.context.outputs) path.LabelLast(*sample_.context.outputs, TransportMode::Radiance, state.event);
    PathState arrived = state;
    arrived.length += t;
    arrived.factors = path.Last().factors;
    Weigh(path, arrived);
  }
  // Removes that vertex.
  void Restore(Subpath& path, const Before& before) {
    path.Drop();
    sample_.merging = before.merging;
    sample_.continuesHere = before.continuesHere;
    sample_.seenDensity = before.seenDensity;
    sample_.flightRatio = before.flightRatio;
    sample_.lensSeesIt = before.lensSeesIt;
    sample_.cameraDensities.resize(before.densities);
    std::copy(kept_.begin(), kept_.end(), sample_.cameraDensities.end() - static_cast<std::ptrdiff_t>(kept_.size()));
  }
  // Densities and weights of the last vertex, which the ray of `state` has found.
  void Weigh(Subpath& path, const PathState& state) {
    PathVertex& vertex = path.Last();
    const size_t depth = path.Count();
    if (depth == 1) {
      SetFirst(vertex, state);
    } else {
      if (depth == 2 && sample_.settings.flightPoints) [[unlikely]]
        SetFlightRatio(path, state);
      SetWeights(path[depth - 2], state, sample_.settings.connects, vertex, depth == 2 ? sample_.flightRatio : 0.0);
    }
    sample_.continuesHere =
        !state.hasScatteredWidely && vertex.CanMerge() ? static_cast<double>(sample_.continuing) : 1.0;
    // The radius grows along the path: where nothing is merged at the first vertex, nothing is merged later.
    if (sample_.seenDensity > 0 && !state.hasScatteredWidely && (depth == 1 || sample_.merging))
      SetMerging(static_cast<double>(state.length));
    if (sample_.merging) {
      AddDensities(path, sample_.settings.photons.volume, false, sample_.cameraDensities);
      if (depth == 1) sample_.cameraDensities[0].forward = sample_.seenDensity;
    }
  }
  void SetFlightRatio(const Subpath& path, const PathState& state) {
    const Vector3d way = path.Last().Position() - path[0].Position();
    sample_.flightRatio =
        sample_.settings.flightPoints->RatioAt(path[0], state.ray.direction, glm::length(way), state.factors.reverse);
  }
  void SetFirst(PathVertex& vertex, const PathState& state) {
    const AreaDensity atLens =
        DensityAtLens(*sample_.context.scene.camera, state.ray, vertex.GeometryTerm(vertex.toPrevious),
                      Sqr(static_cast<double>(state.length)));
    vertex.pdfForward = state.factors.forward * atLens;
    vertex.previousSolidAnglePerArea = {0};  // the lens is not hit
    // Light paths reach the vertex unless its surface is invisible to them, and are connected to the lens unless the
    // camera's densities are unknown, which leaves pdfForward at 0.
    const bool isSplatted =
        sample_.context.scene.camera->ConnectsLightPaths() && vertex.pdfForward.value > 0 && vertex.isSeenByIndirect;
    vertex.weight = PartialWeight::AtLens(vertex.pdfForward,
                                          isSplatted && sample_.settings.connects ? sample_.settings.splatCount : 0.0);
    sample_.lensSeesIt = isSplatted;
    if (sample_.context.gather) SetFootprint(vertex, state.ray, static_cast<double>(state.length), atLens);
  }
  // `seen`: density at the lens, without media.
  void SetFootprint(const PathVertex& vertex, const Ray& ray, double distance, AreaDensity seen) {
    const float cosTheta = vertex.GeometryTerm(vertex.toPrevious);
    if (!sample_.context.scene.camera->ConnectsLightPaths()) {
      const double area = PixelArea(*sample_.context.scene.camera, ray, sample_.settings.filmPixels, distance);
      seen = AreaDensity(area > 0 ? EdgeDensity(cosTheta, area * sample_.settings.filmPixels).value : 0);
    }
    if (!(seen.value > 0)) return;
    sample_.seenDensity = vertex.factors.forward * seen.value;
    firstFootprint_ = sample_.FootprintAt(cosTheta, seen);
    firstDistance_ = distance;
  }
  // Called at a vertex before which there are only deltas, which are taken as flat.
  void SetMerging(double distance) {
    double footprint = firstFootprint_;
    const bool isParallel = sample_.context.scene.camera->ConnectsByDirection();
    if (!isParallel) footprint *= distance / firstDistance_ * (distance / firstDistance_);
    sample_.mergeRadius = sample_.MergeRadiusAt(footprint);
    if (sample_.settings.photons.radius == 0) {
      const auto size = static_cast<double>(sample_.Lighting().SceneSphere().radius);
      // The radii of a camera of parallel rays are the same at all distances.
      sample_.perArea =
          isParallel
              ? 1.0f
              : static_cast<float>(firstFootprint_ / (firstDistance_ * firstDistance_) * size * size / footprint);
    }
    sample_.merging = sample_.MergingAt(distance, footprint, sample_.film);
  }

  BidirectionalSample& sample_;
  double firstFootprint_ = 0, firstDistance_ = 1;  // of the first hit
  BeamVertex& beam_;                               // storage
  std::vector<SubpathDensities>& kept_;
};

class BidirectionalIntegrator final : public Integrator {
 public:
  explicit BidirectionalIntegrator(const BidirectionalSettings& settings)
      : settings_(settings), lightPaths_(settings.counts.LightPaths()) {}

  TracedPaths Paths() const override { return TracedPaths::Both; }
  bool SeparatesSeenLight() const override { return true; }
  std::optional<PhotonSettings> Photons() const override {
    return settings_.merges ? std::optional(settings_.photons) : std::nullopt;
  }
  int Log2LightPaths() const override { return settings_.counts.log2LightPaths; }
  Color Sample(const Ray* ray, const SampleContext& context) const override;

 private:
  void Decide(const Ray& ray, BidirectionalSample& sample) const;

  BidirectionalSettings settings_;
  double lightPaths_;
};

// Reused by each thread, because vertices are large.
struct Workspace {
  LightPath light;
  Subpath camera;
  PhotonLookup lookup;
  PathDensities whole;
  std::vector<SubpathDensities> lightDensities, cameraDensities, kept;
  BeamVertex beam;
};

// The light's end of the sample's light path.
PathEnds EndsOf(const BidirectionalSample& sample, bool hasLeftFirst) {
  const PathVertex& first = sample.light.vertices[0];
  const bool goesOn = hasLeftFirst || sample.light.vertices.Count() > 1;
  PathEnds ends;
  ends.direct = sample.lightEnd.direct.value;
  ends.canBeHit = sample.lightEnd.canBeHit;
  if (ends.canBeHit && goesOn) ends.hit = first.PreviousReverse(first.eventReverse).value;
  ends.firstIsDelta = goesOn && first.scatteredDelta;
  return ends;
}

// The film point is random within the pixel, and its bits decide nothing else.
void BidirectionalIntegrator::Decide(const Ray& ray, BidirectionalSample& sample) const {
  Point2& film = sample.film;
  film = sample.context.film;
  const bool hasMasks = settings_.counts.HasMasks();
  // Beyond the edge of a film that goes all around, the point is one near the opposite edge.
  if (hasMasks) sample.context.scene.camera->EvaluateRay(ray, &film);
  const double connections = sample.ConnectionsPerLightPathAt(film);
  sample.connectionCount = connections * connections;
  sample.connectionsPerSample = lightPaths_ * connections;
  sample.isConnected = settings_.connects;
  if (!hasMasks) return;
  sample.continuing = settings_.counts.continuing.At(film);
  const uint64_t bits = MixBits(ShadowRays::DeciderOf(film.x, film.y));
  sample.isConnected =
      settings_.connects && UnitFloat(static_cast<uint32_t>(bits)) < settings_.counts.connecting.At(film);
  sample.isMerged = UnitFloat(static_cast<uint32_t>(bits >> 32)) < settings_.counts.merging.At(film);
}

Color BidirectionalIntegrator::Sample(const Ray* ray, const SampleContext& context) const {
  thread_local Workspace workspace;
  workspace.light.vertices.Clear();
  workspace.camera.Clear();
  workspace.light.vertices.SetSteadyReceivers(settings_.merges);
  workspace.camera.SetSteadyReceivers(settings_.merges);
  BidirectionalSample sample{.context = context,
                             .settings = settings_,
                             .light = workspace.light,
                             .camera = workspace.camera,
                             .lookup = workspace.lookup,
                             .whole = workspace.whole,
                             .lightDensities = workspace.lightDensities,
                             .cameraDensities = workspace.cameraDensities,
                             .lightPaths = lightPaths_};
  if (context.tracesLight && (settings_.connects || context.photons)) {
    LightSide visitor(sample, context.lightSampler ? *context.lightSampler : context.sampler);
    const auto trace = [&](const SampleContext& own) {
      TraceLightPath(own, settings_.maxDepth, kLightDimensions, workspace.light, visitor);
    };
    if (context.lightSampler) {
      trace(context.With(*context.lightSampler));
    } else {
      trace(context);
    }
    if (context.photons && workspace.light.vertices.Count() > 0)
      context.photons->KeepDensities(EndsOf(sample, visitor.HasLeftFirst()), workspace.lightDensities);
  }
  if (!ray) return Color(0.0f);
  Decide(*ray, sample);
  PathState state;
  state.ray = *ray;
  state.medium = context.scene.MediumOf(*ray);
  state.specular = Color(1.0f);
  CameraSide visitor(sample, workspace.beam, workspace.kept);
  const WalkSettings walk{.mode = TransportMode::Radiance,
                          .maxDepth = settings_.maxDepth,
                          .dimensions = kCameraDimensions,
                          .continuing = sample.continuing,
                          .seesFlights = settings_.merges,
                          .wantsBeams = settings_.merges,
                          .records = StartRecord(context)};
  Walk(context, walk, state, workspace.camera, visitor);
  if (walk.records) walk.records->EndPath(visitor.Found(), workspace.camera.Count() + 1);
  return sample.radiance;
}

}  // namespace

std::unique_ptr<Integrator> MakeBidirectionalIntegrator(const BidirectionalSettings& settings) {
  return std::make_unique<BidirectionalIntegrator>(settings);
}

namespace {

const Setting kMerge{
    .name = "merge", .help = "Merge camera vertices with photons nearby", .fallback = true, .without = "it is bdpt"};
const Setting kConnect{.name = "connect",
                       .help = "Connect vertices of camera and light paths",
                       .fallback = true,
                       .without = "it is bidirectional photon mapping"};

BidirectionalSettings SettingsOf(const IntegratorInput& input) {
  BidirectionalSettings settings;
  settings.maxDepth = MaxDepthOf(input.settings);
  settings.filmPixels = input.FilmPixels();
  settings.splatCount = input.splatCount;
  settings.shadowRays = ShadowRaysOf(input);
  if (input.counts) settings.counts = *input.counts;
  settings.flightPoints = FlightPoints::Of(input.scene);
  return settings;
}

std::unique_ptr<Integrator> CreateVcm(const IntegratorInput& input) {
  BidirectionalSettings settings = SettingsOf(input);
  settings.merges = input.settings.IsOn(kMerge.name);
  settings.connects = input.settings.IsOn(kConnect.name);
  if (!settings.connects) settings.flightPoints = nullptr;
  if (!settings.merges && !settings.connects)
    throw UsageError("--no-merge and --no-connect: vcm has nothing left to find light by");
  settings.photons = PhotonSettingsOf(input);
  settings.photons.startsWide = settings.counts.startsWide;
  UseBeams(input, settings.photons);
  // Without smooth materials connections find all light, and guided photons would add next to nothing.
  settings.photons.guided = settings.photons.guided && (!settings.connects || HasSmoothMaterial(input.scene));
  return MakeBidirectionalIntegrator(settings);
}

std::vector<std::string> BdptHints(const RenderScene& scene) {
  const std::string lights = DeltaLightsOfCaustics(scene);
  if (lights.empty()) return {};
  if (!scene.camera->ConnectsLightPaths()) {
    return {"light without extent (" + lights +
            " lights) that comes through smooth glass or off mirrors cannot be found, because no light path can be "
            "connected to the elements of this camera's lens; --integrator vcm and sppm find it"};
  }
  return {
      "light without extent (" + lights +
      " lights) that comes through smooth glass or off mirrors and is seen through or in them again cannot be found "
      "by connecting paths; --integrator vcm and sppm find it"};
}

}  // namespace

IntegratorType BdptIntegratorType() {
  IntegratorType type;
  type.name = "bdpt";
  type.help = "paths from the camera and the lights, each vertex of one connected to each of the other";
  type.settings = common_settings::kOfNextEvent;
  type.settings.insert(type.settings.end(), common_settings::kOfGuiding.begin(), common_settings::kOfGuiding.end());
  type.create = [](const IntegratorInput& input) { return MakeBidirectionalIntegrator(SettingsOf(input)); };
  type.counted = [](const Settings&) { return CountedTechniques{.lightPaths = true, .connections = true}; };
  type.hasTechniques = true;
  type.hints = BdptHints;
  return type;
}

IntegratorType VcmIntegratorType() {
  IntegratorType type;
  type.name = "vcm";
  type.help = "bdpt, and merging with photons near camera vertices";
  type.settings = common_settings::kOfNextEvent;
  type.settings.insert(type.settings.end(), common_settings::kOfGuiding.begin(), common_settings::kOfGuiding.end());
  type.settings.insert(type.settings.end(), photon_settings::kAll.begin(), photon_settings::kAll.end());
  type.settings.insert(type.settings.end(), {&kMerge, &kConnect});
  type.create = CreateVcm;
  type.gathersPhotons = [](const Settings& settings) { return settings.IsOn(kMerge.name); };
  type.counted = [](const Settings& settings) {
    return CountedTechniques{
        .lightPaths = true, .connections = settings.IsOn(kConnect.name), .merging = settings.IsOn(kMerge.name)};
  };
  type.hasTechniques = true;
  return type;
}

}  // namespace lampyr
