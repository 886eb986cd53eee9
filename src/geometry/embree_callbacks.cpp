// See embree_callbacks.h.
#include "geometry/embree_callbacks.h"

#include <bit>

#include "geometry/bilinear.h"
#include "geometry/scene_tables.h"

namespace lampyr {

namespace {

const PrimitiveRecord& Record(const void* userPointer) { return *static_cast<const PrimitiveRecord*>(userPointer); }

RayDouble ToDouble(const RTCRay& ray) {
  return {Point3d(Point3(ray.org_x, ray.org_y, ray.org_z)), Vector3d(Vector3(ray.dir_x, ray.dir_y, ray.dir_z)),
          static_cast<double>(ray.tnear), static_cast<double>(ray.tfar)};
}

// A number in [0,1) that is a function of the ray and the hit alone, so that a ray sees the same cut-out whichever way the
// tree is walked, and on every thread. `crossing` tells a primitive's hits apart: each is another chance to be stopped.
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

// Whether the cut-out lets the ray through at this hit.
bool PassesThrough(const PrimitiveRecord& record, const RTCRay& ray, const RayHit& hit, uint32_t geometryId,
                   uint32_t crossing) {
  const Ray inObject{{ray.org_x, ray.org_y, ray.org_z}, {ray.dir_x, ray.dir_y, ray.dir_z}, kInfinity, ray.time};
  const SurfacePoint point = EvaluatePrimitive(record, inObject, hit);
  Point3 position = point.position;
  if (hit.instance != RTC_INVALID_GEOMETRY_ID) {
    const InstanceRecord& instance = record.tables->instances[hit.instance - record.tables->firstInstanceId];
    const Affine& still = instance.placement.toRender;
    position = instance.motion ? instance.motion->At(ray.time).Point(position) : still.Point(position);
  }
  const float alpha = record.alpha->Alpha(point.uv, position);
  if (alpha >= 1) return false;
  if (!(alpha > 0)) return true;
  return HashToUnit(ray, hit.instance, geometryId, hit.patch, crossing) >= alpha;
}

struct Candidate {
  double t;
  float u, v;
};

// The nearest of the candidates that the cut-out does not let through, or -1.
int FirstOpaque(const PrimitiveRecord& record, const RTCRay& ray, const Candidate* candidates, int count,
                uint32_t patch, uint32_t instance, uint32_t geometryId) {
  for (int i = 0; i < count; ++i) {
    if (!record.alpha) return i;
    const Candidate& c = candidates[i];
    const RayHit hit{static_cast<float>(c.t), geometryId, patch, instance, c.u, c.v};
    if (!PassesThrough(record, ray, hit, geometryId, static_cast<uint32_t>(i))) return i;
  }
  return -1;
}

int FindQuadric(const PrimitiveRecord& record, uint32_t, const RTCRay& ray, Candidate candidates[2]) {
  QuadricHit hits[2];
  const int count = (*std::get_if<2>(&record.shape))->Intersect(ToDouble(ray), hits);
  for (int i = 0; i < count; ++i) candidates[i] = {hits[i].t, hits[i].coordinates.x, hits[i].coordinates.y};
  return count;
}

int FindPatch(const PrimitiveRecord& record, uint32_t patch, const RTCRay& ray, Candidate candidates[2]) {
  PatchHit hits[2];
  const int count = IntersectPatch(**std::get_if<1>(&record.shape), patch, ToDouble(ray), hits);
  for (int i = 0; i < count; ++i) candidates[i] = {hits[i].t, hits[i].uv.x, hits[i].uv.y};
  return count;
}

int FindCustom(const PrimitiveRecord& record, uint32_t, const RTCRay& ray, Candidate candidates[2]) {
  const auto t = (*std::get_if<4>(&record.shape))->Intersect(ToDouble(ray), ray.time, nullptr);
  if (!t) return 0;
  candidates[0] = {*t, 0, 0};
  return 1;
}

using Finder = int (*)(const PrimitiveRecord&, uint32_t, const RTCRay&, Candidate*);

template <Finder kFind>
void IntersectUserGeometry(const RTCIntersectFunctionNArguments* arguments) {
  if (!arguments->valid[0]) return;
  const PrimitiveRecord& record = Record(arguments->geometryUserPtr);
  auto& rayHit = *reinterpret_cast<RTCRayHit*>(arguments->rayhit);
  const uint32_t instance = arguments->context->instID[0];
  Candidate candidates[2];
  const int count = kFind(record, arguments->primID, rayHit.ray, candidates);
  const int i = FirstOpaque(record, rayHit.ray, candidates, count, arguments->primID, instance, arguments->geomID);
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
  const int count = kFind(record, arguments->primID, ray, candidates);
  const uint32_t instance = arguments->context->instID[0];
  if (FirstOpaque(record, ray, candidates, count, arguments->primID, instance, arguments->geomID) >= 0) {
    ray.tfar = -kInfinity;
  }
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
  const PreparedQuadric& quadric = **std::get_if<2>(&Record(arguments->geometryUserPtr).shape);
  SetBounds(GetBounds(quadric.Shape()), arguments->bounds_o);
}

void PatchBounds(const RTCBoundsFunctionArguments* arguments) {
  const BilinearMesh& mesh = **std::get_if<1>(&Record(arguments->geometryUserPtr).shape);
  Bounds3 bounds;
  for (const uint32_t i : mesh.patches[arguments->primID]) bounds.Add(mesh.positions[i]);
  SetBounds(bounds, arguments->bounds_o);
}

// Embree takes the surface to be within boxes that change evenly from one time step to the next: each holds it from the
// step before to the step after.
void CustomBounds(const RTCBoundsFunctionArguments* arguments) {
  const CustomSurface& surface = **std::get_if<4>(&Record(arguments->geometryUserPtr).shape);
  float begin = 0, end = 1;
  if (surface.Moves()) {
    constexpr float segments = kCustomTimeSteps - 1;
    begin = std::max(static_cast<float>(arguments->timeStep) - 1, 0.0f) / segments;
    end = std::min(static_cast<float>(arguments->timeStep) + 1, segments) / segments;
  }
  SetBounds(surface.GetBounds(begin, end), arguments->bounds_o);
}

void CustomIntersect(const RTCIntersectFunctionNArguments* arguments) { IntersectUserGeometry<FindCustom>(arguments); }
void CustomOccluded(const RTCOccludedFunctionNArguments* arguments) { OccludeUserGeometry<FindCustom>(arguments); }
void QuadricIntersect(const RTCIntersectFunctionNArguments* arguments) { IntersectUserGeometry<FindQuadric>(arguments); }
void QuadricOccluded(const RTCOccludedFunctionNArguments* arguments) { OccludeUserGeometry<FindQuadric>(arguments); }
void PatchIntersect(const RTCIntersectFunctionNArguments* arguments) { IntersectUserGeometry<FindPatch>(arguments); }
void PatchOccluded(const RTCOccludedFunctionNArguments* arguments) { OccludeUserGeometry<FindPatch>(arguments); }

void AlphaFilter(const RTCFilterFunctionNArguments* arguments) {
  if (!arguments->valid[0]) return;
  const auto& ray = *reinterpret_cast<const RTCRay*>(arguments->ray);
  const auto& hit = *reinterpret_cast<const RTCHit*>(arguments->hit);
  const RayHit rayHit{ray.tfar, hit.geomID, hit.primID, hit.instID[0], hit.u, hit.v};
  // A round curve is entered and left: the normal tells which.
  const bool leaves = hit.Ng_x * ray.dir_x + hit.Ng_y * ray.dir_y + hit.Ng_z * ray.dir_z > 0;
  if (PassesThrough(Record(arguments->geometryUserPtr), ray, rayHit, hit.geomID, leaves ? 1 : 0)) {
    arguments->valid[0] = 0;
  }
}

}  // namespace lampyr
