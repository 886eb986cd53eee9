// How subpaths grow, from the camera and from lights alike: a ray's hit becomes a vertex, a vertex scatters into the
// next ray, and densities and weights follow.
#pragma once

#include <vector>

#include "integrators/common/path_vertex.h"
#include "integrators/integrator.h"

namespace lampyr {

// A ray on its way to the next vertex, and what it carries.
struct Flight {
  Ray ray;
  Color diffuse, specular;
  double pdf = 0;  // 1/sr at the last vertex
  float etaScale = 1;
};

// Where a subpath draws from: vertex v has the block step · v + first. Two subpaths of a sample take turns.
struct SubpathDimensions {
  int step = 1, first = 0;
  constexpr uint32_t Of(int vertex, uint32_t which) const { return dimensions::OfVertex(step * vertex + first, which); }
};

inline float CosineAt(const PathVertex& vertex, const Vector3& direction) {
  return glm::dot(direction, vertex.bsdf.Ng());
}

// The place of vertex `index`, made where there is none yet: other vertices may move.
PathVertex& PlaceOf(std::vector<PathVertex>& vertices, size_t index);

// Sets what a vertex is by itself: point, scattering, receiver, visibility. False: a black surface, where paths end.
bool MakeVertex(const RenderScene& scene, const Ray& ray, const RayHit& hit, const SurfacePoint& point,
                PathVertex& vertex);

// Chooses how a path goes on from `vertex`, with Russian roulette, and sets the vertex's event. `depth` is that of the
// vertex, 1 for the first, which `from` draws from as vertex `block`; `scale` is what roulette compares with: the flux
// at the start of a path from a light, 1 for the camera's. False: the path ends.
bool Scatter(PathVertex& vertex, TransportMode mode, int depth, const SubpathDimensions& from, int block, float scale,
             Sampler& sampler, Flight& flight);

// Sets the densities and the weight of a vertex that its subpath found from the previous one. Without `connects`, the
// weight is that of merging alone.
void Follow(const PathVertex& previous, const Flight& flight, bool connects, PathVertex& vertex);

// From the densities of an emission to area at the vertex where it lands.
double LandingFactor(const LightingServices& lighting, uint32_t light, float cosTheta, double distanceSquared);

LightEnd EndOf(const LightingServices& lighting, const FoundLight& found, bool canBeHit, double landing);

}  // namespace lampyr
