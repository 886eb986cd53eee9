// How paths grow, from the camera and from lights alike: a ray is traced, its hit becomes a vertex, the vertex scatters
// into the next ray. The only loop that does so; integrators watch it (PathVisitor) and estimate light at its vertices.
#pragma once

#include <algorithm>
#include <vector>

#include "integrators/walk/integrator.h"
#include "integrators/walk/vertex.h"

namespace lampyr {

// A path on its way from one vertex to the next.
struct PathState {
  Ray ray;
  // Throughput β, by the kind of lobe that it left the last vertex by: a light that it finds may send either different
  // radiance. On paths from a light both are the same, but up to the first vertex.
  Color diffuse, specular;
  SolidAngleDensity pdfDirection;  // of the ray at the last vertex (DensitiesOf)
  Color passed{1.0f};              // part of the throughput: what the last ray was multiplied by for what it crossed
  float length = 0;                // of the whole path so far
  float etaScale = 1;              // radiance is scaled by η² where it enters glass: what undoes that
  float emitted = 1;               // throughput at the start, which Russian roulette compares with

  Color Throughput() const { return diffuse + specular; }
};

// The vertices of a path so far. Its memory is kept from path to path: vertices are large.
class Subpath {
 public:
  // Without `keepsAll`, the last vertex alone is there.
  explicit Subpath(bool keepsAll = true) : keepsAll_(keepsAll) {}

  void Clear() { count_ = 0; }
  size_t Count() const { return count_; }
  const PathVertex& operator[](size_t index) const { return vertices_[keepsAll_ ? index : 0]; }
  PathVertex& operator[](size_t index) { return vertices_[keepsAll_ ? index : 0]; }
  const PathVertex& Last() const { return (*this)[count_ - 1]; }
  PathVertex& Last() { return (*this)[count_ - 1]; }
  std::span<const PathVertex> First(size_t count) const { return {vertices_.data(), count}; }

  // The place of the vertex that comes next; other vertices may move. It counts once it is added.
  PathVertex& Next() {
    const size_t index = keepsAll_ ? count_ : 0;
    if (index >= vertices_.size()) vertices_.resize(keepsAll_ ? std::max<size_t>(8, 2 * index) : 1);
    return vertices_[index];
  }
  void Add() { ++count_; }

 private:
  bool keepsAll_;
  std::vector<PathVertex> vertices_;
  size_t count_ = 0;
};

// What somebody makes of a path while it grows. `path` has the vertices before the ray that is spoken of.
class PathVisitor {
 public:
  virtual ~PathVisitor() = default;
  // The ray has left the scene. The path ends.
  virtual void Escaped(const Subpath& /*path*/, const PathState&) {}
  // The ray has met a surface, which emits light if `isLight`. False: the path ends there.
  virtual bool Met(const Subpath& /*path*/, const PathState&, const RayHit&, const SurfacePoint&, bool /*isLight*/) {
    return true;
  }
  // The path has another vertex, its last. False: it ends there.
  virtual bool Arrived(Subpath& path, const PathState&) = 0;
  // The last vertex has scattered into the next ray, which is not traced yet. False: the path ends there.
  virtual bool Scattered(const Subpath& /*path*/, const PathState&) { return true; }
};

struct WalkSettings {
  TransportMode mode = TransportMode::Radiance;
  int maxDepth = 5;  // vertices at most
  PathDimensions dimensions{};
  bool hasRoulette = true;
};

// Lets a path grow from `state` until it ends, is told to, or has as many vertices as it may have. `path` is its
// vertices so far: none, or those that `state` comes from. Rays that a camera path begins with are counted as camera
// rays.
void Walk(const SampleContext& context, const WalkSettings& settings, PathState& state, Subpath& path,
          PathVisitor& visitor);

// One step of it: chooses how a path goes on from `vertex`, with Russian roulette, and sets the vertex's event.
// `index`: of the vertex, from 0. False: the path ends.
bool Scatter(const SampleContext& context, const WalkSettings& settings, int index, PathVertex& vertex,
             PathState& state);

// What a vertex is by itself: point, scattering, receiver, visibility. False: a black surface, where paths end.
bool MakeVertex(const RenderScene& scene, const Ray& ray, const RayHit& hit, const SurfacePoint& point, Vertex& vertex);

}  // namespace lampyr
