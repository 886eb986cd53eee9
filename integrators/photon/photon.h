// Photons: vertices of light paths, stored for camera paths to gather.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "integrators/photon/photon_beams.h"
#include "integrators/photon/photon_use.h"
#include "integrators/walk/vertex.h"

namespace lampyr {

// A unit vector in four bytes ([Cigolle14], oct16x2): off by 7e-5 at most.
class PackedNormal {
 public:
  PackedNormal() = default;
  explicit PackedNormal(const Normal3& n) {
    const float sum = std::abs(n.x) + std::abs(n.y) + std::abs(n.z);
    float x = n.x / sum, y = n.y / sum;
    if (n.z < 0) {
      const float folded = (1 - std::abs(y)) * (x < 0 ? -1.0f : 1.0f);
      y = (1 - std::abs(x)) * (y < 0 ? -1.0f : 1.0f);
      x = folded;
    }
    x_ = static_cast<int16_t>(std::lround(x * kScale));
    y_ = static_cast<int16_t>(std::lround(y * kScale));
  }
  Normal3 Unpack() const { return glm::normalize(Direction()); }
  // Unpack times a length of 0.57 to 1.
  Vector3 Direction() const {
    Vector3 n(x_ / kScale, y_ / kScale, 0);
    n.z = 1 - std::abs(n.x) - std::abs(n.y);
    const float t = std::max(-n.z, 0.0f);
    n.x += n.x >= 0 ? -t : t;
    n.y += n.y >= 0 ? -t : t;
    return n;
  }

 private:
  static constexpr float kScale = 32767;
  int16_t x_ = 0, y_ = 0;
};

// The partial weight of a photon's vertex, without what follows from the densities of the vertex, which are kept apart.
struct PhotonWeight {
  double endsEarlier = 0;
  double second = 0;  // of the first hit of a path: ends.last; of others: connections.earlier

  static PhotonWeight Of(const PartialWeight& weight, size_t depth) {
    return {weight.ends.earlier, depth > 1 ? weight.connections.earlier : weight.ends.last};
  }
  PartialWeight At(const SubpathDensities& vertex, size_t depth) const {
    if (depth <= 1) return {{second, endsEarlier}, {}};
    const double connected = vertex.forwardIsDelta ? 0.0 : 1 / Mis(AreaDensity(vertex.forward));
    return {{0, endsEarlier}, {connected, second}};
  }
};

// A photon as its light path stored it, in the order of paths. The map sorts photons by place.
struct TracedPhoton {
  Point3 position;
  Vector3 toPrevious;
  Color diffuse, specular;  // flux (LightingServices::FluxUnit) over the path's density, for either kind of lobe
  PhotonWeight weight;
  WideFloat previousSolidAnglePerArea;
  PackedNormal normal;
  uint16_t depth;                // 1: first hit of its path
  uint32_t origin;               // index of its path's origin in the list
  uint32_t path;                 // index of its path's first vertex in the densities of the list, if they are kept
  uint32_t volume = kOnSurface;  // index in the volume photons of the list

  static constexpr uint32_t kOnSurface = 0xffffffffu;
};

// Data of a photon in a medium, in addition to those of every photon.
struct VolumePhoton {
  Point3 position{0.0f};
  float radius = 0;  // of the ball in which a beam finds it, scene units
  PhaseBsdf phase;
  Color extinction;  // σ_t there
  int32_t medium = kVacuum;
  WideFloat flightRatio;  // FlightPoints::RatioAt

  // Density of the constant kernel on a disk across the ray, 1/scene unit².
  double Kernel() const {
    const auto r = static_cast<double>(radius);
    return 1 / (static_cast<double>(kPi) * r * r);
  }
};

// The photons of consecutive light paths. Keeps its memory when it is emptied.
class PhotonList {
 public:
  void Clear() {
    photons_.clear();
    starts_.clear();
    origins_.clear();
    densities_.clear();
    volume_.clear();
    beams_.Clear();
    ranges_.clear();
    labels_.clear();
    originsOfFlights_ = 0;
  }
  // What is added from now on belongs to the next path.
  void StartPath() {
    starts_.push_back({static_cast<uint32_t>(photons_.size()), static_cast<uint32_t>(densities_.size()),
                       static_cast<uint32_t>(volume_.size()), static_cast<uint32_t>(beams_.starts.size()),
                       static_cast<uint32_t>(beams_.beams.size()), static_cast<uint32_t>(beams_.emissions.size()),
                       static_cast<uint32_t>(labels_.size()), static_cast<uint32_t>(beams_.labels.size())});
    StartDensities();
  }
  // Sets the origin of the current path, for emission guiding. Before its first photon, or not at all.
  void SetOrigin(const PathOrigin& origin) {
    origins_.resize(KeptOrigins());  // drops origins of paths that stored no photon
    origins_.push_back(origin);
  }
  // Stores a photon at `vertex`. `labels`: of its path there; nullopt without layers. `depth` is clamped to kDeepest.
  // On a cut-out the light path and the gathering path each hit the surface with probability `coverage`; dividing the
  // flux by it makes the factor count once.
  // `flightRatio`: FlightPoints::RatioAt.
  void Add(const PathVertex& vertex, size_t depth, std::optional<std::span<const PathLabel>> labels = std::nullopt,
           double flightRatio = 0) {
    const float passed = vertex.coverage > 0 ? 1 / vertex.coverage : 0.0f;
    const auto origin = static_cast<uint32_t>(origins_.size()) - 1;
    // In place: a copy of what was just written field by field stalls on store forwarding.
    photons_.emplace_back(vertex.point.position, vertex.toPrevious, vertex.diffuse * passed, vertex.specular * passed,
                          PhotonWeight::Of(vertex.weight, depth), WideFloat(vertex.previousSolidAnglePerArea.value),
                          PackedNormal(vertex.bsdf.Ng()), static_cast<uint16_t>(std::min(depth, kDeepest)), origin,
                          static_cast<uint32_t>(densities_.size() + 1));
    if (const PhaseBsdf* phase = vertex.bsdf.Phase()) {
      photons_.back().volume = static_cast<uint32_t>(volume_.size());
      volume_.push_back(
          {vertex.point.position, 0, *phase, vertex.extinction, vertex.insideMedium, WideFloat(flightRatio)});
    }
    if (labels) [[unlikely]]
      ranges_.push_back(AppendLabels(*labels, labels_));
  }
  // Stores the flight of the current path from `start`. `emission`: of a flight from a light; null: from a vertex.
  // `labels`: of the path on the flight, as of Add.
  void AddFlight(FlightStart start, const EmittedPhoton* emission, std::span<const PhotonBeam> beams,
                 std::span<const PathLabel> labels = {}) {
    start.labels = AppendLabels(labels, beams_.labels);
    start.path = static_cast<uint32_t>(densities_.size() + 1);
    if (emission) {
      start.emission = static_cast<uint32_t>(beams_.emissions.size());
      beams_.emissions.push_back(*emission);
    } else if (!origins_.empty()) {
      start.origin = static_cast<uint32_t>(origins_.size()) - 1;
      originsOfFlights_ = origins_.size();
    }
    for (PhotonBeam beam : beams) {
      beam.start = static_cast<uint32_t>(beams_.starts.size());
      beams_.beams.push_back(beam);
    }
    beams_.starts.push_back(start);
  }
  // Keeps the densities of the current path's vertices up to its last photon, which is not deeper than kDeepest, or to
  // the start of its last flight, and before them those of its light's end. To be called when the path is complete, or
  // not at all.
  void KeepDensities(const PathEnds& ends, std::span<const SubpathDensities> densities) {
    size_t count = photons_.size() > photonsBefore_ ? photons_.back().depth : 0u;
    if (beams_.starts.size() > flightsBefore_) count = std::max<size_t>(count, beams_.starts.back().depth - 1u);
    StartDensities();
    if (count == 0) return;
    densities_.push_back(ends.Packed());
    const std::span<const SubpathDensities> kept = densities.first(count);
    densities_.insert(densities_.end(), kept.begin(), kept.end());
  }
  static constexpr size_t kDeepest = 65535;
  size_t Paths() const { return starts_.size(); }
  // Memory while the map is built, of which there are two copies of the densities.
  uint64_t Bytes(uint64_t perPhoton) const {
    return photons_.size() * perPhoton + 2 * sizeof(SubpathDensities) * densities_.size() +
           3 * sizeof(VolumePhoton) * volume_.size() + beams_.BytesOfMap() + 2 * sizeof(LabelRange) * ranges_.size() +
           2 * sizeof(PathLabel) * labels_.size();
  }
  // Removes whole paths from the end until Bytes is no more than `most`, or `least` paths are left; returns the number
  // of paths left.
  size_t KeepPaths(uint64_t most, uint64_t perPhoton, size_t least = 0) {
    while (Bytes(perPhoton) > most && starts_.size() > least) {
      photons_.resize(starts_.back().photon);
      densities_.resize(starts_.back().density);
      volume_.resize(starts_.back().volume);
      beams_.starts.resize(starts_.back().flight);
      beams_.beams.resize(starts_.back().beam);
      beams_.emissions.resize(starts_.back().emission);
      labels_.resize(starts_.back().label);
      beams_.labels.resize(starts_.back().beamLabel);
      if (!ranges_.empty()) ranges_.resize(photons_.size());
      starts_.pop_back();
    }
    origins_.resize(KeptOrigins());
    return starts_.size();
  }
  const std::vector<TracedPhoton>& Photons() const { return photons_; }
  const std::vector<PathOrigin>& Origins() const { return origins_; }
  const std::vector<SubpathDensities>& Densities() const { return densities_; }
  const std::vector<VolumePhoton>& Volume() const { return volume_; }
  const BeamList& Beams() const { return beams_; }
  // Labels of photons in the same order, and what they refer to; empty without layers.
  const std::vector<LabelRange>& LabelRanges() const { return ranges_; }
  const std::vector<PathLabel>& Labels() const { return labels_; }

 private:
  // A path that disperses is traced, and its densities are kept, once for each lane.
  void StartDensities() {
    photonsBefore_ = photons_.size();
    flightsBefore_ = beams_.starts.size();
  }
  // Number of origins whose paths stored photons; 0 if no origin was set.
  size_t KeptOrigins() const {
    const size_t ofPhotons = photons_.empty() ? 0 : static_cast<size_t>(photons_.back().origin + 1);
    return std::max(ofPhotons, originsOfFlights_);
  }

  std::vector<TracedPhoton> photons_;
  struct Start {
    uint32_t photon, density, volume, flight, beam, emission, label, beamLabel;
  };
  std::vector<Start> starts_;  // indices of what is first of each path
  std::vector<PathOrigin> origins_;
  std::vector<SubpathDensities> densities_;
  std::vector<VolumePhoton> volume_;
  BeamList beams_;
  std::vector<LabelRange> ranges_;
  std::vector<PathLabel> labels_;
  size_t originsOfFlights_ = 0;                   // origins that flights may refer to
  size_t photonsBefore_ = 0, flightsBefore_ = 0;  // before what KeepDensities will be called for
};

// A photon in a map, without its position. One line of the cache.
struct alignas(64) Photon {
  Vector3 toPrevious{0.0f};  // unit
  Color flux;  // LightingServices::FluxUnit over the path's density, for diffuse lobes; for specular ones see PhotonMap
  PhotonWeight weight;
  WideFloat previousSolidAnglePerArea;
  PackedNormal normal;  // of the surface
  uint32_t specular = kSame;
  uint16_t depth = 0;
  uint32_t path = 0;  // PhotonMap::PathOf

  static constexpr uint32_t kSame = 0xffffffffu;

  // Reverse density of the vertex before, or of the light's point. `towardsLight`: density with which the camera path
  // would sample the direction that the photon came from.
  AreaDensity PreviousReverse(SolidAngleDensity towardsLight) const {
    return towardsLight * SolidAnglePerArea{static_cast<double>(previousSolidAnglePerArea)};
  }
  // Distance between two parallel sheets from which on photons within `radius` of `at` are told apart.
  static float SheetDistance(const Point3& at, float radius) {
    constexpr float kOfRadius = 0.125f, kRounding = 4e-7f;
    return kOfRadius * radius + kRounding * MaxAbsComponent(at);
  }
  // True if the photon may lie on the same surface as a point with the normal `Ng`: not around a corner from it, and
  // not on the next of two parallel sheets. `offset`: from the point to the photon. On a sphere the chord between two
  // points is perpendicular to the mean of their normals, so that the offset along it is the distance of sheets,
  // whatever the curvature. On a bumpy surface it is not: the more the normals differ, the larger it may be. A photon
  // on the other side of a thinner wall passes this test, but the BSDF scatters
  // nothing of it.
  bool IsOnSurface(const Normal3& Ng, const Vector3& offset, float sheetDistance) const {
    constexpr float kCosine = 0.8f, kBent = 0.25f;
    const Vector3 direction = normal.Direction();
    const float cosine = glm::dot(direction, Ng), square = LengthSquared(direction);
    if (Sqr(cosine) <= kCosine * kCosine * square) return false;
    const float length = std::sqrt(square);
    const Vector3 twiceMean = direction + std::copysign(length, cosine) * Ng;
    const float sine = std::sqrt(std::max(1 - Sqr(cosine) / square, 0.0f));
    const float most = sheetDistance + kBent * sine * std::sqrt(LengthSquared(offset));
    return std::abs(glm::dot(offset, twiceMean)) <= 2 * length * most;
  }
};
static_assert(sizeof(Photon) == 64, "photons are counted in millions");

}  // namespace lampyr
