// A cone of directions in a light's local space, seen from render space: its bounding cone there, and the part of a ray
// segment that runs through it. The cone is given by its unit axis and w = 1 - cosθ of its edge, which keeps its digits
// for narrow cones.
#pragma once

#include "lights/light.h"

namespace lampyr {

// Sets axis and angles of the bounds. Unspecified beyond 90° under transforms that do not preserve angles.
void SetConeBounds(const LightTransform& transform, const Vector3& axis, float w, EmissionBounds& bounds);

// Clips [minT, maxT] to the cone with its apex at the local point `from`, slightly widened against rounding. False:
// empty.
bool ClipToCone(const LightTransform& transform, const Point3& from, const Vector3& axis, float w, const Point3& origin,
                const Vector3& direction, float& minT, float& maxT);

// Angle between two unit vectors, accurate for small angles.
inline float AngleBetween(const Vector3& a, const Vector3& b) {
  return 2 * std::asin(std::min(0.5f * glm::length(a - b), 1.0f));
}

}  // namespace lampyr
