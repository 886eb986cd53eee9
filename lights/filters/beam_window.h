// A window in a light's beam: the plane z = −distance of the filter's own space. As lights of UsdLux do, the light
// emits along −z.
#pragma once

#include <optional>

#include "lights/filters/filter_base.h"

namespace lampyr {

struct BeamWindow {
  float distance = 1;      // > 0
  bool isPhysical = true;  // crossed by the ray itself, from its place on the light; else by the line from the origin

  // Intersection of the light along an edge with the plane, seen along −z; nullopt if there is none.
  std::optional<Point2> Crossing(const FilterEdge& edge) const {
    const Point3& P = edge.receiver;
    if (!isPhysical) {
      if (!(P.z < 0)) return std::nullopt;
      const float scale = distance / -P.z;
      return Point2(P.x * scale, P.y * scale);
    }
    if (!(edge.towards.z > 0)) return std::nullopt;
    const float t = (-distance - P.z) / edge.towards.z;
    if (!(t >= 0 && t <= edge.distance)) return std::nullopt;
    return Point2(P.x + t * edge.towards.x, P.y + t * edge.towards.y);
  }
};

// Table rows of the parameters distance and mode, and their values. `mode` is the default.
std::vector<ParameterInfo> WithBeamParameters(const char* mode, std::vector<ParameterInfo> parameters);
BeamWindow ReadBeamWindow(const ParameterList& parameters, const char* mode);

// Signed distance to the boundary of a rectangle with half extents `half`, centred at the origin, with corners rounded
// by `radius`; negative inside. NaN if the rectangle is empty.
inline float RoundedRectangle(const Point2& p, const Vector2& half, float radius) {
  const Vector2 q = Abs(p) - half + radius;
  return glm::length(glm::max(q, 0.0f)) + std::min(std::max(q.x, q.y), 0.0f) - radius;
}

}  // namespace lampyr
