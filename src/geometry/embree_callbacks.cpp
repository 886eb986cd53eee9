// See embree_callbacks.h.
#include "geometry/embree_callbacks.h"

#include <algorithm>
#include <array>
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

// A number in [0,1) that is a function of the ray and the hit alone, so that a ray sees the same cut-out whichever way
// the tree is walked, and on every thread. `crossing` tells a primitive's hits apart: each is another chance to be
// stopped.
float HashToUnit(const RTCRay& ray, uint32_t instance, uint32_t geometry, uint32_t patch, uint32_t crossing) {
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
  mix(crossing);
  hash = (hash ^ (hash >> 31)) * 0x94d049bb133111ebu;
  return static_cast<float>(hash >> 40) * 0x1p-24f;
}

TraceContext& Trace(RTCIntersectContext* context) {
  return *reinterpret_cast<TraceContext*>(context);
}

// Of the ray to the shading normal, in render space: instances may be stretched.
float CosineAt(const PrimitiveRecord& record, const RTCRay& ray, const RayHit& hit, SurfacePoint point) {
  Vector3 direction(ray.dir_x, ray.dir_y, ray.dir_z);
  if (hit.instance != RTC_INVALID_GEOMETRY_ID) {
    const InstanceRecord& instance = record.tables->instances[hit.instance - record.tables->firstInstanceId];
    const InstancePlacement placement = instance.motion ? PlacementAt(*instance.motion, ray.time) : instance.placement;
    ApplyInstance(placement, point);
    direction = placement.toRender.Vector(direction);
  }
  return std::abs(glm::dot(glm::normalize(direction), point.Ns));
}

// What a hit lets through: the chance to be stopped, and what the rest is multiplied by.
struct Passage {
  float stopped = 1;
  Color tint{1.0f};

  Color Transmission() const { return tint * (1 - stopped); }
};

Passage PassageAt(const PrimitiveRecord& record, const RTCRay& ray, const RayHit& hit) {
  const Ray inObject{{ray.org_x, ray.org_y, ray.org_z}, {ray.dir_x, ray.dir_y, ray.dir_z}, kInfinity, ray.time};
  const SurfacePoint point = EvaluatePrimitive(record, inObject, hit);
  Point3 position = point.position;
  if (hit.instance != RTC_INVALID_GEOMETRY_ID) {
    const InstanceRecord& instance = record.tables->instances[hit.instance - record.tables->firstInstanceId];
    const Affine& still = instance.placement.toRender;
    position = instance.motion ? instance.motion->At(ray.time).Point(position) : still.Point(position);
  }
  const float alpha = record.alpha ? record.alpha->Alpha(point.uv, position) : 1.0f;
  if (!record.sheet) return {alpha, Color(1.0f)};
  const float passes = record.sheet->PassingPart(CosineAt(record, ray, hit, point));
  Passage passage{alpha * (1 - passes), Color(1.0f)};
  // Through the hole of the cut-out without a tint, through the sheet with it.
  if (!record.sheet->IsClear() && passage.stopped < 1) {
    const Color through = Color(1 - alpha) + record.sheet->Tint(point.uv, position) * (alpha * passes);
    passage.tint = through / (1 - passage.stopped);
  }
  return passage;
}

// Embree reports a curve at several of its parts, at nearly the same place: what passes is counted once for entering
// it, and once for leaving it.
bool IsCounted(const PrimitiveRecord& record, const RayHit& hit, uint32_t geometryId, uint32_t crossing,
               TraceContext& trace) {
  if (!record.As<CurveSet>()) return false;
  using Crossing = std::array<uint32_t, 4>;
  thread_local std::vector<Crossing> crossings;
  if (!trace.hasCrossedCurves) crossings.clear();
  trace.hasCrossedCurves = true;
  const Crossing here{hit.instance, geometryId, hit.patch, crossing};
  if (std::find(crossings.begin(), crossings.end(), here) != crossings.end()) return true;
  crossings.push_back(here);
  return false;
}

// Whether the ray goes on; a shadow ray does as long as something is left of it.
bool PassesThrough(const PrimitiveRecord& record, const RTCRay& ray, const RayHit& hit, uint32_t geometryId,
                   uint32_t crossing, TraceContext& trace, bool isShadow) {
  const Passage passage = PassageAt(record, ray, hit);
  if (passage.stopped >= 1) return false;
  if (isShadow) {
    if (!IsCounted(record, hit, geometryId, crossing, trace)) trace.transmission *= passage.Transmission();
    return !trace.transmission.IsBlack();
  }
  if (passage.stopped > 0 && HashToUnit(ray, hit.instance, geometryId, hit.patch, crossing) < passage.stopped)
    return false;
  if (trace.sheets && record.sheet && !IsCounted(record, hit, geometryId, crossing, trace))
    trace.sheets->push_back({hit.t, passage.tint});
  return true;
}

struct Candidate {
  double t;
  float u, v;
};

// Where user geometry is met.
struct Meeting {
  const PrimitiveRecord& record;
  uint32_t patch, instance, geometryId;
  TraceContext& trace;
  bool isShadow;
};

// The nearest of the candidates that lets nothing through, or -1.
int FirstOpaque(const Meeting& at, const RTCRay& ray, const Candidate* candidates, int count) {
  for (int i = 0; i < count; ++i) {
    if (!at.record.LetsPass()) return i;
    const Candidate& c = candidates[i];
    const RayHit hit{static_cast<float>(c.t), at.geometryId, at.patch, at.instance, c.u, c.v};
    if (!PassesThrough(at.record, ray, hit, at.geometryId, static_cast<uint32_t>(i), at.trace, at.isShadow)) return i;
  }
  return -1;
}

int FindQuadric(const PrimitiveRecord& record, uint32_t, const RTCRay& ray, Candidate candidates[2]) {
  QuadricHit hits[2];
  const int count = record.As<PreparedQuadric>()->Intersect(ToDouble(ray), hits);
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

// Quadrics and patches throw nothing.
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
  const Meeting at{record, arguments->primID, instance, arguments->geomID, Trace(arguments->context), false};
  const int i = FirstOpaque(at, rayHit.ray, candidates, count);
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
  const Meeting at{
      record, arguments->primID, arguments->context->instID[0], arguments->geomID, Trace(arguments->context), true};
  if (FirstOpaque(at, ray, candidates, count) >= 0) ray.tfar = -kInfinity;
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

// Embree takes the surface to be within boxes that change evenly from one time step to the next: each holds it from the
// step before to the step after.
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
  if (PassesThrough(Record(arguments->geometryUserPtr), ray, rayHit, hit.geomID, leaves ? 1 : 0,
                    Trace(arguments->context), isShadow)) {
    arguments->valid[0] = 0;
  }
}

}  // namespace

void PassFilter(const RTCFilterFunctionNArguments* arguments) {
  Filter(arguments, false);
}
void TransmitFilter(const RTCFilterFunctionNArguments* arguments) {
  Filter(arguments, true);
}

}  // namespace lampyr
