// How much of the scene a pixel sees: the scale that radii of photon lookups come from. And what a grid of camera rays
// sees, for those who look at a scene before it is rendered.
#pragma once

#include <functional>

#include "integrators/walk/walk.h"

namespace lampyr {

// The area (square of scene units, across the ray) that a pixel of the full image sees at `distance` along a camera
// ray. Mirrors and glass between are taken for flat.
double PixelArea(const Camera& camera, const Ray& ray, double filmPixels, double distance);

// A vertex that a ray finds, past those that are deltas alone; `distance` is the length of the way there.
struct SeenVertex {
  PathVertex vertex;  // its throughput is 1
  float distance = 0;
};

// For those who look at a scene with rays: paths from a grid over the image, always the same.
class SceneProbe {
 public:
  explicit SceneProbe(const RenderScene& scene) : scene_(scene), sampler_(SamplerKind::Independent, 0) {}

  using Visit = std::function<void(const Ray& ray, SeenVertex& seen)>;
  // Calls `visit` with what a grid of across² rays over the image of width × height sees, where it sees something.
  void ForSeen(int width, int height, int across, const Visit& visit);

  // What is seen from a vertex along a direction that scattering samples there; `state` has its throughput. False:
  // nothing. `block`: of the sampler's dimensions, another one for other numbers.
  bool Bounce(SeenVertex& from, int block, PathState& state, SeenVertex& seen);

  Sampler& Numbers() { return sampler_; }

 private:
  bool Find(PathState& state, Subpath& path, SeenVertex& seen);
  SampleContext Context() { return {scene_, sampler_, 0, counts_}; }

  const RenderScene& scene_;
  Sampler sampler_;
  RenderCounts counts_;
  Subpath path_{false};
};

// The side of a pixel where the camera sees something that is not a delta: the median over the image, and over mirrors
// and glass. Without anything to see, a thousandth of the scene's radius. Always the same for a scene.
double TypicalFootprint(const RenderScene& scene, int width, int height);

}  // namespace lampyr
