#include "integrators/bidirectional/subpath_weights.h"

#include "integrators/photon/photon_beams.h"

namespace lampyr {

namespace {

double SquaredDistance(const Vertex& a, const Vertex& b) {
  if (a.IsInMedium() || b.IsInMedium()) {
    const Vector3d way = a.WayTo(b);
    return glm::dot(way, way);
  }
  return SquaredLength(a.point.position - b.point.position);
}

}  // namespace

void SetWeights(const PathVertex& previous, const PathState& state, bool connects, PathVertex& vertex,
                double flightRatio) {
  const double squared = SquaredDistance(vertex, previous);
  SetWeights({flightRatio > 0 ? previous.weight.WithFlights(flightRatio) : previous.weight,
              previous.PreviousReverse(previous.eventReverse), previous.scatteredDelta, state.pdfDirection},
             state.factors, EdgeDensity(vertex, state.ray.direction, squared),
             EdgeDensity(previous, state.ray.direction, squared), connects, vertex);
}

void SetWeights(const LeftVertex& previous, const EdgeFactors& edge, SolidAnglePerArea fromPrevious,
                SolidAnglePerArea toPrevious, bool connects, PathVertex& vertex) {
  vertex.pdfForward = previous.pdfDirection * (edge.forward * fromPrevious);
  vertex.previousSolidAnglePerArea = edge.reverse * toPrevious;
  vertex.weight = previous.weight.Next(previous.scatteredDelta, vertex.pdfForward, previous.previousReverse);
  if (!connects) vertex.weight.connections.last = 0;
}

double MergeSize(const Vertex& vertex, const ArrivingEdge& light, const Vector3& toCamera, const VolumeRadius& radius) {
  const auto r = static_cast<double>(radius.At(vertex.point.position));
  if (!radius.UsesBeams(vertex.insideMedium)) return static_cast<double>(kPi) * r * r;
  const double sine = glm::length(glm::cross(Vector3d(light.away), Vector3d(toCamera)));
  if (sine < static_cast<double>(kLeastSine)) return 0;
  return radius.ShareOf(light.isFromMedium) * radius.beamScale * 2 * r * sine * PassingPerCollision(light.factors);
}

double MergeVolumeInMedium(const Vertex& vertex, const ArrivingEdge& light, const ArrivingEdge& camera,
                           const VolumeRadius& radius) {
  return MergeSize(vertex, light, camera.away, radius) * PassingPerCollision(camera.factors);
}

void AddDensities(const Subpath& path, const VolumeRadius& radius, bool isFromLight,
                  std::vector<SubpathDensities>& densities) {
  const size_t count = path.Count();
  densities.resize(count);
  SubpathDensities& last = densities[count - 1];
  last = {.forward = path.Last().pdfForward.value, .isInMedium = path.Last().IsInMedium()};
  if (count < 2) return;
  const PathVertex& previous = path[count - 2];
  if (previous.IsInMedium()) [[unlikely]] {
    const ArrivingEdge before = EdgeBefore(path, count - 1);
    const ArrivingEdge after{-path.Last().toPrevious, path.Last().factors.Reversed(), path.Last().IsInMedium()};
    densities[count - 2].mergeVolume = WideFloat(isFromLight ? MergeVolume(previous, before, after, radius)
                                                             : MergeVolume(previous, after, before, radius));
  }
  last.forwardIsDelta = previous.scatteredDelta;
  AddEvent(previous.CanMerge() && !previous.scatteredDelta, previous.scatteredDelta,
           previous.PreviousReverse(previous.eventReverse), count - 1, densities);
}

void AddEvent(bool canMerge, bool isDelta, AreaDensity reverse, size_t count, std::span<SubpathDensities> densities) {
  densities[count - 1].canMerge = canMerge;
  if (count < 2) return;
  densities[count - 2].reverse = reverse.value;
  densities[count - 2].reverseIsDelta = isDelta;
}

SolidAnglePerArea FirstEdgeDensity(const LightingServices& lighting, uint32_t light, float geometryTerm,
                                   double distanceSquared) {
  return EdgeDensity(geometryTerm, lighting.IsAtInfinity(light) ? 1 : distanceSquared);
}

namespace {

LightEnd::Extent ExtentOf(LightKind kind) {
  return kind == LightKind::Area       ? LightEnd::Extent::Surface
         : kind == LightKind::Infinite ? LightEnd::Extent::Sky
                                       : LightEnd::Extent::Point;
}

}  // namespace

LightEnd EndOf(const LightingServices& lighting, const FoundLight& found, bool canBeHit, SolidAnglePerArea edge,
               const EdgeFactors& factors, double lightPaths) {
  const LightEvaluation& e = found.evaluation;
  const auto selection = static_cast<double>(found.selection.value);
  LightEnd end;
  end.light = found.light;
  end.solidAnglePerArea = {static_cast<double>(e.solidAngleToArea)};
  end.direct = selection * SolidAngleDensity(e.pdfDirect) * end.solidAnglePerArea;
  end.solidAnglePerArea = factors.reverse * end.solidAnglePerArea;
  const auto emissionSelection = static_cast<double>(lighting.EmissionSelectionProbability(found.light).value);
  const AreaDensity position = lightPaths * emissionSelection * AreaDensity(e.pdfEmit);
  end.emission = position * (SolidAngleDensity(e.pdfEmitDirection) * (factors.forward * edge));
  end.canBeHit = canBeHit;
  if (canBeHit && !lighting.IsAtInfinity(found.light)) end.position = position;
  end.extent = ExtentOf(lighting.KindOf(found.light));
  return end;
}

// The partial weight of the first vertex depends on light selection there: on the probability with which next-event
// estimation from it would have chosen this light.
bool SetFirstWeights(const SampleContext& context, const EmittedPhoton& photon, bool connects, double lightPaths,
                     PathVertex& first, LightEnd& end) {
  const LightingServices& lighting = *context.scene.lighting;
  const std::optional<FoundLight> found = lighting.EvaluateFirstHit(photon, first.receiver);
  if (!found) return false;
  const double squared = SquaredLength(first.point.position - photon.emission.position);
  const SolidAnglePerArea edge =
      FirstEdgeDensity(lighting, found->light, first.GeometryTerm(first.toPrevious), squared);
  end = EndOf(lighting, *found, lighting.CanBeHit(found->light), edge, first.factors, lightPaths);
  if (!(end.emission.value > 0)) return false;
  first.previousSolidAnglePerArea = end.solidAnglePerArea;
  first.weight = PartialWeight::AtFirstHit(end, connects);
  return true;
}

bool WeightedLightPath::FirstHit(const EmittedPhoton& photon, PathVertex& first) {
  return SetFirstWeights(context_, photon, connects_, lightPaths_, first, end_);
}

void WeightedLightPath::Arrived(LightPath& path, const PathState& state) {
  const size_t count = path.vertices.Count();
  if (count > 1) SetWeights(path.vertices[count - 2], state, connects_, path.vertices.Last());
  OnWeighted(path);
}

}  // namespace lampyr
