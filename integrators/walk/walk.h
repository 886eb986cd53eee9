// The random walk of camera and light paths: a ray is traced, its hit becomes a vertex, the vertex scatters into the
// next ray. This is the only such loop; integrators observe it (PathVisitor) and estimate light at its vertices.
#pragma once

#include <algorithm>
#include <vector>

#include "integrators/guide/path_records.h"
#include "integrators/walk/integrator.h"
#include "integrators/walk/path_labels.h"
#include "integrators/walk/vertex.h"

namespace lampyr {

// Path state between two vertices.
struct PathState {
  Ray ray;
  // Throughput β, in two parts, because a light may send different radiance to diffuse and to specular lobes. On camera
  // paths: by the kind of lobe that scattered at the last vertex. On light paths: for either kind of lobe at the next
  // vertex; equal from the first vertex on.
  Color diffuse, specular;
  SolidAngleDensity pdfDirection;  // density of the ray's direction at the last vertex (DensitiesOf)
  int32_t medium = kVacuum;        // participating medium in which the ray starts
  // For a path without vertices: vector from the ray's origin to the start of the path, which is on the surface if the
  // light is an area light.
  Vector3 fromOrigin{0.0f};
  // Transmittance of what the last ray crossed; in media that scatter, over the density of getting through. Already a
  // factor of β.
  Color passed{1.0f};
  EdgeFactors factors;  // of the last ray, by participating media
  float length = 0;     // of the whole path so far
  float etaScale = 1;   // undoes the scaling of radiance by η² in refraction, for Russian roulette
  // Π Guidance::forward over the path's events, for Russian roulette; and the factor of the last event.
  float guidance = 1;
  Guidance lastGuidance;
  float lastSurvival = 1;           // probability with which the path went on after its last event
  double perNoise = 0;              // PathRoulette::PerNoise of a camera path with a roulette
  bool isDispersed = false;         // only one lane is left (SampleContext::lane)
  bool hasScatteredWidely = false;  // an earlier vertex scattered by a lobe that is no delta
  // Throughputs without the scaling by refraction and guides. That to which Russian roulette compares: the initial one,
  // or that after the last event for which the roulette was learned. The largest that a camera path may have.
  float emitted = 1, most = 1;
  ScatteringParts event;  // at the last vertex; only with SampleContext::outputs

  Color Throughput() const { return diffuse + specular; }
};

// The vertices of a path so far. Reused from path to path, because vertices are large.
class Subpath {
 public:
  // Without `keepsAll` only the last vertex is kept, and the next one while it is made.
  explicit Subpath(bool keepsAll = true) : keepsAll_(keepsAll) {}

  void Clear() { count_ = 0; }
  // Steady: receivers (Vertex::receiver) depend on the position, but not on the draw of a mix nor on normal and bump
  // maps. Merging needs this: the weight of a merge takes the probability of selecting the light at the photon's vertex
  // for that at the camera's.
  void SetSteadyReceivers(bool areSteady) { hasSteadyReceivers_ = areSteady; }
  bool HasSteadyReceivers() const { return hasSteadyReceivers_; }
  size_t Count() const { return count_; }
  const PathVertex& operator[](size_t index) const { return vertices_[keepsAll_ ? index : index % 2]; }
  PathVertex& operator[](size_t index) { return vertices_[keepsAll_ ? index : index % 2]; }
  const PathVertex& Last() const { return (*this)[count_ - 1]; }
  PathVertex& Last() { return (*this)[count_ - 1]; }
  std::span<const PathVertex> First(size_t count) const { return {vertices_.data(), count}; }

  // Storage of the next vertex, which counts only after Add(). May reallocate, which moves the other vertices.
  PathVertex& Next() {
    if (keepsAll_ ? count_ >= vertices_.size() : vertices_.empty())
      vertices_.resize(keepsAll_ ? std::max<size_t>(8, 2 * count_) : 2);
    return (*this)[count_];
  }
  void Add() { ++count_; }
  void Drop() { --count_; }  // the last vertex

  // Labels (path_labels.h), with SampleContext::outputs. Sets that of the start: the camera, or a light.
  void SetStart(uint32_t label) { start_ = label; }
  // Labels of the path that arrives at a vertex.
  std::span<const PathLabel> LabelsAt(size_t index) const { return labels_[keepsAll_ ? index : index % 2].All(); }
  // Labels of the path along the ray that leaves its last vertex.
  void LabelsBeyond(const OutputPlan& plan, TransportMode mode, const ScatteringParts& event, PathLabels& beyond) const;
  // Sets those of the last vertex, which was added after `event`.
  void LabelLast(const OutputPlan& plan, TransportMode mode, const ScatteringParts& event);

 private:
  bool keepsAll_;
  bool hasSteadyReceivers_ = false;
  std::vector<PathVertex> vertices_;
  size_t count_ = 0;
  uint32_t start_ = OutputPlan::kCamera;
  std::vector<PathLabels> labels_;
};

// Callbacks while a path grows. `path` has the vertices before the ray in question.
class PathVisitor {
 public:
  virtual ~PathVisitor() = default;
  // The ray has left the scene; the path ends.
  virtual void Escaped(const Subpath& /*path*/, const PathState&) {}
  // The ray has hit a surface, which emits light if `isLight`. False: the path ends there.
  virtual bool Met(const Subpath& /*path*/, const PathState&, const RayHit&, const SurfacePoint&, bool /*isLight*/) {
    return true;
  }
  // Radiance emitted by media along the ray of `state`, as it arrives at the ray's start; its throughput is that of
  // `state`.
  virtual void Glowed(const Subpath& /*path*/, const PathState&, const Color& /*radiance*/) {}
  // The ray of `state` has been traced through media. Called before β and the vertices are updated, if
  // WalkSettings::seesFlights.
  virtual void Flew(Subpath& /*path*/, const PathState&, const Flight&) {}
  // The ray has collided with a participating medium, before a surface or an escape. False: the path ends there.
  virtual bool Collided(const Subpath& /*path*/, const PathState&) { return true; }
  // A vertex was added to the path: the last one. False: the path ends there.
  virtual bool Arrived(Subpath& path, const PathState&) = 0;
  // What the path has found so far, for its record: mean of the channels.
  virtual float Found() const { return 0; }
  // The last vertex has scattered into the next ray, which is not traced yet. False: the path ends there.
  virtual bool Scattered(const Subpath& /*path*/, const PathState&) { return true; }
};

struct WalkSettings {
  TransportMode mode = TransportMode::Radiance;
  int maxDepth = 5;  // maximum number of vertices
  PathDimensions dimensions{};
  bool hasRoulette = true;
  // Probability with which a camera path continues beyond its first vertex that scatters by another event than a delta,
  // if photons can be merged there (TechniqueCounts::continuing). It is a factor of the density of what follows.
  float continuing = 1;
  // Materials of the vertices behind a wide scattering; null: those of the scene.
  const std::vector<std::shared_ptr<const Material>>* materialsAfterWide = nullptr;
  bool seesFlights = false;        // PathVisitor::Flew is called, in scenes with media
  bool wantsBeams = false;         // with Flight::beam
  PathRecords* records = nullptr;  // receive the events at vertices that scatter widely
};

// Makes a vertex in the medium `medium`. `direction`: of the ray that arrives.
void MakeVertexInMedium(const RenderScene& scene, const Point3d& position, const Vector3& direction, int32_t medium,
                        const PhaseBsdf& phase, const Color& extinction, Vertex& vertex);

// Extends a path from `state` until it escapes or is absorbed, the visitor ends it, or it has hit a surface with
// maxDepth vertices behind it. `path`: its vertices so far; none, or those that `state` comes from. The first ray of a
// camera path is counted as a camera ray, all others as indirect rays.
void Walk(const SampleContext& context, const WalkSettings& settings, PathState& state, Subpath& path,
          PathVisitor& visitor);

// The records of a camera path, which EndPath() is to be called for; null: it is not recorded.
PathRecords* StartRecord(const SampleContext& context);

// One step of the walk: samples the scattering at `vertex`, applies Russian roulette, and sets the event of the vertex
// and the next ray of `state`. `index`: of the vertex, from 0. False: the path ends.
bool Scatter(const SampleContext& context, const WalkSettings& settings, int index, PathVertex& vertex,
             PathState& state);

}  // namespace lampyr
