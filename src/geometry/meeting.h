// Private to the geometry: intersection of the surfaces that Embree does not intersect itself (quadrics, bilinear
// patches, custom surfaces), and the decision whether a surface stops a ray. Used by both tracers: Embree, through its
// callbacks, and FewSurfaces.
#pragma once

#include <embree3/rtcore.h>

#include <exception>
#include <vector>

#include "geometry/ray.h"
#include "geometry/scene_tables.h"

namespace lampyr {

// State of one query. Embree passes the address of its first member to every callback.
struct TraceContext {
  RTCIntersectContext context;
  // Surfaces that let the ray pass, in the order in which they are visited: for Trace, thin surfaces and boundaries,
  // whether or not a nearer hit is found later; for Transmittance, also cut-outs. Null: not recorded.
  std::vector<Crossing>* crossings = nullptr;
  float nearest = kNearestHit;     // for Trace: surfaces nearer than this are ignored
  bool recordsBoundaries = false;  // false: `crossings` lacks the boundaries between media
  Color transmittance{1.0f};  // for Transmittance: product over the crossings so far; the query ends when it is black
  // Thrown by a custom surface, which counts as missed: no exception may pass through Embree. Rethrown by
  // ThrowFailure after the query.
  std::exception_ptr failure;

  void ThrowFailure() const {
    if (failure) [[unlikely]]
      std::rethrow_exception(failure);
  }
};

// An intersection of a ray with a surface that may let it pass.
struct Meeting {
  const PrimitiveRecord& record;
  uint32_t geometryId, patch, instanceId;  // Embree's
  uint32_t side = 0;                       // 0 and 1: the hits on one primitive, such as entering and leaving a sphere
};

// True if the ray continues behind `hit`. Intersect decides at random, in proportion to the transmittance;
// Transmittance (`isShadow`) continues until the product is black.
bool PassesThrough(const Meeting& at, const RTCRay& ray, const RayHit& hit, TraceContext& trace, bool isShadow);

// Shortens the ray to the nearest hit that stops it, on a quadric, patch or custom surface, and records that hit.
void IntersectOwn(const Meeting& at, RTCRayHit& rayHit, TraceContext& trace);
// True if such a surface stops the ray.
bool OccludesOwn(const Meeting& at, const RTCRay& ray, TraceContext& trace);

// Bounds of a quadric, patch or custom surface in its space. `begin`, `end`: shutter times, for a custom surface.
Bounds3 OwnBounds(const PrimitiveRecord& record, uint32_t patch, float begin = 0, float end = 1);

}  // namespace lampyr
