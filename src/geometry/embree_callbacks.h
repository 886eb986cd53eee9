// Private to the geometry: what Embree calls back. Intersection of quadrics, bilinear patches and custom surfaces as user
// geometry, and filters for cut-outs. Every callback's user pointer is a PrimitiveRecord; rays come one at a time.
#pragma once

#include <embree3/rtcore.h>

namespace lampyr {

void QuadricBounds(const RTCBoundsFunctionArguments* arguments);
void QuadricIntersect(const RTCIntersectFunctionNArguments* arguments);
void QuadricOccluded(const RTCOccludedFunctionNArguments* arguments);

void PatchBounds(const RTCBoundsFunctionArguments* arguments);
void PatchIntersect(const RTCIntersectFunctionNArguments* arguments);
void PatchOccluded(const RTCOccludedFunctionNArguments* arguments);

// For surfaces that move, with kCustomTimeSteps bounds over the shutter.
inline constexpr unsigned kCustomTimeSteps = 33;
void CustomBounds(const RTCBoundsFunctionArguments* arguments);
void CustomIntersect(const RTCIntersectFunctionNArguments* arguments);
void CustomOccluded(const RTCOccludedFunctionNArguments* arguments);

// For geometry that Embree intersects itself: rejects hits that the cut-out lets through.
void AlphaFilter(const RTCFilterFunctionNArguments* arguments);

}  // namespace lampyr
