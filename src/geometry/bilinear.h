// Bilinear patches p(u,v): intersection after [Reshetov19] and surface parametrisation in the conventions of pbrt-v4.
#pragma once

#include "geometry/quadric.h"
#include "geometry/ray.h"
#include "geometry/shapes.h"

namespace lampyr {

struct PatchHit {
  double t = 0;
  Point2 uv{0.0f};
};

// Finds the hits with t in (tMin, tMax], nearest first; returns their number.
int IntersectPatch(const BilinearMesh& mesh, uint32_t patch, const RayDouble& ray, PatchHit hits[2]);

// uv of the patch's own vertices where it has some, the parameters themselves otherwise.
Point2 PatchUv(const BilinearMesh& mesh, uint32_t patch, const Point2& parameters);

// Sets position, error, normals, uv and tangents, but not the indices. `towards` is the fallback normal of a degenerate
// patch.
void EvaluatePatch(const BilinearMesh& mesh, uint32_t patch, const Point2& parameters, const Vector3& towards,
                   SurfacePoint& point);

}  // namespace lampyr
