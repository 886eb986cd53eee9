// t = 1: the light path is connected to the lens.
#include "integrators/bidirectional/techniques.h"
#include "integrators/bidirectional/weights.h"

namespace lampyr {

namespace {

void AddSplat(const BidirectionalSample& sample, ConnectedPath& path) {
  AddSplats(*path.connection, sample.Report(path), sample.Lighting().GroupOf(path.end.light), *sample.context.splats,
            sample.context.counts);
}

AreaDensity DensityWithoutMedia(const BidirectionalSample& sample, const SeenFromLens& seen) {
  return AreaDensity(static_cast<double>(seen.connection.Weight()) * EdgeDensity(seen.geometryTerm, 1).value /
                     sample.settings.filmPixels);
}

void SetLens(const BidirectionalSample& sample, const SeenFromLens& seen, ConnectedPath& path) {
  path.t = 1;
  path.toLens = seen.toCamera;
  path.atLens = seen.factors.forward * DensityWithoutMedia(sample, seen);
  path.connection = &seen.connection;
  path.value = seen.value;
}

}  // namespace

void SplatLight(const BidirectionalSample& sample, const EmittedPhoton& photon) {
  const auto seen = SeeLight(sample.context, photon, kLightDimensions.Of(0, dimensions::kRoulette));
  if (!seen) return;
  ConnectedPath path;
  path.s = 1;
  SetLens(sample, *seen, path);
  path.end.light = photon.light;
  path.end.position =
      sample.lightPaths * static_cast<double>(photon.emissionSelection.value) * AreaDensity(photon.emission.pdfEmit);
  path.end.canBeHit = true;
  path.weight = SplatLightWeight(path.end.position, path.atLens, sample.settings.splatCount);
  path.sums.Of(TechniqueGroup::Light).Add(1);
  path.sums.Of(TechniqueGroup::Hit).Add(path.atLens / path.end.position / sample.settings.splatCount);
  AddSplat(sample, path);
}

void SplatVertex(const BidirectionalSample& sample) {
  const Subpath& light = sample.light.vertices;
  const PathVertex& vertex = light.Last();
  const auto seen =
      SeeVertex(sample.context, vertex, kLightDimensions.Of(static_cast<int>(light.Count()), dimensions::kLight));
  if (!seen) return;
  ConnectedPath path;
  sample.SetLight(path, light.Count());
  SetLens(sample, *seen, path);
  Joint joint;
  joint.light = {path.atLens, vertex.PreviousReverse(seen->f.pdfReverse)};
  joint.mergesAtLight = vertex.CanMerge();
  double merging = 0;
  const Point2& film = seen->connection.camera.film;
  if (sample.context.gather) {
    const auto distance = static_cast<double>(glm::distance(seen->connection.camera.position, vertex.point.position));
    path.merging =
        sample.MergingAt(distance, sample.FootprintAt(seen->geometryTerm, DensityWithoutMedia(sample, *seen)), film);
  }
  if (path.merging) {
    sample.whole.Set(sample.lightDensities, {}, joint, sample.lightEnd.emission.value, sample.lightEnd.extent,
                     path.merging);
    merging = sample.whole.ForConnection(light.Count());
    if (sample.context.observer && sample.context.observer->WantsSums()) [[unlikely]]
      path.sums = sample.SumsOfConnection(light.Count(), joint.light, true);
  }
  path.connectionCount = Sqr(sample.ConnectionsPerLightPathAt(film));
  path.weight = SplatWeight(vertex.weight, joint.light, path.connectionCount, sample.settings.splatCount, merging);
  AddSplat(sample, path);
}

}  // namespace lampyr
