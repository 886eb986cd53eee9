// Regions of space in which a filter changes what is lit: rounded boxes and spheres with a soft rim.
#pragma once

#include "lights/filters/filter_base.h"

namespace lampyr {

struct FilterRegion {
  Point3 center{0.0f};
  Vector3 half{0.0f};  // half extents of the box, without the rounding
  float radius = 0;    // of the rounding; of the sphere if the box has no size
  float edge = 0;      // width of the soft rim, outwards
  float falloff = 1;   // exponent of the rim
  Color color{0.0f};   // the factor within

  Color Factor(const FilterEdge& light) const {
    const Vector3 q = Abs(light.receiver - center) - half;
    const float outside = glm::length(glm::max(q, 0.0f)) + std::min(std::max(q.x, std::max(q.y, q.z)), 0.0f) - radius;
    float within = SoftEdge(outside, edge);
    if (falloff != 1) within = std::pow(within, falloff);
    return Lerp(Color(1.0f), color, within);
  }

  // From the corners of the box, rounded within them. Not for empty boxes.
  void SetBox(const Point3& low, const Point3& high, float rounding) {
    center = 0.5f * (low + high);
    half = 0.5f * (high - low);
    radius = std::clamp(rounding, 0.0f, std::min(half.x, std::min(half.y, half.z)));
    half -= radius;
  }
};

}  // namespace lampyr
