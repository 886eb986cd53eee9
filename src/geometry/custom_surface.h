// A surface that is defined by its intersection with rays, such as that of a light with a shape of its own. Traced in
// double and in render space, also while it moves.
#pragma once

#include <optional>

#include "geometry/ray.h"
#include "math/bounds.h"

namespace lampyr {

class CustomSurface {
 public:
  virtual ~CustomSurface() = default;

  // True if the surface depends on time.
  virtual bool Moves() const = 0;

  // Bounds of the surface from shutter time `begin` to `end`.
  virtual Bounds3 GetBounds(float begin, float end) const = 0;

  // The t of the nearest hit with t in (ray.tMin, ray.tMax] at shutter time `time`. Must be deterministic: the same ray
  // finds the same hit, also with another tMax beyond it. If `point` is given, sets position, error bound, normals and
  // uv, but not the indices.
  virtual std::optional<double> Intersect(const RayDouble& ray, float time, SurfacePoint* point) const = 0;
};

}  // namespace lampyr
