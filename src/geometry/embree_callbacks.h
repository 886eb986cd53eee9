// Private to the geometry: what Embree calls back. Intersection of quadrics, bilinear patches and custom surfaces as
// user geometry, and filters for cut-outs. Every callback's user pointer is a PrimitiveRecord; rays come one at a time.
#pragma once

#include <embree3/rtcore.h>

#include <exception>
#include <vector>

#include "geometry/ray.h"

namespace lampyr {

// State of one query. Embree hands the address of its first member to every callback.
struct TraceContext {
  RTCIntersectContext context;
  // Surfaces that let the ray pass, in the order in which Embree visits them: of Trace, thin surfaces and boundaries,
  // whether or not a nearer hit is found later; of Transmittance, cut-outs, too. Null: not recorded.
  std::vector<Crossing>* crossings = nullptr;
  float nearest = kNearestHit;     // of Trace: nothing before it is met
  bool recordsBoundaries = false;  // false: `crossings` lacks the boundaries between media
  Color transmittance{1.0f};  // of Transmittance: product over the crossings so far; the query ends when it is black
  // Thrown by a custom surface, which counts as missed: no exception may pass through Embree. Rethrown by
  // ThrowFailure after Embree has returned.
  std::exception_ptr failure;

  void ThrowFailure() const {
    if (failure) [[unlikely]]
      std::rethrow_exception(failure);
  }
};

void QuadricBounds(const RTCBoundsFunctionArguments* arguments);
void QuadricIntersect(const RTCIntersectFunctionNArguments* arguments);
void QuadricOccluded(const RTCOccludedFunctionNArguments* arguments);

void PatchBounds(const RTCBoundsFunctionArguments* arguments);
void PatchIntersect(const RTCIntersectFunctionNArguments* arguments);
void PatchOccluded(const RTCOccludedFunctionNArguments* arguments);

// Surfaces that move have kCustomTimeSteps bounds over the shutter.
inline constexpr unsigned kCustomTimeSteps = 33;
void CustomBounds(const RTCBoundsFunctionArguments* arguments);
void CustomIntersect(const RTCIntersectFunctionNArguments* arguments);
void CustomOccluded(const RTCOccludedFunctionNArguments* arguments);

// Filters for geometry that Embree intersects itself. PassFilter (Intersect) rejects the hits at which a cut-out or
// thin surface lets the ray pass, which is decided by hash. TransmitFilter (Transmittance) rejects all hits that leave
// some transmittance.
void PassFilter(const RTCFilterFunctionNArguments* arguments);
void TransmitFilter(const RTCFilterFunctionNArguments* arguments);

}  // namespace lampyr
