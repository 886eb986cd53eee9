// See meeting.h.
#include "geometry/meeting.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "geometry/bilinear.h"

namespace lampyr {

namespace {

RayDouble ToDouble(const RTCRay& ray) {
  return {Point3d(Point3(ray.org_x, ray.org_y, ray.org_z)), Vector3d(Vector3(ray.dir_x, ray.dir_y, ray.dir_z)),
          static_cast<double>(ray.tnear), static_cast<double>(ray.tfar)};
}

// A number in [0,1) that is a function of the ray and the hit alone: a ray gets the same decision at a cut-out in any
// order of traversal and on every thread. `side` distinguishes the hits on one primitive, which are decided
// independently.
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
  // For a boundary without cut-outs only the side matters, which is the same in every space.
  if (at.instanceId != RTC_INVALID_GEOMETRY_ID && (record.alpha || record.thin)) {
    const InstanceRecord& instance = record.tables->instances[at.instanceId - record.tables->firstInstanceId];
    const InstancePlacement placement = instance.motion ? PlacementAt(*instance.motion, ray.time) : instance.placement;
    ApplyInstance(placement, point);
    direction = placement.toRender.Vector(direction);
  }
  const float alpha = record.alpha ? record.alpha->Alpha(point.uv, point.position, point.Ng) : 1.0f;
  // Embree's normal distinguishes the sides of a curve; the normal of a flat curve's point always faces the ray.
  const bool entering = record.As<CurveSet>() ? at.side == 0 : glm::dot(direction, point.Ng) < 0;
  // A ray stays in its medium where it passes the hole of a cut-out.
  const int32_t medium = alpha > 0 ? (entering ? record.insideMedium : record.outsideMedium) : kSameMedium;
  if (record.PassedAsBoundary(ray.mask)) return {0, Color(1.0f), entering, medium};
  if (!record.thin) return {alpha, Color(1.0f), entering};
  const float passes =
      record.thin->TransmittedFraction(std::abs(glm::dot(glm::normalize(direction), record.thin->NormalAt(point))));
  Passage passage{alpha * (1 - passes), Color(1.0f), entering, medium};
  // Rays through the hole of the cut-out are not tinted, those through the surface are.
  if (!record.thin->IsClear() && passage.stopped < 1) {
    const Color through = Color(1 - alpha) + record.thin->Tint(point.uv, point.position, point.Ng) * (alpha * passes);
    passage.tint = through / (1 - passage.stopped);
  }
  return passage;
}

// Embree reports a curve at several of its parts, at nearly the same place. Only one crossing each is kept on entering
// and on leaving.
bool IsCrossedAlready(const Crossing& crossing, const std::vector<Crossing>& crossings) {
  return std::any_of(crossings.begin(), crossings.end(), [&](const Crossing& other) {
    return other.primitive == crossing.primitive && other.instance == crossing.instance &&
           other.patch == crossing.patch && other.entering == crossing.entering;
  });
}

// Records the crossing, unless it is recorded already.
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

// A boundary between media alone. Holes, where its opacity is 0, are no boundary.
void PassBoundary(const Meeting& at, const RTCRay& ray, const RayHit& hit, TraceContext& trace) {
  if (!trace.recordsBoundaries) return;
  const Passage passage = PassageAt(at, ray, hit);
  if (passage.medium != kSameMedium) AddCrossing(at, hit, passage, Color(1.0f), trace);
}

}  // namespace

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

namespace {

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

int FindQuadric(const PrimitiveRecord& record, const RTCRay& ray, Candidate candidates[2]) {
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

// An exception of a custom surface is kept in `trace` and thrown when the query has ended.
int FindCustom(const PrimitiveRecord& record, const RTCRay& ray, TraceContext& trace, Candidate candidates[2]) {
  try {
    const auto t = record.As<CustomSurface>()->Intersect(ToDouble(ray), ray.time, nullptr);
    if (!t) return 0;
    candidates[0] = {*t, 0, 0};
    return 1;
  } catch (...) {
    trace.failure = std::current_exception();
    return 0;
  }
}

// The hits with t in (tnear, tfar] of the ray, nearest first; returns how many.
inline int Find(const Meeting& at, const RTCRay& ray, TraceContext& trace, Candidate candidates[2]) {
  if (at.record.As<PreparedQuadric>()) return FindQuadric(at.record, ray, candidates);
  if (at.record.As<BilinearMesh>()) return FindPatch(at.record, at.patch, ray, candidates);
  return FindCustom(at.record, ray, trace, candidates);
}

}  // namespace

void IntersectOwn(const Meeting& at, RTCRayHit& rayHit, TraceContext& trace) {
  Candidate candidates[2];
  const int count = Find(at, rayHit.ray, trace, candidates);
  const int i = FirstStop(at, rayHit.ray, candidates, count, trace, false);
  if (i < 0) return;
  rayHit.ray.tfar = static_cast<float>(candidates[i].t);
  rayHit.hit.u = candidates[i].u;
  rayHit.hit.v = candidates[i].v;
  rayHit.hit.primID = at.patch;
  rayHit.hit.geomID = at.geometryId;
  rayHit.hit.instID[0] = at.instanceId;
}

bool OccludesOwn(const Meeting& at, const RTCRay& ray, TraceContext& trace) {
  Candidate candidates[2];
  const int count = Find(at, ray, trace, candidates);
  return FirstStop(at, ray, candidates, count, trace, true) >= 0;
}

Bounds3 OwnBounds(const PrimitiveRecord& record, uint32_t patch, float begin, float end) {
  if (const auto* quadric = record.As<PreparedQuadric>()) return GetBounds(quadric->Shape());
  if (const auto* surface = record.As<CustomSurface>()) return surface->GetBounds(begin, end);
  const BilinearMesh& mesh = *record.As<BilinearMesh>();
  Bounds3 bounds;
  for (const uint32_t i : mesh.patches[patch]) bounds.Add(mesh.positions[i]);
  return bounds;
}

}  // namespace lampyr
