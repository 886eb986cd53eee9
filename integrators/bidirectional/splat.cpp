// t = 1: the light path is connected to the lens.
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

void SplatVertex(const BidirectionalSample& sample) {
  const Subpath& light = sample.light.vertices;
  const PathVertex& vertex = light.Last();
  const auto seen =
      SeeVertex(sample.context, vertex, kLightDimensions.Of(static_cast<int>(light.Count()), dimensions::kLight));
  if (!seen) return;
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
  const double weight = SplatWeight(vertex.weight, joint.light, connectionCount, sample.settings.splatCount, merged);
  if (sample.IsObserved()) [[unlikely]] {
    ConnectedPath path;
    sample.SetLight(path, light.Count());
    SetLens(*seen, atLens, weight, path);
    path.merging = merging;
    path.connectionCount = connectionCount;
    path.continuing = continuing;
    if (merging && sample.context.observer->WantsSums())
      path.sums = sample.SumsOfConnection(light.Count(), joint.light, true);
    sample.Report(path);
  }
  AddSplat(sample, *seen, weight, LabelsTowardsLens(sample.context, light, *seen));
}

}  // namespace lampyr
