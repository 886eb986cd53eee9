// Cheap estimates of the irradiance by an emitter at a point or along a ray segment, from its emission bounds alone.
// They are positive wherever the light can contribute: angles are widened by the angle that the box subtends ([Conty18
// §4.2]).
#pragma once

#include <optional>

#include "lights/light.h"

namespace lampyr {

// Irradiance at P on a surface facing the emitter; `power` is its power, mean of the channels. For surfaces that emit
// by the cosine law.
float SurfaceIrradianceEstimate(const EmissionBounds& bounds, float power, const Point3& P);

// Irradiance along a segment: a bound of SurfaceIrradianceEstimate over its points, by its least distance from the
// centre of the box and its largest cosine. The segment, whose length may be infinite, is clipped where the emitter is
// flat, one-sided and seen from behind.
std::optional<SegmentEstimate> SurfaceSegmentEstimate(const EmissionBounds& bounds, float power, const Point3& origin,
                                                      const Vector3& direction, float length);

// The parameter in [minT, maxT] of the point of the segment nearest to `point`.
inline float NearestOnSegment(const Point3& origin, const Vector3& direction, float minT, float maxT,
                              const Point3& point) {
  return std::min(std::max(glm::dot(point - origin, direction), minT), maxT);
}

// Largest n · p / |p| over the points p = from + t along with t in [0, length]: the cosine of the least angle between n
// and a point of a segment, times the length of n. `along` is unit, `length` may be infinite.
double LargestCosine(const Vector3d& n, const Vector3d& from, const Vector3d& along, double length);

// Angle under which a point sees a segment of a line at `distance` > 0 from it. `start`: where the segment starts,
// relative to the foot of the point; `length` may be infinite. Accurate for tiny angles, too.
double SegmentAngle(double distance, double start, double length);

}  // namespace lampyr
