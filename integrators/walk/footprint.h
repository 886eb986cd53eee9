// Pixel footprints, from which the radii of photon lookups are derived; and SceneProbe, which analyses a scene by a
// coarse grid of camera rays before it is rendered.
#pragma once

#include <functional>

#include "integrators/walk/walk.h"

namespace lampyr {

// Area of the footprint of a pixel of the full image, in square scene units perpendicular to the camera ray, at path
// length `distance`. `filmPixels`: pixels of the full image. Mirrors and glass on the way are treated as flat. 0 if the
// camera does not generate `ray`.
double PixelArea(const Camera& camera, const Ray& ray, double filmPixels, double distance);

// The first vertex on a path that is not a delta. `distance`: path length to it, scene units.
struct SeenVertex {
  PathVertex vertex;  // with throughput 1
  float distance = 0;
};

// Traces paths over a regular grid of film points, for scene analysis. Deterministic.
class SceneProbe {
 public:
  explicit SceneProbe(const RenderScene& scene) : scene_(scene), sampler_(SamplerKind::Independent, 0) {}

  using Visit = std::function<void(const Ray& ray, SeenVertex& seen)>;
  // Calls `visit` with the first non-delta vertex of each of across² camera rays on a grid over an image of width ×
  // height pixels. Rays that reach no such vertex are skipped.
  void ForEachVisible(int width, int height, int across, const Visit& visit);

  // Samples the scattering at `from` and finds the first non-delta vertex in that direction. `state`: path state after
  // the scattering, with its throughput. `block`: the vertex block of sampler dimensions to draw from; each block has
  // other numbers. False: no vertex was found.
  bool Bounce(SeenVertex& from, int block, PathState& state, SeenVertex& seen);

 private:
  bool Find(PathState& state, Subpath& path, SeenVertex& seen);
  SampleContext Context() { return {scene_, sampler_, 0, counts_}; }

  const RenderScene& scene_;
  Sampler sampler_;
  RenderCounts counts_;
  Subpath path_{false};
};

}  // namespace lampyr
