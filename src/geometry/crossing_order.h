// Private to the geometry: the order of the crossings along a ray.
#pragma once

#include <vector>

#include "geometry/ray.h"
#include "geometry/scene_tables.h"

namespace lampyr {

// Sorts by increasing t. At equal t a ray leaves one medium before it enters the next; then by primitive, so that a
// product does not depend on the order of traversal.
void SortByDistance(std::vector<Crossing>& crossings);

// Orders boundaries that coincide, up to rounding, such that the ray passes from medium to medium: each starts in the
// medium in which the one before it has ended, if such an order exists. Touching boxes, and nested boundaries that
// share a face, are then passed without a false medium in between, although their distances are rounded independently.
// A crossing that is reported twice at an edge of two triangles or patches is kept once.
//
// Not repaired: a ray that touches an edge in the silhouette of a mesh within rounding may be reported by one of its
// two faces alone. Of random rays through a ball of 80 000 triangles, 2 in 10⁷ leave it in the wrong medium, up to the
// next boundary.
//
// `crossings` are sorted, and their distances stay sorted. `largest`: the largest coordinate of the ray's origin.
void OrderCoincident(const SceneTables& tables, double largest, std::vector<Crossing>& crossings);

}  // namespace lampyr
