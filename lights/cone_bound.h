// A cone of directions in a light's local space, seen from render space: its bounding cone there, and the part of a ray
// segment that runs through it. The cone is given by its unit axis and w = 1 - cosθ of its edge, which keeps its digits
// for narrow cones.
#pragma once

#include "lights/light.h"

namespace lampyr {

// Sets axis and angles of the bounds; beyond 90° nothing is promised under transforms that do not keep angles.
void SetConeBounds(const LightTransform& transform, const Vector3& axis, float w, EmissionBounds& bounds);

// Cuts [minT, maxT] to what is within the cone at the local point `from`, widened a little against rounding; false when
// that is nothing.
bool ClipToCone(const LightTransform& transform, const Point3& from, const Vector3& axis, float w, const Point3& origin,
                const Vector3& direction, float& minT, float& maxT);

// The angle between two unit vectors, exact for small ones too.
inline float AngleBetween(const Vector3& a, const Vector3& b) {
  return 2 * std::asin(std::min(0.5f * glm::length(a - b), 1.0f));
}

}  // namespace lampyr
