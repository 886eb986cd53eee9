// Private to the geometry: where a line meets a surface, beyond the precision of Embree.
#pragma once

#include <vector>

#include "geometry/fine_line.h"
#include "geometry/ray.h"
#include "geometry/scene_tables.h"

namespace lampyr {

// Parameter at which the line meets the surface of a hit or crossing that was found near `about`; `about` itself where
// there is no better one: curves, custom surfaces, lines that only touch. Only primitive, patch and instance of `hit`
// are read.
double FineDistance(const SceneTables& tables, const FineLine& line, float time, const RayHit& hit, double about);

// Sets the distances of crossings that a ray has found, whose origin is `ahead` in front of the start of the line, and
// leaves out those that are not on it. The order may have changed.
void RefineCrossings(const SceneTables& tables, const FineLine& line, float time, double ahead,
                     std::vector<Crossing>& crossings);

}  // namespace lampyr
