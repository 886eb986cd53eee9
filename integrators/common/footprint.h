// How much of the scene a pixel sees: the scale that radii of photon lookups come from.
#pragma once

#include <functional>

#include "integrators/common/path_vertex.h"
#include "integrators/integrator.h"

namespace lampyr {

// The area (square of scene units, across the ray) that a pixel of the full image sees at `distance` along a camera
// ray. Mirrors and glass between are taken for flat.
double PixelArea(const Camera& camera, const Ray& ray, double filmPixels, double distance);

// What the camera sees along a ray: the first vertex that is not a delta alone, past those that are. False: nothing.
// `distance` is the length of the way there. Draws from `sampler`.
bool FindSeenVertex(const RenderScene& scene, const Ray& ray, Sampler& sampler, PathVertex& vertex, double& distance);

// Calls `visit` with what a grid of across² rays over the image sees, where it sees something. Always the same.
using SeenVisitor = std::function<void(const Ray& ray, PathVertex& vertex, double distance, Sampler& sampler)>;
void VisitSeen(const RenderScene& scene, int width, int height, int across, const SeenVisitor& visit);

// The side of a pixel where the camera sees something that is not a delta: the median over the image, and over mirrors
// and glass. Without anything to see, a thousandth of the scene's radius. Always the same for a scene.
double TypicalFootprint(const RenderScene& scene, int width, int height);

}  // namespace lampyr
