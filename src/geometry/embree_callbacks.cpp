// See embree_callbacks.h.
#include "geometry/embree_callbacks.h"

#include <algorithm>

#include "geometry/meeting.h"

namespace lampyr {

namespace {

const PrimitiveRecord& Record(const void* userPointer) {
  return *static_cast<const PrimitiveRecord*>(userPointer);
}

TraceContext& Trace(RTCIntersectContext* context) {
  return *reinterpret_cast<TraceContext*>(context);
}

}  // namespace

void OwnIntersect(const RTCIntersectFunctionNArguments* arguments) {
  if (!arguments->valid[0]) return;
  const Meeting at{Record(arguments->geometryUserPtr), arguments->geomID, arguments->primID,
                   arguments->context->instID[0]};
  IntersectOwn(at, *reinterpret_cast<RTCRayHit*>(arguments->rayhit), Trace(arguments->context));
}

void OwnOccluded(const RTCOccludedFunctionNArguments* arguments) {
  if (!arguments->valid[0]) return;
  const Meeting at{Record(arguments->geometryUserPtr), arguments->geomID, arguments->primID,
                   arguments->context->instID[0]};
  auto& ray = *reinterpret_cast<RTCRay*>(arguments->ray);
  if (OccludesOwn(at, ray, Trace(arguments->context))) ray.tfar = -kInfinity;
}

// Embree interpolates the bounds linearly between two time steps. The bounds of a step therefore hold the surface from
// the step before to the step after.
void SetOwnBounds(const RTCBoundsFunctionArguments* arguments) {
  const PrimitiveRecord& record = Record(arguments->geometryUserPtr);
  const auto* custom = record.As<CustomSurface>();
  float begin = 0, end = 1;
  if (custom && custom->Moves()) {
    constexpr float segments = kCustomTimeSteps - 1;
    begin = std::max(static_cast<float>(arguments->timeStep) - 1, 0.0f) / segments;
    end = std::min(static_cast<float>(arguments->timeStep) + 1, segments) / segments;
  }
  const Bounds3 bounds = OwnBounds(record, arguments->primID, begin, end);
  RTCBounds& out = *arguments->bounds_o;
  out.lower_x = bounds.min.x;
  out.lower_y = bounds.min.y;
  out.lower_z = bounds.min.z;
  out.upper_x = bounds.max.x;
  out.upper_y = bounds.max.y;
  out.upper_z = bounds.max.z;
}

namespace {

void Filter(const RTCFilterFunctionNArguments* arguments, bool isShadow) {
  if (!arguments->valid[0]) return;
  const auto& ray = *reinterpret_cast<const RTCRay*>(arguments->ray);
  const auto& hit = *reinterpret_cast<const RTCHit*>(arguments->hit);
  const RayHit rayHit{ray.tfar, hit.geomID, hit.primID, hit.instID[0], hit.u, hit.v};
  // A round curve is entered and left; the normal distinguishes the two hits.
  const bool leaves = hit.Ng_x * ray.dir_x + hit.Ng_y * ray.dir_y + hit.Ng_z * ray.dir_z > 0;
  const Meeting at{Record(arguments->geometryUserPtr), hit.geomID, hit.primID, hit.instID[0], leaves ? 1u : 0u};
  if (at.record.hasNoInside) {
    if (leaves) arguments->valid[0] = 0;
    if (leaves || !at.record.alpha) return;
  }
  if (PassesThrough(at, ray, rayHit, Trace(arguments->context), isShadow)) arguments->valid[0] = 0;
}

}  // namespace

void PassFilter(const RTCFilterFunctionNArguments* arguments) {
  Filter(arguments, false);
}
void TransmitFilter(const RTCFilterFunctionNArguments* arguments) {
  Filter(arguments, true);
}

}  // namespace lampyr
