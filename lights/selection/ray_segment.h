// A segment of a ray in a medium, for which a light is selected; and the estimates of the lights for it.
#pragma once

#include <cstdint>
#include <optional>

#include "lights/light.h"

namespace lampyr {

struct RaySegment {
  Point3 origin{0.0f};
  Vector3 direction{0, 0, 1};  // unit
  float length = kInfinity;    // may be infinite
  float time = 0;              // in [0,1]
  uint32_t link = 0;           // class of light linking of the medium (Receiver::link)
};

// The lights of a selector, as seen from one segment.
class SegmentLights {
 public:
  virtual ~SegmentLights() = default;
  // The light's own estimate for the segment (Light::GetIncidentRadianceEstimate), with the factors by which its
  // selection is scaled. nullopt: no light reaches the segment.
  virtual std::optional<SegmentEstimate> EstimateOf(uint32_t light, int patch) const = 0;
};

}  // namespace lampyr
