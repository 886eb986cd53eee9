// Photon beams: flights of light paths through homogeneous media with long mean free paths, where few of them collide.
// Camera rays gather those that they pass ([Jarosz11]; beam–beam in one dimension in [Křivánek14]).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "integrators/photon/box_tree.h"
#include "integrators/walk/path_labels.h"
#include "integrators/walk/vertex.h"
#include "lights/services/lighting_services.h"

namespace lampyr {

// A part of a list of labels.
struct LabelRange {
  uint32_t first = 0, end = 0;
};
inline LabelRange AppendLabels(std::span<const PathLabel> labels, std::vector<PathLabel>& all) {
  const auto first = static_cast<uint32_t>(all.size());
  all.insert(all.end(), labels.begin(), labels.end());
  return {first, static_cast<uint32_t>(all.size())};
}

// A vertex of a light path from which it has flown on, or its start at a light: the data that determine weight and
// densities of a vertex further along the flight.
struct FlightStart {
  Point3d position{0.0};
  Vector3d direction{0.0};  // unit
  Color diffuse,
      specular;            // throughput that leaves, LightingServices::FluxUnit over the density; of a light unfiltered
  Color extinction{1.0f};  // at the start (Vertex::extinction)
  Color channels{1.0f / 3};  // Flight::channels
  SolidAngleDensity pdfDirection;
  PartialWeight weight;         // of the vertex
  AreaDensity previousReverse;  // of the vertex before it, by the event
  float geometryTerm = 1;       // of the vertex, along the flight
  double mergeSize = 0;         // of the vertex in a medium: MergeSize
  bool scatteredDelta = false;
  bool canMerge = false;
  bool isInMedium = false;
  uint16_t depth = 1;         // of a vertex on the flight
  LabelRange labels;          // of the path on the flight, in the labels of the list
  uint32_t origin = kNone;    // index of the path's origin; kNone: not known
  uint32_t path = 0;          // index of the path's first vertex in the densities
  uint32_t emission = kNone;  // index of its emission; kNone: it starts at a vertex

  static constexpr uint32_t kNone = 0xffffffffu;
};

// A part of a flight in one medium.
struct PhotonBeam {
  BeamStep step;
  Color tint{1.0f};    // of the surfaces before it
  uint32_t start = 0;  // index of the FlightStart
};

// Where a camera ray passes a beam: their nearest points. The vertex of the camera path is on the beam, and that of the
// light path on the ray: near the start of either the other point is the nearer one to it, and the density of arriving
// there would be too high, and with it the weight of merging.
struct BeamCrossing {
  uint32_t beam = 0;
  double t = 0, tBeam = 0;  // along the camera ray, and along the flight from its start
  float radius = 0;         // half the width of the kernel
  float sine = 1;           // of the angle between both
  Point3d onRay{0.0}, onBeam{0.0};
};

// The flights of the light paths of one pass.
struct BeamList {
  std::vector<FlightStart> starts;
  std::vector<PhotonBeam> beams;
  std::vector<EmittedPhoton> emissions;
  std::vector<PathLabel> labels;  // empty without layers

  bool IsEmpty() const { return beams.empty(); }
  size_t Bytes() const {
    return starts.size() * sizeof(FlightStart) + beams.size() * sizeof(PhotonBeam) +
           emissions.size() * sizeof(EmittedPhoton) + labels.size() * sizeof(PathLabel);
  }
  // Upper bound of the memory while a BeamMap is built, of which there are two copies of the list.
  size_t BytesOfMap() const;
  void Clear();
  void Append(const BeamList& other, uint32_t firstOrigin, uint32_t firstDensity);
};

// Beams and camera rays that are nearly parallel are neither merged nor weighted for it: the kernel has 1 / sinθ.
inline constexpr float kLeastSine = 1e-3f;

class BeamMap {
 public:
  BeamMap() = default;
  BeamMap(BeamList list, const VolumeRadius& radius);

  bool IsEmpty() const { return list_.IsEmpty(); }
  // Adds where a ray passes beams on [0, tMax) within the radius, in an order that depends on the beams alone. `boxes`:
  // storage.
  void Find(const Ray& ray, const FineLine& line, float tMax, std::vector<uint32_t>& boxes,
            std::vector<BeamCrossing>& crossings) const;
  const PhotonBeam& operator[](uint32_t beam) const { return list_.beams[beam]; }
  const FlightStart& StartOf(const PhotonBeam& beam) const { return list_.starts[beam.start]; }
  std::span<const PathLabel> LabelsOf(const FlightStart& start) const {
    return std::span(list_.labels).subspan(start.labels.first, start.labels.end - start.labels.first);
  }
  const EmittedPhoton& EmissionOf(const FlightStart& start) const { return list_.emissions[start.emission]; }
  const std::vector<FlightStart>& Starts() const { return list_.starts; }
  size_t Bytes() const;

 private:
  friend struct BeamList;  // BytesOfMap

  // A part of a beam, short enough for its box.
  struct Piece {
    uint32_t beam;
    float tMin, tMax;
  };
  struct Placed;
  std::vector<Placed> Split() const;

  BeamList list_;
  VolumeRadius radius_;
  std::vector<Piece> pieces_;  // along a space-filling curve
  BoxTree tree_;               // of the pieces
};

}  // namespace lampyr
