#include "integrators/photon/volume_estimate.h"

#include "integrators/photon/merge_bias.h"
#include "integrators/walk/path_layers.h"

namespace lampyr {

namespace {

// `scattered`: of the photon that the ray of `state` passes.
void AddPhotonToLayers(const SampleContext& context, const Subpath& path, const PathState& state, uint32_t photon,
                       const Color& seen) {
  thread_local PathLabels before, after;
  path.LabelsBeyond(*context.outputs, TransportMode::Radiance, state.event, before);
  const ScatteringParts event{PathEvent::Volume, PathEvent::Volume, Color(1.0f), Color(0.0f)};
  LabelsAfter(*context.outputs, TransportMode::Radiance, before.All(), event, after);
  AddToLayers(context, after.All(), context.gather->map->LabelsOf(photon), seen);
}

}  // namespace

Color VolumeEstimate::Gather(const Subpath& path, const PathState& state, const Flight& flight) {
  const auto events = static_cast<int>(path.Count());
  const PhotonPass& pass = *context_.gather;
  const std::span<const BeamHit> hits = FindPhotonsAlong(*pass.map, state.ray, flight.t, lookup_, context_.counts);
  if (hits.empty()) return Color();
  lookup_.used.clear();
  const double perPath = static_cast<double>(context_.scene.lighting->FluxUnit()) / pass.lightPaths;
  Color sum, bias;
  for (const BeamHit& hit : hits) {
    const Color scattered = Scattered(state, events, flight, hit);
    if (scattered.IsBlack()) continue;
    const Photon& photon = (*pass.map)[hit.index];
    const double kernel = pass.map->VolumeOf(hit.index).Kernel();
    const Color seen = Product(scattered, photon.flux, perPath * kernel);
    sum += seen;
    bias += seen * BiasFactor(hit.distanceSquared, pass.map->VolumeOf(hit.index).radius);
    if (context_.layers) [[unlikely]]
      AddPhotonToLayers(context_, path, state, hit.index, seen);
    if (pass.use)
      lookup_.used.push_back({hit.index, scattered.Average() * rules_.importance * kPi * static_cast<float>(kernel)});
  }
  if (pass.use) pass.use->Add(lookup_.used);
  if (context_.mergeBias) *context_.mergeBias += bias;
  return sum;
}

Color VolumeEstimate::Scattered(const PathState& state, int events, const Flight& flight, const BeamHit& hit) {
  const PhotonMap& map = *context_.gather->map;
  const Photon& photon = map[hit.index];
  // The photon's depth counts the vertex in the medium.
  if (static_cast<int>(photon.depth) + events > rules_.maxDepth) return Color();
  const VolumePhoton& place = map.VolumeOf(hit.index);
  const BsdfEvaluation f = place.phase.Evaluate(-state.ray.direction, photon.toPrevious, TransportMode::Radiance);
  if (f.pdfForward.value > rules_.gatherBelow) return Color();
  const std::optional<BeamPoint> point = flight.PointAt(hit.t, place.medium);
  if (!point) return Color();
  return state.Throughput() * point->passed * f.diffuse;
}

}  // namespace lampyr
