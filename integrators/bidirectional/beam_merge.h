// Merging with photon beams: the beam that a flight of a light path leaves, and the light path's vertex where a camera
// ray passes the beam.
#pragma once

#include "integrators/bidirectional/subpath_weights.h"
#include "integrators/photon/photon_map.h"
#include "integrators/photon/photon_pass.h"

namespace lampyr {

// Adds to SampleContext::photons the flight of `state` from the last vertex of `path`, or from its light, as far as it
// passes media whose photons are beams, if its share is above `below`.
void AddFlight(const SampleContext& context, const VolumeRadius& radius, double below, const LightPath& path,
               const PathState& state, const Flight& flight, const EmittedPhoton& emission);
// A random threshold for the current light path of `sampler`: flights with a share above it are kept. 1: none.
double FlightsBelow(const VolumeRadius& radius, Sampler& sampler, const PathDimensions& dimensions);

// True if the flight to the vertex is stored as a beam, so that the vertex stores no photon.
inline bool IsOnBeam(const Vertex& vertex, const VolumeRadius& radius) {
  return vertex.IsInMedium() && radius.UsesBeams(vertex.insideMedium);
}

// The vertex of a light path in a medium at which a camera ray passes its flight: the same as after a collision there,
// except for the density.
struct BeamVertex {
  PathVertex vertex;  // of the light path: factors, pdfForward, weight
  ArrivingEdge edge;  // at it, from the light's side
  LightEnd end;       // if the flight starts at the light
  Photon photon;      // of it
  // Densities of the light path's vertices, the last is that at the crossing.
  std::vector<SubpathDensities> densities;
  PathEnds ends;
};

// Sets `made` for a crossing; `vertex`: the same vertex of the camera path. `connects`, `lightPaths`: as of
// WeightedLightPath. False: the flight carries no light to there.
bool SetBeamVertex(const SampleContext& context, const PhotonMap& map, const BeamCrossing& crossing, bool connects,
                   double lightPaths, const PathVertex& vertex, BeamVertex& made);

}  // namespace lampyr
