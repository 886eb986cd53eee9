// Ray origins that clear the surface they start from, by a distance that follows from the point's own rounding error:
// no epsilon in scene units, so a scene renders alike at any scale and place ([Pharr23 §6.8]).
#pragma once

#include "geometry/ray.h"
#include "math/transform.h"

namespace lampyr {

// `position` moved along ±Ng to the side that `direction` points to, beyond the error box, then rounded away.
Point3 OffsetRayOrigin(const Point3& position, const Vector3& positionError, const Normal3& Ng,
                       const Vector3& direction);

// Bound, in render space, on the rounding error of a ray that starts at `origin` and is transformed to an instance's
// space in float. It exceeds a point's own error by far if the instance is rotated and far from the origin of render
// space.
Vector3 InstanceRayError(const Affine& toRender, const Affine& toObject, const Point3& origin);

// A ray from a surface point along the unit `direction`.
inline Ray SpawnRay(const SurfacePoint& from, const Vector3& direction, float time) {
  return {OffsetRayOrigin(from.position, from.positionError, from.Ng, direction), direction, kInfinity, time};
}

// A shadow ray between two surface points, clear of both; unit direction, tMax short of the target.
// `targetNg` is the zero vector where the target is a point in space.
Ray SpawnRayTo(const SurfacePoint& from, const Point3& target, const Vector3& targetError, const Normal3& targetNg,
               float time);

}  // namespace lampyr
