// s = 0: the camera subpath hits a light.
#include <limits>

#include "integrators/bidirectional/techniques.h"
#include "integrators/bidirectional/weights.h"
#include "integrators/walk/path_layers.h"

namespace lampyr {

namespace {

// `edge`: FirstEdgeDensity from the light that was found to the camera subpath's last vertex. `distance`: to the light;
// infinite for one at infinity.
Color HitLight(const BidirectionalSample& sample, const PathState& state, const FoundLight& found,
               SolidAnglePerArea edge, double distance) {
  const LightEvaluation& e = found.evaluation;
  ConnectedPath path;
  path.value = state.diffuse * e.diffuse + state.specular * e.specular;
  if (path.value.IsBlack()) return path.value;
  path.s = 0;
  path.end = EndOf(sample.Lighting(), found, true, edge, state.factors.Reversed(), sample.lightPaths);
  sample.SetCamera(path);
  path.t = static_cast<int>(sample.camera.Count()) + 2;
  const auto finish = [&] {
    sample.Report(path);
    const Color contribution = path.WeightedValue();
    if (sample.context.layers) {
      const ScatteringParts event{state.event.ofDiffuse, state.event.ofSpecular, state.diffuse * e.diffuse,
                                  state.specular * e.specular};
      AddFoundToLayers(sample.context, sample.camera, event, sample.context.outputs->OfLight(found.light),
                       contribution);
    }
    return contribution;
  };
  if (!sample.settings.connects && path.end.emission.value > 0) return sample.couldMerge ? Color(0.0f) : finish();
  path.toLight = state.ray.direction;
  const PathVertex& last = sample.camera.Last();
  const LastEvent event{last.scatteredDelta, last.PreviousReverse(last.eventReverse)};
  const AreaDensity hit = state.pdfDirection * path.end.solidAnglePerArea;
  Joint joint;
  joint.camera.previous = event.previousReverse;
  joint.previousCameraIsDelta = event.isDelta;
  joint.mergesAtCamera = last.CanMerge() && !event.isDelta;
  path.endFactors = state.factors.Reversed();
  joint.cameraMergeVolume = MergeVolume(last, {state.ray.direction, path.endFactors}, {last.toPrevious, last.factors},
                                        sample.settings.photons.volume);
  path.endDistance = distance;
  const double flightRatio = sample.FlightRatio(state.ray.direction, distance, path.endFactors.forward);
  path.weight = HitWeight(path.end, sample.CameraWeight(flightRatio), event, hit, sample.connectionCount,
                          NextEventCount(sample.camera.Count()), sample.MergingOfLight(path.end, joint, hit));
  if (sample.WantsSums()) [[unlikely]]
    path.sums = sample.Sums(path.end, hit, event.isDelta, 0, flightRatio);
  return finish();
}

}  // namespace

Color SeeLightAt(const BidirectionalSample& sample, const PathState& state, const RayHit& hit,
                 const SurfacePoint& point) {
  const SampleContext& context = sample.context;
  const LightingServices& lighting = sample.Lighting();
  const Ray& ray = state.ray;
  ConnectedPath path;
  path.value =
      state.specular * context.seenShare * lighting.EmissionForCamera(ray.direction, hit.t, point, context.time);
  if (path.value.IsBlack()) return path.value;
  path.s = 0;
  path.t = 2;
  const Receiver lens{ray.origin, Normal3(0.0f), false, Receiver::kCamera};
  if (const auto found = lighting.EvaluateSamples(lens, ray.direction, hit.t, point, context.time, true)) {
    path.end = EndOf(lighting, *found, lighting.CanBeHit(found->light), {0}, {}, sample.lightPaths);
    path.atLens = state.factors.forward * DensityAtLens(*context.scene.camera, ray, AbsDot(ray.direction, point.Ng),
                                                        Sqr(static_cast<double>(hit.t)));
    if (path.atLens.value > 0 && sample.settings.connects)
      path.weight = SeenLightWeight(path.end.position, path.atLens, sample.settings.splatCount);
    if (path.atLens.value > 0)
      path.sums.Of(TechniqueGroup::Light).Add(sample.settings.splatCount * (path.end.position / path.atLens));
  }
  path.sums.Of(TechniqueGroup::Hit).Add(1);
  sample.Report(path);
  const Color contribution = path.WeightedValue();
  // The light is that of the surface, because path.end may be unset: a light that emits from one side only may have no
  // density here.
  if (context.layers)
    AddFoundToLayers(context, sample.camera, state.event, context.outputs->OfLight(lighting.LightAt(point)),
                     contribution);
  return contribution;
}

// No other technique finds a light at infinity that the camera sees directly.
Color SeeBackground(const BidirectionalSample& sample, const PathState& state) {
  ConnectedPath path;
  path.t = 2;
  path.end.canBeHit = true;
  path.atLens = AreaDensity(1);
  path.sums.Of(TechniqueGroup::Hit).Add(1);
  path.value = EscapedEmissionForCamera(sample.context, state.ray, state.specular * sample.context.seenShare);
  sample.Report(path);
  return path.WeightedValue();
}

Color HitLightAt(const BidirectionalSample& sample, const PathState& state, const SurfacePoint& point) {
  const LightingServices& lighting = sample.Lighting();
  const PathVertex& last = sample.camera.Last();
  const float distance = glm::distance(point.position, last.point.position);
  const auto found =
      lighting.EvaluateSamples(last.receiver, state.ray.direction, distance, point, sample.context.time, true);
  if (!found) return Color(0.0f);
  return HitLight(sample, state, *found,
                  FirstEdgeDensity(lighting, found->light, last.GeometryTerm(state.ray.direction),
                                   Sqr(static_cast<double>(distance))),
                  static_cast<double>(distance));
}

Color HitInfiniteLights(const BidirectionalSample& sample, const PathState& state) {
  const LightingServices& lighting = sample.Lighting();
  const PathVertex& last = sample.camera.Last();
  Color sum;
  for (size_t i = 0; i < lighting.InfiniteCount(); ++i) {
    const auto found = lighting.EvaluateEscaped(i, last.receiver, state.ray.direction, sample.context.time, true);
    if (!found) continue;
    sum += HitLight(sample, state, *found,
                    FirstEdgeDensity(lighting, found->light, last.GeometryTerm(state.ray.direction), 1),
                    std::numeric_limits<double>::infinity());
  }
  return sum;
}

}  // namespace lampyr
