// Vertex merging: photons of other light paths near a vertex of the camera subpath.
#include <cmath>

#include "integrators/bidirectional/techniques.h"
#include "integrators/bidirectional/weights.h"
#include "integrators/photon/merge_bias.h"
#include "integrators/photon/photon_pass.h"
#include "integrators/walk/path_layers.h"

namespace lampyr {

namespace {

// Photons of a lookup whose paths are fetched ahead; they and their paths take less than half of a first-level cache.
constexpr size_t kFetched = 64;

// The path of a merge without its photon.
ConnectedPath MergedPath(const BidirectionalSample& sample, const Photon& photon, const Color& value, double weight) {
  ConnectedPath path;
  sample.SetCamera(path);
  path.isMerged = true;
  path.s = static_cast<int>(photon.depth) + 1;
  path.toLight = photon.toPrevious;
  path.merging = sample.merging;
  path.connectionCount = sample.connectionCount;
  path.splatCount = sample.settings.splatCount;
  path.continuing = static_cast<double>(sample.continuing);
  path.volume = &sample.settings.photons.volume;
  path.flightPoints = sample.settings.flightPoints.get();
  path.seenDensity = sample.seenDensity;
  path.value = value;
  path.weight = weight;
  return path;
}

// `reverse`: density of the photon's previous vertex, or of the light's point. `kept`: of its path.
TechniqueSums SumsOf(const BidirectionalSample& sample, const Photon& photon, const PathEnds& kept, AreaDensity reverse,
                     double flightRatio) {
  const double hit = !kept.canBeHit ? 0.0 : photon.depth > 1 ? kept.hit : reverse.value;
  return sample.whole.Sums({.direct = kept.direct,
                            .hit = hit,
                            .firstIsDelta = kept.firstIsDelta && photon.depth > 1,
                            .splatCount = sample.lensSeesIt ? sample.settings.splatCount : 0.0,
                            .flightRatio = flightRatio},
                           0, photon.depth);
}

// FlightPoints::RatioAt of the vertex that the camera sees.
double FlightRatioOf(const BidirectionalSample& sample, const VolumeMerge& merge) {
  return sample.camera.Count() == 1 ? merge.flightRatio : sample.flightRatio;
}

void ReportMerge(const BidirectionalSample& sample, const Photon& photon, AreaDensity reverse, const Color& value,
                 double weight, double flightRatio) {
  ConnectedPath path = MergedPath(sample, photon, value, weight);
  if (sample.WantsSums())
    path.sums = SumsOf(sample, photon, sample.context.gather->map->EndsOf(photon), reverse, flightRatio);
  sample.context.observer->ObserveMerge(path, photon);
}

void ReportMerge(const BidirectionalSample& sample, const VolumeMerge& merge, AreaDensity reverse, const Color& value,
                 double weight) {
  const double ratio = FlightRatioOf(sample, merge);
  if (!merge.beam) return ReportMerge(sample, *merge.photon, reverse, value, weight, ratio);
  ConnectedPath path = MergedPath(sample, *merge.photon, value, weight);
  if (sample.WantsSums()) path.sums = SumsOf(sample, *merge.photon, merge.beam->ends, reverse, ratio);
  sample.context.observer->ObserveBeamMerge(path, *merge.beam, merge.flight);
}

// The weight of merging the camera subpath's last vertex with a photon. `light`: densities of the photon's path. `f`:
// of the vertex, towards where the photon came from. `flightRatio`: FlightPoints::RatioAt of the vertex, if it is the
// first of the camera subpath. Sets the densities of the whole path.
double WeightOf(const BidirectionalSample& sample, const Photon& photon, std::span<const SubpathDensities> light,
                const BsdfEvaluation& f, double flightRatio, Joint& joint) {
  const PathVertex& vertex = sample.camera.Last();
  joint.light.last = photon.PreviousReverse(sample.continuesHere * SolidAngleDensity(f.pdfForward));
  joint.camera = {AreaDensity(light.back().forward), vertex.PreviousReverse(f.pdfReverse)};
  joint.lastCameraIsDelta = light.back().forwardIsDelta;
  sample.whole.Set(light.first(light.size() - 1), sample.cameraDensities, joint, light.front().forward,
                   light.front().extent, sample.merging);
  return MergeWeight(photon.weight.At(light.back(), photon.depth)
                         .WithNextEvents(photon.depth + sample.camera.Count() - 1)
                         .BeforeReverse(joint.light.last),
                     sample.CameraWeight(flightRatio).BeforeReverse(joint.camera.previous),
                     sample.whole.PerDensityAt(light.size()), sample.connectionCount,
                     sample.whole.ForMerging(light.size()));
}

// Makes the vertex of the camera subpath at which the ray of `state` passes a photon. `passed`: of the ray up to there.
void SetVertexInMedium(const SampleContext& context, const PathState& state, const Flight& flight,
                       const Point3d& position, int32_t medium, const PhaseBsdf& phase, const Color& extinction,
                       const BeamPoint& passed, PathVertex& vertex) {
  vertex = PathVertex();
  MakeVertexInMedium(context.scene, position, state.ray.direction, medium, phase, extinction, vertex);
  vertex.factors = {MeanOf(passed.density * extinction), MeanOf(passed.density * flight.startExtinction),
                    passed.through};
}

}  // namespace

bool SetPointVertex(const SampleContext& context, const PathState& state, const Flight& flight, const BeamHit& hit,
                    PathVertex& vertex, VolumeMerge& merge) {
  const PhotonMap& map = *context.gather->map;
  const VolumePhoton& photon = map.VolumeOf(hit.index);
  const std::optional<BeamPoint> point = flight.PointAt(hit.t, photon.medium);
  if (!point) return false;
  merge = {.photon = &map[hit.index],
           .light = map.PathOf(map[hit.index]),
           .throughput = state.Throughput() * point->passed,
           .kernel = photon.Kernel(),
           .biasFactor = BiasFactor(hit.distanceSquared, photon.radius),
           .use = hit.index,
           .labels = map.LabelsOf(hit.index),
           .flightRatio = static_cast<double>(photon.flightRatio)};
  SetVertexInMedium(context, state, flight, flight.line.start + static_cast<double>(hit.t) * flight.line.direction,
                    photon.medium, photon.phase, photon.extinction, *point, vertex);
  return true;
}

bool SetCrossingVertex(const SampleContext& context, const PathState& state, const Flight& flight,
                       const BeamCrossing& crossing, PathVertex& vertex, VolumeMerge& merge) {
  const PhotonBeam& beam = context.gather->map->Beams()[crossing.beam];
  const std::optional<BeamPoint> point = flight.PointAt(static_cast<float>(crossing.t), beam.step.medium);
  if (!point) return false;
  const Medium& medium = *context.scene.media[static_cast<size_t>(beam.step.medium)];
  const MediumCoefficients here = medium.At(Point3(0.0f));
  merge.throughput = state.Throughput() * point->passed;
  SetVertexInMedium(context, state, flight, crossing.onBeam, beam.step.medium, {here.scattering, medium.Asymmetry()},
                    here.Extinction(), *point, vertex);
  return true;
}

bool SetBeamOf(const BidirectionalSample& sample, const BeamCrossing& crossing, BeamVertex& beam, VolumeMerge& merge) {
  const PhotonMap& map = *sample.context.gather->map;
  const PhotonBeam& found = map.Beams()[crossing.beam];
  if (!SetBeamVertex(sample.context, map, crossing, sample.settings.connects, sample.lightPaths, sample.camera.Last(),
                     beam))
    return false;
  merge.photon = &beam.photon;
  merge.light = beam.densities;
  merge.labels = map.Beams().LabelsOf(map.Beams().StartOf(found));
  merge.beam = &beam;
  merge.flight = found.start;
  if (sample.settings.flightPoints && sample.camera.Count() == 1) {
    const FlightStart& start = map.Beams().StartOf(found);
    const bool isAnywhere = start.depth == 1 && sample.Lighting().IsAtInfinity(beam.end.light);
    merge.flightRatio = sample.settings.flightPoints->RatioAt(
        beam.vertex, beam.vertex.toPrevious, FlightStartPoint{start.position, isAnywhere}.DistanceTo(beam.vertex),
        beam.vertex.factors.forward);
  }
  merge.kernel = 1 / (sample.settings.photons.volume.ShareOf(beam.edge.isFromMedium) * 2 *
                      static_cast<double>(crossing.radius) * static_cast<double>(crossing.sine));
  const Vector3d apart = crossing.onBeam - crossing.onRay;
  merge.biasFactor = BiasFactorOnLine(glm::dot(apart, apart), crossing.radius);
  merge.use = map.Beams().StartOf(found).origin == FlightStart::kNone ? VolumeMerge::kUnused : map.UseOf(found);
  return true;
}

Color MergeInMedium(const BidirectionalSample& sample, const VolumeMerge& merge) {
  const SampleContext& context = sample.context;
  const PhotonPass& pass = *context.gather;
  const PathVertex& vertex = sample.camera.Last();
  const Photon& photon = *merge.photon;
  const BsdfEvaluation f = vertex.Evaluate(photon.toPrevious, TransportMode::Radiance);
  const Color value = f.diffuse * photon.flux;
  if (value.IsBlack()) return value;
  Joint joint;
  joint.isMerged = true;
  joint.mergesAtCamera = true;
  joint.cameraMergeVolume = MergeVolume(vertex, merge.beam ? merge.beam->edge : ArrivingEdge(),
                                        {vertex.toPrevious, vertex.factors}, sample.settings.photons.volume);
  if (!(joint.cameraMergeVolume > 0)) return Color(0.0f);
  const double weight = WeightOf(sample, photon, merge.light, f, FlightRatioOf(sample, merge), joint);
  const double probability = static_cast<double>(sample.settings.counts.merging.At(sample.film));
  const double perPath = static_cast<double>(sample.Lighting().FluxUnit()) / (probability * pass.lightPaths);
  const double perDensity = perPath * merge.kernel;
  if (context.layers) {
    AddArrivingToLayers(context, sample.camera, PartsOf(vertex, photon.toPrevious, false, f.diffuse, f.specular),
                        merge.labels, Product(merge.throughput, value, perDensity * weight));
  }
  if (pass.use && merge.use != VolumeMerge::kUnused) {
    // A beam counts as a point photon would at the end of the flight.
    const auto radius = static_cast<double>(pass.volume.At(vertex.point.position));
    const double scale = weight * merge.kernel * static_cast<double>(kPi) * radius * radius / probability;
    PhotonUse::Contribution used[1] = {
        {merge.use, (merge.throughput * f.diffuse).Average() * static_cast<float>(scale) * sample.perArea}};
    pass.use->Add(used);
  }
  if (sample.IsObserved()) [[unlikely]]
    ReportMerge(sample, merge, joint.light.last, Product(merge.throughput, value, perDensity), weight);
  if (context.mergeBias) {
    *context.mergeBias += Product(merge.throughput, value, perDensity * weight * static_cast<double>(merge.biasFactor));
  }
  return Product(merge.throughput, value, perDensity * weight);
}

bool CanMergePhotons(const BidirectionalSample& sample) {
  const PathVertex& vertex = sample.camera.Last();
  return sample.merging && sample.isMerged && vertex.GathersPhotons() && vertex.CanMerge();
}

std::span<const uint32_t> FindPhotonsToMerge(const BidirectionalSample& sample) {
  const PhotonPass& pass = *sample.context.gather;
  const std::span<const uint32_t> found = FindPhotons(*pass.map, sample.camera.Last().point.position,
                                                      sample.mergeRadius, sample.lookup, sample.context.counts);
  if (pass.use) pass.use->Fetch(found.first(std::min(found.size(), kFetched)));
  return found;
}

void FetchPathsOf(const BidirectionalSample& sample, std::span<const uint32_t> found) {
  const PhotonPass& pass = *sample.context.gather;
  const std::span<const uint32_t> first = found.first(std::min(found.size(), kFetched));
  for (const uint32_t index : first) pass.map->PrefetchPathOf((*pass.map)[index]);
  if (pass.use) pass.use->FetchSums(first);
}

Color Merge(const BidirectionalSample& sample, std::span<const uint32_t> found) {
  const SampleContext& context = sample.context;
  const PhotonPass& pass = *context.gather;
  const PathVertex& vertex = sample.camera.Last();
  const auto most = static_cast<size_t>(sample.settings.maxDepth) + 1;
  const double perDensity =
      static_cast<double>(sample.Lighting().FluxUnit()) / (sample.merging.perDensity * sample.lightPaths);
  Joint joint;
  joint.isMerged = true;
  joint.mergesAtCamera = true;
  const float probability = sample.settings.counts.merging.At(sample.film);
  const float sheetDistance = Photon::SheetDistance(vertex.point.position, sample.mergeRadius);
  sample.lookup.used.clear();
  Color sum, bias;
  for (size_t i = 0; i < found.size(); ++i) {
    const uint32_t index = found[i];
    const Photon& photon = (*pass.map)[index];
    if (i + kFetched < found.size()) pass.map->PrefetchPathOf((*pass.map)[found[i + kFetched]]);
    if (photon.depth + sample.camera.Count() > most ||
        !photon.IsOnSurface(vertex.bsdf.Ng(), pass.map->OffsetFrom(vertex.point.position, index), sheetDistance))
      continue;
    const Vector3& toLight = photon.toPrevious;
    const BsdfEvaluation f = vertex.Evaluate(toLight, TransportMode::Radiance);
    const Color diffuse = f.diffuse * photon.flux, specular = f.specular * pass.map->SpecularFlux(photon);
    const Color scattered = diffuse + specular;
    if (scattered.IsBlack()) continue;
    const double weight = WeightOf(sample, photon, pass.map->PathOf(photon), f, 0, joint);
    const Color value = scattered * vertex.ArrivalCorrection(toLight, photon.normal.Unpack());
    sum += value * static_cast<float>(weight);
    bias += value * (static_cast<float>(weight) * BiasFactor(sample.lookup.distances[i], sample.mergeRadius));
    // Multiplied in another order than the sum: a shared product would be rounded differently than without layers.
    if (context.layers) [[unlikely]]
      AddArrivingToLayers(context, sample.camera, PartsOf(vertex, toLight, false, diffuse, specular),
                          pass.map->LabelsOf(index), Product(vertex.Throughput(), value, perDensity * weight));
    if (pass.use) {
      sample.lookup.used.push_back({index, (vertex.Throughput() * f.Sum()).Average() * static_cast<float>(weight) *
                                               sample.perArea / probability});
    }
    if (sample.IsObserved()) [[unlikely]]
      ReportMerge(sample, photon, joint.light.last, Product(vertex.Throughput(), value, perDensity), weight,
                  sample.flightRatio);
  }
  if (pass.use) pass.use->Add(sample.lookup.used);
  if (context.mergeBias) *context.mergeBias += Product(vertex.Throughput(), bias, perDensity);
  return Product(vertex.Throughput(), sum, perDensity);
}

}  // namespace lampyr
