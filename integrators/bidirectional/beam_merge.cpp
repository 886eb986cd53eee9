#include "integrators/bidirectional/beam_merge.h"

#include <algorithm>

namespace lampyr {

double FlightsBelow(const VolumeRadius& radius, Sampler& sampler, const PathDimensions& dimensions) {
  if (radius.usesBeams.empty()) return 1;
  if (radius.beamShare >= 1 && radius.scatteredBeamShare >= 1) return 0;
  sampler.SetDimension(dimensions.Of(0, dimensions::kLobe));
  const auto u = static_cast<double>(sampler.Get1D());
  return u < std::max(radius.beamShare, radius.scatteredBeamShare) ? u : 1.0;
}

namespace {

// The start of the flight that leaves the last vertex of `path` along the ray of `state`.
FlightStart StartAtLast(const Subpath& path, const PathState& state, const VolumeRadius& radius) {
  const PathVertex& vertex = path.Last();
  FlightStart start;
  start.isInMedium = vertex.IsInMedium();
  start.extinction = vertex.extinction;
  start.weight = vertex.weight;
  start.scatteredDelta = vertex.scatteredDelta;
  start.previousReverse = vertex.PreviousReverse(vertex.eventReverse);
  start.geometryTerm = vertex.GeometryTerm(state.ray.direction);
  start.canMerge = vertex.CanMerge() && !vertex.scatteredDelta;
  if (vertex.IsInMedium()) {
    start.mergeSize = MergeSize(vertex, EdgeBefore(path, path.Count()), state.ray.direction, radius);
  }
  return start;
}

}  // namespace

void AddFlight(const SampleContext& context, const VolumeRadius& radius, double below, const LightPath& path,
               const PathState& state, const Flight& flight, const EmittedPhoton& emission) {
  const size_t count = path.vertices.Count();
  if (!(below < radius.ShareOf(count > 0 && path.vertices.Last().IsInMedium()))) return;
  thread_local std::vector<PhotonBeam> beams;
  beams.clear();
  for (const BeamStep& step : flight.beam) {
    if (!radius.UsesBeams(step.medium) || !(step.tMax > step.tMin)) continue;
    // A step may start at a tinted surface: its middle is beyond, whatever is rounded.
    const Color tint = flight.TintBefore(0.5 * (static_cast<double>(step.tMin) + static_cast<double>(step.tMax)));
    if (!(tint * step.transmittance).IsBlack()) beams.push_back({step, tint, 0});
  }
  if (beams.empty() || count >= PhotonList::kDeepest) return;
  FlightStart start;
  if (count > 0) {
    start = StartAtLast(path.vertices, state, radius);
  } else {
    start.extinction = flight.startExtinction;
  }
  start.position = flight.line.start;
  start.direction = flight.line.direction;
  start.diffuse = state.diffuse;
  start.specular = state.specular;
  start.channels = flight.channels;
  start.pdfDirection = state.pdfDirection;
  start.depth = static_cast<uint16_t>(count + 1);
  thread_local PathLabels labels;
  labels.Clear();
  if (context.outputs) path.vertices.LabelsBeyond(*context.outputs, TransportMode::Importance, state.event, labels);
  context.photons->AddFlight(start, count == 0 ? &emission : nullptr, beams, labels.All());
}

namespace {

// The densities of the whole light path up to the crossing.
void SetDensities(const PhotonMap& map, const FlightStart& start, BeamVertex& made) {
  const std::span<const SubpathDensities> before = map.PathOf(start);
  std::vector<SubpathDensities>& densities = made.densities;
  densities.assign(before.begin(), before.end());
  if (start.depth == 1) {
    made.ends = {made.end.direct.value, 0, false, 0, made.end.canBeHit};
    densities.push_back(FirstDensities(made.end, true));
    return;
  }
  made.ends = map.EndsOf(start);
  SubpathDensities& previous = densities.back();
  if (previous.isInMedium)
    previous.mergeVolume = WideFloat(start.mergeSize * PassingPerCollision(made.vertex.factors.Reversed()));
  AddEvent(start.canMerge, start.scatteredDelta, start.previousReverse, densities.size(), densities);
  densities.push_back(
      {.forward = made.vertex.pdfForward.value, .forwardIsDelta = start.scatteredDelta, .isInMedium = true});
}

}  // namespace

bool SetBeamVertex(const SampleContext& context, const PhotonMap& map, const BeamCrossing& crossing, bool connects,
                   double lightPaths, const PathVertex& vertex, BeamVertex& made) {
  const PhotonBeam& beam = map.Beams()[crossing.beam];
  const FlightStart& start = map.Beams().StartOf(beam);
  const auto t = static_cast<float>(crossing.tBeam);
  const Color density = beam.step.DensityAt(t);
  const double through = MeanOf(density), reached = OverChannels(start.channels, density);
  if (!(through > 0) || !(reached > 0)) return false;
  PathVertex& light = made.vertex;
  static_cast<Vertex&>(light) = vertex;
  light.toPrevious = -Vector3(start.direction);
  light.SetGuide(vertex.guide);  // of the other direction
  light.factors = {MeanOf(density * vertex.extinction), MeanOf(density * start.extinction), through};
  made.edge = {light.toPrevious, light.factors, start.isInMedium};
  light.diffuse = start.diffuse;
  light.specular = start.specular;
  if (start.depth == 1) {
    const EmittedPhoton& emission = map.Beams().EmissionOf(start);
    light.point.position = light.receiver.position = Point3(crossing.onRay);
    if (!context.scene.lighting->FilterFirstHit(emission, light.receiver, light.diffuse, light.specular)) return false;
    if (!SetFirstWeights(context, emission, connects, lightPaths, light, made.end)) return false;
  } else {
    const Vector3d way = crossing.onRay - start.position;
    const double squared = glm::dot(way, way);
    SetWeights({start.weight, start.previousReverse, start.scatteredDelta, start.pdfDirection}, light.factors,
               EdgeDensity(1, squared), EdgeDensity(start.geometryTerm, squared), connects, light);
  }
  light.diffuse *= beam.tint * beam.step.TransmittanceAt(t) / static_cast<float>(reached);
  SetDensities(map, start, made);
  Photon& photon = made.photon;
  photon.toPrevious = light.toPrevious;
  photon.flux = light.diffuse;
  photon.weight = PhotonWeight::Of(light.weight, start.depth);
  photon.previousSolidAnglePerArea = WideFloat(light.previousSolidAnglePerArea.value);
  photon.depth = start.depth;
  return true;
}

}  // namespace lampyr
