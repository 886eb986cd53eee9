// t = 1: the light path is connected to the lens.
#include <algorithm>

#include "integrators/bidirectional/techniques.h"
#include "integrators/bidirectional/weights.h"

namespace lampyr {

namespace {

AreaDensity DensityWithoutMedia(const BidirectionalSample& sample, const SeenFromLens& seen) {
  return AreaDensity(static_cast<double>(seen.connection.Weight()) * EdgeDensity(seen.geometryTerm, 1).value /
                     sample.settings.filmPixels);
}

void AddSplat(const BidirectionalSample& sample, const SeenFromLens& seen, double weight,
              std::span<const PathLabel> labels) {
  AddSplats(sample.context, seen.connection, seen.value * static_cast<float>(weight), labels);
}

void SetLens(const SeenFromLens& seen, AreaDensity atLens, double weight, ConnectedPath& path) {
  path.t = 1;
  path.toLens = seen.toCamera;
  path.lensFactors = seen.factors;
  path.atLens = atLens;
  path.connection = &seen.connection;
  path.value = seen.value;
  path.weight = weight;
}

}  // namespace

void SplatLight(const BidirectionalSample& sample, const EmittedPhoton& photon) {
  const auto seen = SeeLight(sample.context, photon, kLightDimensions.Of(0, dimensions::kRoulette));
  if (!seen) return;
  const AreaDensity atLens = seen->factors.forward * DensityWithoutMedia(sample, *seen);
  const AreaDensity position =
      sample.lightPaths * static_cast<double>(photon.emissionSelection.value) * AreaDensity(photon.emission.pdfEmit);
  const double weight = SplatLightWeight(position, atLens, sample.settings.splatCount);
  if (sample.IsObserved()) [[unlikely]] {
    ConnectedPath path;
    path.s = 1;
    SetLens(*seen, atLens, weight, path);
    path.end.light = photon.light;
    path.end.position = position;
    path.end.canBeHit = true;
    path.sums.Of(TechniqueGroup::Light).Add(1);
    path.sums.Of(TechniqueGroup::Hit).Add(atLens / position / sample.settings.splatCount);
    sample.Report(path);
  }
  const PathLabel label[] = {{sample.context.outputs ? sample.context.outputs->OfLight(photon.light) : 0}};
  AddSplat(sample, *seen, weight, label);
}

namespace {

// `isOfFlight`: the light subpath's last vertex is a point of its last flight, and no collision.
void ConnectToLens(const BidirectionalSample& sample, const FlightStartPoint& start, uint32_t dimension,
                   bool isOfFlight) {
  const Subpath& light = sample.light.vertices;
  const PathVertex& vertex = light.Last();
  const auto seen = SeeVertex(sample.context, vertex, dimension);
  if (!seen) return;
  double ratio = 0;
  if (sample.settings.flightPoints) [[unlikely]] {
    ratio = sample.settings.flightPoints->RatioAt(vertex, vertex.toPrevious, start.DistanceTo(vertex),
                                                  vertex.factors.forward);
    if (isOfFlight && !(ratio > 0)) return;
  }
  const AreaDensity withoutMedia = DensityWithoutMedia(sample, *seen), atLens = seen->factors.forward * withoutMedia;
  Joint joint;
  const Point2& film = seen->connection.camera.film;
  const auto continuing = static_cast<double>(sample.settings.counts.continuing.At(film));
  joint.mergesAtLight = vertex.CanMerge();
  // A camera path that sees the vertex may end there.
  const double continuesHere = joint.mergesAtLight ? continuing : 1.0;
  joint.light = {atLens, vertex.PreviousReverse(continuesHere * SolidAngleDensity(seen->f.pdfReverse))};
  joint.lightMergeVolume = MergeVolume(vertex, EdgeBefore(light, light.Count()), {seen->toCamera, seen->factors},
                                       sample.settings.photons.volume);
  Merging merging;
  double merged = 0;
  if (sample.context.gather) {
    const auto distance = static_cast<double>(glm::distance(seen->connection.camera.position, vertex.point.position));
    merging = sample.MergingAt(distance, sample.FootprintAt(seen->geometryTerm, withoutMedia), film);
  }
  if (merging) {
    sample.whole.Set(sample.lightDensities, {}, joint, sample.lightEnd.emission.value, sample.lightEnd.extent, merging);
    merged = sample.whole.ForConnection(light.Count());
  }
  const double connectionCount = Sqr(sample.ConnectionsPerLightPathAt(film));
  const double weight =
      SplatWeight(vertex.weight, joint.light, connectionCount, sample.settings.splatCount, merged, ratio, isOfFlight);
  if (sample.IsObserved()) [[unlikely]] {
    ConnectedPath path;
    sample.SetLight(path, light.Count());
    SetLens(*seen, atLens, weight, path);
    path.merging = merging;
    path.connectionCount = connectionCount;
    path.continuing = continuing;
    path.endDistance = start.DistanceTo(vertex);
    path.isOfFlight = isOfFlight;
    if (merging && sample.context.observer->WantsSums()) {
      PathEnds ends = sample.EndsOfConnection(light.Count(), joint.light, true, ratio);
      ends.isOfFlight = isOfFlight;
      path.sums = sample.whole.Sums(ends, light.Count() + 1, 0);
    }
    sample.Report(path);
  }
  AddSplat(sample, *seen, weight, LabelsTowardsLens(sample.context, light, *seen));
}

}  // namespace

void SplatVertex(const BidirectionalSample& sample, const FlightStartPoint& start) {
  const auto count = static_cast<int>(sample.light.vertices.Count());
  ConnectToLens(sample, start, kLightDimensions.Of(count, dimensions::kLight), false);
}

void SplatFlight(BidirectionalSample& sample, const FlightStartPoint& start, const PathState& state,
                 const Flight& flight, const EmittedPhoton& photon, Sampler& sampler, LightPath& path) {
  const SampleContext& context = sample.context;
  const BidirectionalSettings& settings = sample.settings;
  const size_t count = path.vertices.Count();
  if (static_cast<int>(count) >= settings.maxDepth || context.IsCounted(state.isDispersed)) return;
  const auto dimension = [count](uint32_t which) { return kLightDimensions.OfSegment(static_cast<int>(count), which); };
  if (!AddFlightVertex(context, *settings.flightPoints, state, flight, &photon, sampler,
                       dimension(dimensions::kSegmentChoice), path))
    return;
  PathVertex& vertex = path.vertices.Last();
  bool isLit = true;
  if (count == 0) {
    isLit = SetFirstWeights(context, photon, settings.connects, sample.lightPaths, vertex, sample.lightEnd);
  } else {
    PathState arrived = state;
    arrived.factors = vertex.factors;
    SetWeights(path.vertices[count - 1], arrived, settings.connects, vertex);
  }
  std::vector<SubpathDensities>& densities = sample.lightDensities;
  thread_local std::vector<SubpathDensities> before;
  if (settings.merges && isLit) {
    densities.resize(count);
    before.assign(densities.end() - static_cast<std::ptrdiff_t>(std::min<size_t>(count, 2)), densities.end());
    AddDensities(path.vertices, settings.photons.volume, true, densities);
    if (count == 0) densities[0] = FirstDensities(sample.lightEnd, true);
  }
  if (isLit) ConnectToLens(sample, start, dimension(dimensions::kSegmentLight), true);
  if (settings.merges && isLit) {
    densities.resize(count);
    std::copy(before.begin(), before.end(), densities.end() - static_cast<std::ptrdiff_t>(before.size()));
  }
  path.vertices.Drop();
}

}  // namespace lampyr
