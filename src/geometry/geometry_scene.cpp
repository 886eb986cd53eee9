// See geometry_scene.h. The gate in front of every Embree call, and looking up hits.
#include "geometry/geometry_scene.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "geometry/geometry_implementation.h"
#include "geometry/meeting.h"
#include "geometry/rounding.h"

#if defined(__AVX__)
#include <immintrin.h>
#endif

namespace lampyr {

namespace {

// The functions through which Embree is entered are compiled for SSE. They stall while the upper halves of vector
// registers are in use: up to a fifth of the time of a render.
inline void ClearUpperHalves() {
#if defined(__AVX__)
  _mm256_zeroupper();
#endif
}

}  // namespace

GeometryScene::GeometryScene(GeometryDescription description)
    : implementation_(std::make_unique<Implementation>(std::move(description))) {}

GeometryScene::~GeometryScene() = default;

namespace {

void FillRay(const Ray& ray, uint32_t kinds, float tMax, RTCRay& out) {
  out.org_x = ray.origin.x;
  out.org_y = ray.origin.y;
  out.org_z = ray.origin.z;
  out.tnear = kNearestHit;
  out.dir_x = ray.direction.x;
  out.dir_y = ray.direction.y;
  out.dir_z = ray.direction.z;
  out.time = ray.time;
  out.tfar = tMax;
  out.mask = kinds;
  out.id = 0;
  out.flags = 0;
}

// The thread's list, emptied; valid until the thread's next call.
std::vector<Crossing>& ThreadCrossings() {
  thread_local std::vector<Crossing> crossings;
  crossings.clear();
  return crossings;
}

}  // namespace

// Puts crossings in order.
void GeometryScene::Implementation::OrderCrossings(double largest, std::vector<Crossing>& crossings,
                                                   bool withBoundaries) const {
  SortByDistance(crossings);
  if (withBoundaries) OrderCoincident(tables, largest, crossings);
}

// The nearest hit of an accepted ray. `trace` collects the crossings that Embree visits, in no order and also behind
// the hit.
inline bool GeometryScene::Implementation::Query(const Ray& ray, uint32_t kinds, RayHit& hit,
                                                 TraceContext& trace) const {
  rtcInitIntersectContext(&trace.context);
  RTCRayHit rayHit;
  FillRay(ray, kinds, ray.tMax, rayHit.ray);
  rayHit.ray.tnear = trace.nearest;
  rayHit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rayHit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  if (few) {
    few->Intersect(rayHit, trace);
  } else {
    ClearUpperHalves();
    rtcIntersect1(scene.get(), &trace.context, &rayHit);
  }
  trace.ThrowFailure();
  if (rayHit.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
  hit.t = rayHit.ray.tfar;
  hit.patch = rayHit.hit.primID;
  hit.u = rayHit.hit.u;
  hit.v = rayHit.hit.v;
  if (rayHit.hit.instID[0] == RTC_INVALID_GEOMETRY_ID) {
    hit.primitive = rayHit.hit.geomID;
    hit.instance = kNoIndex;
  } else {
    hit.instance = rayHit.hit.instID[0] - tables.firstInstanceId;
    hit.primitive = tables.instances[hit.instance].firstPrimitive + rayHit.hit.geomID;
  }
  return true;
}

// The ray is accepted. The crossings of `trace`, if recorded, are empty before the call, and afterwards those in front
// of the hit.
inline bool GeometryScene::Implementation::Trace(const Ray& ray, uint32_t kinds, RayHit& hit,
                                                 TraceContext& trace) const {
  const bool isHit = Query(ray, kinds, hit, trace);
  if (trace.crossings && !trace.crossings->empty()) [[unlikely]] {
    const double end = static_cast<double>(isHit ? hit.t : ray.tMax);
    std::erase_if(*trace.crossings, [&](const Crossing& crossing) { return !(crossing.t < end); });
    OrderCrossings(static_cast<double>(MaxAbsComponent(ray.origin)), *trace.crossings, trace.recordsBoundaries);
  }
  return isHit;
}

namespace {

// Distance, in units of the coordinates, by which a ray starts ahead of a line that is fine at its start. Boundaries
// within rounding of the start are then hit, and whether they are on the line is decided in double. A larger distance
// allows rays at more grazing angles.
constexpr double kAhead = 0x1p-16;
// Distances that differ by less are equal; in the same units.
constexpr double kSamePlace = 1e-14;

double Largest(const Vector3d& v) {
  return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

// The ray extended by `by` at its start.
Ray FromAhead(const Ray& ray, const FineLine& line, double by) {
  Ray moved = ray;
  moved.origin = Point3(line.start - by * line.direction);
  moved.tMax += static_cast<float>(by);
  return moved;
}

}  // namespace

// `ray` starts `ahead` in front of the line.
LineHit GeometryScene::Implementation::Trace(const Ray& ray, double ahead, const FineLine& line, uint32_t kinds,
                                             RayHit& hit, TraceContext& trace) const {
  LineHit found;
  constexpr int kMostBehind = 16;  // surfaces
  for (int behind = 0; behind < kMostBehind; ++behind) {
    trace.crossings->clear();
    found.isHit = Query(ray, kinds, hit, trace);
    if (!found.isHit) break;
    found.t = FineDistance(tables, line, ray.time, hit, static_cast<double>(hit.t) - ahead);
    if (!line.isFineAtStart || found.t > 0) break;
    trace.nearest = std::nextafter(hit.t, kInfinity);
    found.isHit = false;
  }
  found.t = found.isHit ? std::max(found.t, 0.0) : std::numeric_limits<double>::infinity();
  if (found.isHit) hit.t = static_cast<float>(found.t);
  if (trace.crossings->empty()) return found;
  RefineCrossings(tables, line, ray.time, ahead, *trace.crossings);
  // A boundary in the place of the surface that is hit counts as behind it, as for hits at equal float distances.
  const double end = found.isHit ? found.t - kSamePlace * (found.t + Largest(line.start)) : found.t;
  std::erase_if(*trace.crossings, [&](const Crossing& crossing) { return !(crossing.t < end); });
  OrderCrossings(Largest(line.start), *trace.crossings, trace.recordsBoundaries);
  return found;
}

LineHit GeometryScene::Trace(const Ray& ray, const FineLine& line, uint32_t kinds, RayHit& hit,
                             std::vector<Crossing>& crossings) const {
  const Implementation& scene = *implementation_;
  crossings.clear();
  LineHit rejected;
  rejected.isRejected = true;
  if (!scene.Accept(ray)) return rejected;
  TraceContext trace;
  trace.crossings = &crossings;
  trace.recordsBoundaries = scene.hasBoundaries;
  if (!line.isFineAtStart) return scene.Trace(ray, 0, line, kinds, hit, trace);
  const double ahead = kAhead * Largest(line.start);
  return scene.Trace(FromAhead(ray, line, ahead), ahead, line, kinds, hit, trace);
}

bool GeometryScene::Trace(const Ray& ray, uint32_t kinds, RayHit& hit, std::vector<Crossing>& crossings) const {
  const Implementation& scene = *implementation_;
  crossings.clear();
  if (!scene.Accept(ray)) return false;
  TraceContext trace;
  if (scene.hasTints || scene.hasBoundaries) trace.crossings = &crossings;
  trace.recordsBoundaries = scene.hasBoundaries;
  return scene.Trace(ray, kinds, hit, trace);
}

bool GeometryScene::Intersect(const Ray& ray, uint32_t kinds, RayHit& hit, Color& tint) const {
  const Implementation& scene = *implementation_;
  if (!scene.Accept(ray)) {
    tint = Color(0.0f);
    return false;
  }
  tint = Color(1.0f);
  TraceContext trace;
  if (scene.hasTints) [[unlikely]]
    trace.crossings = &ThreadCrossings();
  const bool isHit = scene.Trace(ray, kinds, hit, trace);
  if (trace.crossings) [[unlikely]]
    tint = lampyr::Transmittance(*trace.crossings);
  return isHit;
}

bool GeometryScene::Intersect(const Ray& ray, uint32_t kinds, RayHit& hit, Color& tint,
                              std::vector<Crossing>& crossings) const {
  crossings.clear();
  if (!implementation_->Accept(ray)) {
    tint = Color(0.0f);
    return false;
  }
  const bool isHit = Trace(ray, kinds, hit, crossings);
  tint = lampyr::Transmittance(crossings);
  return isHit;
}

// False: something stops the ray, which is accepted.
inline bool GeometryScene::Implementation::Passes(const Ray& ray, uint32_t kinds, TraceContext& trace) const {
  rtcInitIntersectContext(&trace.context);
  RTCRay shadowRay;
  // Embree's interval is closed above; ours is open.
  FillRay(ray, kinds, ray.tMax * kOneMinusEpsilon, shadowRay);
  if (few) {
    few->Occlude(shadowRay, trace);
  } else {
    ClearUpperHalves();
    rtcOccluded1(scene.get(), &trace.context, &shadowRay);
  }
  trace.ThrowFailure();
  return !(shadowRay.tfar < 0);
}

// The ray is accepted. The crossings of `trace` are empty before the call; afterwards they are in order, unless the
// result is 0. If they are null, no surface lets rays pass.
inline Color GeometryScene::Implementation::Transmittance(const Ray& ray, uint32_t kinds, TraceContext& trace) const {
  if (!Passes(ray, kinds, trace)) return Color(0.0f);
  if (!trace.crossings || trace.crossings->empty()) [[likely]]
    return Color(1.0f);
  OrderCrossings(static_cast<double>(MaxAbsComponent(ray.origin)), *trace.crossings, trace.recordsBoundaries);
  return lampyr::Transmittance(*trace.crossings);
}

// The ray is extended at the ends that are fine, so that it hits the boundaries there. A surface that stops it may thus
// be beyond an end: in that case its nearest hit decides.
Color GeometryScene::Implementation::Transmittance(const Ray& ray, const FineLine& line, uint32_t kinds,
                                                   TraceContext& trace) const {
  Ray longer = ray;
  double ahead = 0;
  if (line.isFineAtStart) {
    ahead = kAhead * Largest(line.start);
    longer = FromAhead(ray, line, ahead);
  }
  if (line.isFineAtEnd) {
    const double beyond = kAhead * Largest(line.start + line.length * line.direction);
    longer.tMax = static_cast<float>(line.length + ahead + beyond);
  }
  if (!Passes(longer, kinds, trace)) {
    if (!line.isFineAtStart && !line.isFineAtEnd) return Color(0.0f);
    RayHit hit;
    const LineHit found = Trace(longer, ahead, line, kinds, hit, trace);
    return found.isHit && found.t < line.length ? Color(0.0f) : lampyr::Transmittance(*trace.crossings);
  }
  if (trace.crossings->empty()) return Color(1.0f);
  RefineCrossings(tables, line, ray.time, ahead, *trace.crossings);
  OrderCrossings(Largest(line.start), *trace.crossings, trace.recordsBoundaries);
  return lampyr::Transmittance(*trace.crossings);
}

// Cut-outs are factors of the transmittance alone.
void GeometryScene::Implementation::DropCutOuts(std::vector<Crossing>& crossings) const {
  std::erase_if(crossings, [&](const Crossing& crossing) {
    return crossing.medium == kSameMedium && !tables.primitives[crossing.primitive].thin;
  });
}

Color GeometryScene::Transmittance(const Ray& ray, uint32_t kinds) const {
  const Implementation& scene = *implementation_;
  if (!scene.Accept(ray)) return Color(0.0f);
  TraceContext trace;
  if (scene.letsPass) trace.crossings = &ThreadCrossings();
  return scene.Transmittance(ray, kinds, trace);
}

Color GeometryScene::Transmittance(const Ray& ray, uint32_t kinds, std::vector<Crossing>& crossings) const {
  const Implementation& scene = *implementation_;
  crossings.clear();
  if (!scene.Accept(ray)) return Color(0.0f);
  TraceContext trace;
  trace.crossings = &crossings;
  trace.recordsBoundaries = scene.hasBoundaries;
  const Color transmittance = scene.Transmittance(ray, kinds, trace);
  if (transmittance.IsBlack()) crossings.clear();
  scene.DropCutOuts(crossings);
  return transmittance;
}

Color GeometryScene::Transmittance(const Ray& ray, const FineLine& line, uint32_t kinds,
                                   std::vector<Crossing>& crossings) const {
  const Implementation& scene = *implementation_;
  crossings.clear();
  if (!scene.Accept(ray)) return Color(0.0f);
  TraceContext trace;
  trace.crossings = &crossings;
  trace.recordsBoundaries = scene.hasBoundaries;
  const Color transmittance = scene.Transmittance(ray, line, kinds, trace);
  if (transmittance.IsBlack()) crossings.clear();
  scene.DropCutOuts(crossings);
  return transmittance;
}

SurfacePoint GeometryScene::GetSurfacePoint(const Ray& ray, const RayHit& hit) const {
  const SceneTables& tables = implementation_->tables;
  const PrimitiveRecord& record = tables.primitives[hit.primitive];
  SurfacePoint point;
  if (hit.instance == kNoIndex) [[likely]] {
    EvaluatePrimitive(record, ray, hit, point);
  } else {
    const InstanceRecord& instance = tables.instances[hit.instance];
    std::optional<InstancePlacement> moved;
    if (instance.motion) [[unlikely]]
      moved = PlacementAt(*instance.motion, ray.time);
    const InstancePlacement& placement = moved ? *moved : instance.placement;
    const Affine& toObject = placement.toObject;
    const Ray local{toObject.Point(ray.origin), toObject.Vector(ray.direction), hit.t, ray.time};
    EvaluatePrimitive(record, local, hit, point);
    ApplyInstance(placement, point);
  }
  point.primitive = hit.primitive;
  point.patch = hit.patch;
  point.instance = hit.instance;
  return point;
}

const GeometryAttributes& GeometryScene::Attributes(uint32_t primitive) const {
  return implementation_->tables.attributes[primitive];
}

int32_t GeometryScene::LightAt(uint32_t primitive, uint32_t instance) const {
  const SceneTables& tables = implementation_->tables;
  const int32_t light = tables.attributes[primitive].light;
  return light < 0 || instance == kNoIndex ? light : light + tables.instances[instance].firstLight;
}

bool GeometryScene::HasBoundaries() const {
  return implementation_->hasBoundaries;
}

bool GeometryScene::IsTracedByEmbree() const {
  return !implementation_->few;
}

size_t GeometryScene::PrimitiveCount() const {
  return implementation_->tables.primitives.size();
}

const Bounds3& GeometryScene::GetBounds() const {
  return implementation_->bounds;
}

BoundingSphere GeometryScene::GetBoundingSphere() const {
  const Bounds3& bounds = implementation_->bounds;
  if (bounds.IsEmpty()) return {};
  const double radius = 0.5 * glm::length(Vector3d(bounds.max) - Vector3d(bounds.min));
  // Wider by the rounding of centre and radius; never 0, even for a scene that is one point.
  const float rounding = 4 * 0x1p-23f * std::max(MaxAbsComponent(bounds.min), MaxAbsComponent(bounds.max));
  const float padded = static_cast<float>(radius * (1 + 1e-6)) + rounding;
  return {bounds.Center(), padded > 0 ? padded : 1.0f};
}

uint64_t GeometryScene::RejectedRays() const {
  return implementation_->rejected.load(std::memory_order_relaxed);
}

}  // namespace lampyr
