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

// Irradiance along a segment, evaluated at its point nearest to the centre of the box. The segment is clipped where the
// emitter is flat, one-sided and seen from behind.
std::optional<SegmentEstimate> SurfaceSegmentEstimate(const EmissionBounds& bounds, float power, const Point3& origin,
                                                      const Vector3& direction, float length);

// The parameter in [minT, maxT] of the point of the segment nearest to `point`.
inline float NearestOnSegment(const Point3& origin, const Vector3& direction, float minT, float maxT,
                              const Point3& point) {
  return std::min(std::max(glm::dot(point - origin, direction), minT), maxT);
}

}  // namespace lampyr
