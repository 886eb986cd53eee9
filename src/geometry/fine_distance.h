// Private to the geometry: intersection of a line with a surface, beyond the precision of Embree.
#pragma once

#include <vector>

#include "geometry/fine_line.h"
#include "geometry/ray.h"
#include "geometry/scene_tables.h"

namespace lampyr {

// Parameter of the line's intersection with the surface of a hit or crossing that was found near `about`; `about`
// itself if there is no better one: curves, custom surfaces, lines that only touch. Only primitive, patch and instance
// of `hit` are read.
double FineDistance(const SceneTables& tables, const FineLine& line, float time, const RayHit& hit, double about);

// Sets the distances of the crossings of a ray whose origin is `ahead` in front of the start of the line, and drops
// those that are not on the line. The order may change.
void RefineCrossings(const SceneTables& tables, const FineLine& line, float time, double ahead,
                     std::vector<Crossing>& crossings);

}  // namespace lampyr
