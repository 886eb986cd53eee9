// See embree_callbacks.h.
#include "geometry/embree_callbacks.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "geometry/bilinear.h"
#include "geometry/scene_tables.h"

namespace lampyr {

namespace {

const PrimitiveRecord& Record(const void* userPointer) {
  return *static_cast<const PrimitiveRecord*>(userPointer);
}

RayDouble ToDouble(const RTCRay& ray) {
  return {Point3d(Point3(ray.org_x, ray.org_y, ray.org_z)), Vector3d(Vector3(ray.dir_x, ray.dir_y, ray.dir_z)),
          static_cast<double>(ray.tnear), static_cast<double>(ray.tfar)};
}

// A number in [0,1) that is a function of the ray and the hit alone: a ray sees the same cut-out in any order of
// traversal and on every thread. `side` tells the hits on one primitive apart, which are decided independently.
float HashToUnit(const RTCRay& ray, uint32_t instance, uint32_t geometry, uint32_t patch, uint32_t side) {
  uint64_t hash = 0x9e3779b97f4a7c15u;
  const auto mix = [&hash](uint32_t value) {
    hash = (hash ^ value) * 0xbf58476d1ce4e5b9u;
    hash ^= hash >> 29;
  };
  for (const float x : {ray.org_x, ray.org_y, ray.org_z, ray.dir_x, ray.dir_y, ray.dir_z}) {
    mix(std::bit_cast<uint32_t>(x));
  }
  mix(instance);
  mix(geometry);
  mix(patch);
  mix(side);
  hash = (hash ^ (hash >> 31)) * 0x94d049bb133111ebu;
  return static_cast<float>(hash >> 40) * 0x1p-24f;
}

TraceContext& Trace(RTCIntersectContext* context) {
  return *reinterpret_cast<TraceContext*>(context);
}

// An intersection of a ray with a surface that may let it pass.
struct Meeting {
  const PrimitiveRecord& record;
  uint32_t geometryId, patch, instanceId;
  uint32_t side;  // 0 and 1: the hits on one primitive, such as entering and leaving a sphere
};

// The part of a ray that is stopped, and the factor on the rest.
struct Passage {
  float stopped = 1;
  Color tint{1.0f};
  bool entering = false;         // goes from the outside (the side of Ng) to the inside
  int32_t medium = kSameMedium;  // as in Crossing

  Color Transmittance() const { return tint * (1 - stopped); }
};

Passage PassageAt(const Meeting& at, const RTCRay& ray, const RayHit& hit) {
  const PrimitiveRecord& record = at.record;
  Vector3 direction(ray.dir_x, ray.dir_y, ray.dir_z);
  SurfacePoint point;
  EvaluatePrimitive(record, {{ray.org_x, ray.org_y, ray.org_z}, direction, kInfinity, ray.time}, hit, point);
  // To render space: positions of textures are there, and instances may be stretched.
  // Of a boundary without cut-outs only the side counts, which is the same in every space.
  if (at.instanceId != RTC_INVALID_GEOMETRY_ID && (record.alpha || record.thin)) {
    const InstanceRecord& instance = record.tables->instances[at.instanceId - record.tables->firstInstanceId];
    const InstancePlacement placement = instance.motion ? PlacementAt(*instance.motion, ray.time) : instance.placement;
    ApplyInstance(placement, point);
    direction = placement.toRender.Vector(direction);
  }
  const float alpha = record.alpha ? record.alpha->Alpha(point.uv, point.position, point.Ng) : 1.0f;
  // Embree's normal tells the sides of a curve apart; that of a flat curve's point faces the ray.
  const bool entering = record.As<CurveSet>() ? at.side == 0 : glm::dot(direction, point.Ng) < 0;
  // Through the hole of a cut-out a ray stays in its medium.
  const int32_t medium = alpha > 0 ? (entering ? record.insideMedium : record.outsideMedium) : kSameMedium;
  if (record.PassedAsBoundary(ray.mask)) return {0, Color(1.0f), entering, medium};
  if (!record.thin) return {alpha, Color(1.0f), entering};
  const float passes = record.thin->TransmittedFraction(std::abs(glm::dot(glm::normalize(direction), point.Ns)));
  Passage passage{alpha * (1 - passes), Color(1.0f), entering, medium};
  // Through the hole of the cut-out without a tint, through the surface with it.
  if (!record.thin->IsClear() && passage.stopped < 1) {
    const Color through = Color(1 - alpha) + record.thin->Tint(point.uv, point.position, point.Ng) * (alpha * passes);
    passage.tint = through / (1 - passage.stopped);
  }
  return passage;
}

// Embree reports a curve at several of its parts, at nearly the same place. It is crossed once on entering and once on
// leaving.
bool IsCrossedAlready(const Crossing& crossing, const std::vector<Crossing>& crossings) {
  return std::any_of(crossings.begin(), crossings.end(), [&](const Crossing& other) {
    return other.primitive == crossing.primitive && other.instance == crossing.instance &&
           other.patch == crossing.patch && other.entering == crossing.entering;
  });
}

// Records the crossing, unless it is known already.
void AddCrossing(const Meeting& at, const RayHit& hit, const Passage& passage, const Color& transmittance,
                 TraceContext& trace) {
  const SceneTables& tables = *at.record.tables;
  Crossing crossing{static_cast<double>(hit.t),
                    static_cast<uint32_t>(&at.record - tables.primitives.data()),
                    at.patch,
                    kNoIndex,
                    passage.entering,
                    transmittance,
                    passage.medium};
  if (at.instanceId != RTC_INVALID_GEOMETRY_ID) crossing.instance = at.instanceId - tables.firstInstanceId;
  if (at.record.As<CurveSet>() && IsCrossedAlready(crossing, *trace.crossings)) return;
  trace.crossings->push_back(crossing);
  trace.transmittance *= transmittance;
}

// A boundary between media alone. Where its opacity is 0 there is none.
void PassBoundary(const Meeting& at, const RTCRay& ray, const RayHit& hit, TraceContext& trace) {
  if (!trace.recordsBoundaries) return;
  const Passage passage = PassageAt(at, ray, hit);
  if (passage.medium != kSameMedium) AddCrossing(at, hit, passage, Color(1.0f), trace);
}

// True if the ray goes on. Of Intersect by chance, in proportion; of Transmittance as long as something is left.
bool PassesThrough(const Meeting& at, const RTCRay& ray, const RayHit& hit, TraceContext& trace, bool isShadow) {
  if (at.record.PassedAsBoundary(ray.mask)) {
    PassBoundary(at, ray, hit, trace);
    return true;
  }
  if (!at.record.alpha && !at.record.thin) return false;
  const Passage passage = PassageAt(at, ray, hit);
  if (passage.stopped >= 1) return false;
  if (isShadow) {
    AddCrossing(at, hit, passage, passage.Transmittance(), trace);
    return !trace.transmittance.IsBlack();
  }
  if (passage.stopped > 0 && HashToUnit(ray, at.instanceId, at.geometryId, at.patch, at.side) < passage.stopped)
    return false;
  if (trace.crossings && at.record.thin) AddCrossing(at, hit, passage, passage.tint, trace);
  return true;
}

struct Candidate {
  double t;
  float u, v;
};

// FirstStop of a surface that lets rays pass.
[[gnu::noinline]] int FirstThatStops(Meeting at, const RTCRay& ray, const Candidate* candidates, int count,
                                     TraceContext& trace, bool isShadow) {
  for (int i = 0; i < count; ++i) {
    const Candidate& c = candidates[i];
    const RayHit hit{static_cast<float>(c.t), at.geometryId, at.patch, at.instanceId, c.u, c.v};
    at.side = static_cast<uint32_t>(i);
    if (!PassesThrough(at, ray, hit, trace, isShadow)) return i;
  }
  return -1;
}

// Index of the nearest candidate that stops the ray, or -1.
inline int FirstStop(const Meeting& at, const RTCRay& ray, const Candidate* candidates, int count, TraceContext& trace,
                     bool isShadow) {
  if (!at.record.LetsPass()) [[likely]]
    return count > 0 ? 0 : -1;
  return FirstThatStops(at, ray, candidates, count, trace, isShadow);
}

int FindQuadric(const PrimitiveRecord& record, uint32_t, const RTCRay& ray, Candidate candidates[2]) {
  QuadricHit hits[2];
  const int most = record.LetsPass() ? 2 : 1;
  const int count = record.As<PreparedQuadric>()->Intersect(ToDouble(ray), hits, most);
  for (int i = 0; i < count; ++i) candidates[i] = {hits[i].t, hits[i].coordinates.x, hits[i].coordinates.y};
  return count;
}

int FindPatch(const PrimitiveRecord& record, uint32_t patch, const RTCRay& ray, Candidate candidates[2]) {
  PatchHit hits[2];
  const int count = IntersectPatch(*record.As<BilinearMesh>(), patch, ToDouble(ray), hits);
  for (int i = 0; i < count; ++i) candidates[i] = {hits[i].t, hits[i].uv.x, hits[i].uv.y};
  return count;
}

int FindCustom(const PrimitiveRecord& record, uint32_t, const RTCRay& ray, Candidate candidates[2]) {
  const auto t = record.As<CustomSurface>()->Intersect(ToDouble(ray), ray.time, nullptr);
  if (!t) return 0;
  candidates[0] = {*t, 0, 0};
  return 1;
}

using Finder = int (*)(const PrimitiveRecord&, uint32_t, const RTCRay&, Candidate*);

// Only custom surfaces may throw.
template <Finder kFind>
int Find(const PrimitiveRecord& record, uint32_t primitive, const RTCRay& ray, RTCIntersectContext* context,
         Candidate candidates[2]) {
  if constexpr (kFind == FindCustom) {
    try {
      return kFind(record, primitive, ray, candidates);
    } catch (...) {
      Trace(context).failure = std::current_exception();
      return 0;
    }
  } else {
    return kFind(record, primitive, ray, candidates);
  }
}

template <Finder kFind>
void IntersectUserGeometry(const RTCIntersectFunctionNArguments* arguments) {
  if (!arguments->valid[0]) return;
  const PrimitiveRecord& record = Record(arguments->geometryUserPtr);
  auto& rayHit = *reinterpret_cast<RTCRayHit*>(arguments->rayhit);
  const uint32_t instance = arguments->context->instID[0];
  Candidate candidates[2];
  const int count = Find<kFind>(record, arguments->primID, rayHit.ray, arguments->context, candidates);
  const Meeting at{record, arguments->geomID, arguments->primID, instance, 0};
  const int i = FirstStop(at, rayHit.ray, candidates, count, Trace(arguments->context), false);
  if (i < 0) return;
  rayHit.ray.tfar = static_cast<float>(candidates[i].t);
  rayHit.hit.u = candidates[i].u;
  rayHit.hit.v = candidates[i].v;
  rayHit.hit.primID = arguments->primID;
  rayHit.hit.geomID = arguments->geomID;
  rayHit.hit.instID[0] = instance;
}

template <Finder kFind>
void OccludeUserGeometry(const RTCOccludedFunctionNArguments* arguments) {
  if (!arguments->valid[0]) return;
  const PrimitiveRecord& record = Record(arguments->geometryUserPtr);
  auto& ray = *reinterpret_cast<RTCRay*>(arguments->ray);
  Candidate candidates[2];
  const int count = Find<kFind>(record, arguments->primID, ray, arguments->context, candidates);
  const Meeting at{record, arguments->geomID, arguments->primID, arguments->context->instID[0], 0};
  if (FirstStop(at, ray, candidates, count, Trace(arguments->context), true) >= 0) ray.tfar = -kInfinity;
}

void SetBounds(const Bounds3& bounds, RTCBounds* out) {
  out->lower_x = bounds.min.x;
  out->lower_y = bounds.min.y;
  out->lower_z = bounds.min.z;
  out->upper_x = bounds.max.x;
  out->upper_y = bounds.max.y;
  out->upper_z = bounds.max.z;
}

}  // namespace

void QuadricBounds(const RTCBoundsFunctionArguments* arguments) {
  const PreparedQuadric& quadric = *Record(arguments->geometryUserPtr).As<PreparedQuadric>();
  SetBounds(GetBounds(quadric.Shape()), arguments->bounds_o);
}

void PatchBounds(const RTCBoundsFunctionArguments* arguments) {
  const BilinearMesh& mesh = *Record(arguments->geometryUserPtr).As<BilinearMesh>();
  Bounds3 bounds;
  for (const uint32_t i : mesh.patches[arguments->primID]) bounds.Add(mesh.positions[i]);
  SetBounds(bounds, arguments->bounds_o);
}

// Embree interpolates the bounds linearly between two time steps. The bounds of a step therefore hold the surface from
// the step before to the step after.
void CustomBounds(const RTCBoundsFunctionArguments* arguments) {
  const CustomSurface& surface = *Record(arguments->geometryUserPtr).As<CustomSurface>();
  float begin = 0, end = 1;
  if (surface.Moves()) {
    constexpr float segments = kCustomTimeSteps - 1;
    begin = std::max(static_cast<float>(arguments->timeStep) - 1, 0.0f) / segments;
    end = std::min(static_cast<float>(arguments->timeStep) + 1, segments) / segments;
  }
  SetBounds(surface.GetBounds(begin, end), arguments->bounds_o);
}

void CustomIntersect(const RTCIntersectFunctionNArguments* arguments) {
  IntersectUserGeometry<FindCustom>(arguments);
}
void CustomOccluded(const RTCOccludedFunctionNArguments* arguments) {
  OccludeUserGeometry<FindCustom>(arguments);
}
void QuadricIntersect(const RTCIntersectFunctionNArguments* arguments) {
  IntersectUserGeometry<FindQuadric>(arguments);
}
void QuadricOccluded(const RTCOccludedFunctionNArguments* arguments) {
  OccludeUserGeometry<FindQuadric>(arguments);
}
void PatchIntersect(const RTCIntersectFunctionNArguments* arguments) {
  IntersectUserGeometry<FindPatch>(arguments);
}
void PatchOccluded(const RTCOccludedFunctionNArguments* arguments) {
  OccludeUserGeometry<FindPatch>(arguments);
}

namespace {

void Filter(const RTCFilterFunctionNArguments* arguments, bool isShadow) {
  if (!arguments->valid[0]) return;
  const auto& ray = *reinterpret_cast<const RTCRay*>(arguments->ray);
  const auto& hit = *reinterpret_cast<const RTCHit*>(arguments->hit);
  const RayHit rayHit{ray.tfar, hit.geomID, hit.primID, hit.instID[0], hit.u, hit.v};
  // A round curve is entered and left: the normal tells which.
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
