// Surface points on triangle meshes.
#pragma once

#include "geometry/ray.h"
#include "geometry/shapes.h"

namespace lampyr {

// Texture coordinates at barycentrics (b1, b2); without vertex coordinates the corners are (0,0), (1,0), (1,1).
Point2 TriangleUv(const TriangleMesh& mesh, uint32_t triangle, const Point2& barycentrics);

// Sets position with error bound, normals, and, with `isParametrized`, uv and tangents at barycentrics (b1, b2).
// `towards` is the fallback normal of a triangle without area. Does not set the indices.
void EvaluateTriangle(const TriangleMesh& mesh, uint32_t triangle, const Point2& barycentrics, const Vector3& towards,
                      bool isParametrized, SurfacePoint& point);

}  // namespace lampyr
