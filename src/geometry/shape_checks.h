// Checks that shapes and placements can be traced: finite, and near enough to the origin for Embree.
#pragma once

#include "geometry/geometry_scene.h"
#include "geometry/shapes.h"

namespace lampyr {

// Bound of coordinates: beyond it, Embree aborts the process on rays, and skips primitives.
inline constexpr float kFarthest = 1e18f;

// Throws an Error for a shape that cannot be traced: not finite, or farther out than kFarthest, or with indices or
// vertex attributes that are inconsistent.
void CheckShape(const Shape& shape);

// Throws an Error for the placement of an instance that is not finite, or reaches farther than kFarthest.
void CheckPlacement(const Affine& toRender);

// The largest origin or direction of a ray that is still traceable in an instance's object space. Throws an Error where
// the transform is singular, or scales too much.
float LargestThrough(const Affine& toObject);

// Both checks, for all transforms of an instance. Returns the least of LargestThrough.
float CheckInstance(const GeometryInstance& instance);

}  // namespace lampyr
