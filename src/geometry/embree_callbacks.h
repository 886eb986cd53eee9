// Private to the geometry: the callbacks of Embree. Intersection of quadrics, bilinear patches and custom surfaces as
// user geometry, and filters for cut-outs. The user pointer of each callback is a PrimitiveRecord; rays come one at a
// time.
#pragma once

#include <embree3/rtcore.h>

namespace lampyr {

// Custom surfaces that move have kCustomTimeSteps bounds over the shutter.
inline constexpr unsigned kCustomTimeSteps = 33;

void SetOwnBounds(const RTCBoundsFunctionArguments* arguments);
void OwnIntersect(const RTCIntersectFunctionNArguments* arguments);
void OwnOccluded(const RTCOccludedFunctionNArguments* arguments);

// Filters for geometry that Embree intersects itself. PassFilter (Intersect) rejects the hits at which a cut-out or
// thin surface lets the ray pass, which is decided by hash. TransmitFilter (Transmittance) rejects all hits that leave
// some transmittance.
void PassFilter(const RTCFilterFunctionNArguments* arguments);
void TransmitFilter(const RTCFilterFunctionNArguments* arguments);

}  // namespace lampyr
