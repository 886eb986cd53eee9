// Private to the geometry: what Embree calls back. Intersection of quadrics, bilinear patches and custom surfaces as
// user geometry, and filters for cut-outs. Every callback's user pointer is a PrimitiveRecord; rays come one at a time.
#pragma once

#include <embree3/rtcore.h>

#include <exception>
#include <vector>

#include "math/vec.h"

namespace lampyr {

// A sheet that a ray goes through, if it comes that far.
struct PassedSheet {
  float t;
  Color tint;
};

// What a query carries along: Embree hands the address of its first member to every callback.
struct TraceContext {
  RTCIntersectContext context;
  std::vector<PassedSheet>* sheets = nullptr;  // of Intersect; null: no sheet has a colour
  Color transmission{1.0f};                    // of Transmission: what is left so far
  bool hasCrossedCurves = false;               // some curve that lets something pass
  // What a custom surface threw, which is then missed: no exception may pass through Embree. To be thrown when it has
  // returned.
  std::exception_ptr failure;

  void ThrowFailure() const {
    if (failure) [[unlikely]] std::rethrow_exception(failure);
  }
};

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

// For geometry that Embree intersects itself: rejects hits that a cut-out or a sheet lets through, by chance; and, of
// shadow rays, all that leave something of them.
void PassFilter(const RTCFilterFunctionNArguments* arguments);
void TransmitFilter(const RTCFilterFunctionNArguments* arguments);

}  // namespace lampyr
