// See geometry_scene.h. Building the Embree scenes, the gate in front of every Embree call, and looking up hits.
#include "geometry/geometry_scene.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <atomic>
#include <deque>
#include <optional>
#include <string>

#include "base/error.h"
#include "geometry/crossing_order.h"
#include "geometry/embree_geometries.h"
#include "geometry/few_surfaces.h"
#include "geometry/fine_distance.h"
#include "geometry/meeting.h"
#include "geometry/rounding.h"
#include "geometry/scene_tables.h"
#include "geometry/shape_checks.h"

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

// ThreadSanitizer does not understand the synchronisation of Embree's own threads: without them there is none.
#if defined(__SANITIZE_THREAD__)
constexpr const char* kDeviceSettings = "frequency_level=simd256,threads=1";
#else
constexpr const char* kDeviceSettings = "frequency_level=simd256";
#endif

struct DeviceDeleter {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
struct SceneDeleter {
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using DeviceHandle = std::unique_ptr<RTCDeviceTy, DeviceDeleter>;
using SceneHandle = std::unique_ptr<RTCSceneTy, SceneDeleter>;

const char* ErrorName(RTCError error) {
  switch (error) {
    case RTC_ERROR_OUT_OF_MEMORY:
      return "out of memory";
    case RTC_ERROR_INVALID_ARGUMENT:
      return "invalid argument";
    case RTC_ERROR_INVALID_OPERATION:
      return "invalid operation";
    case RTC_ERROR_UNSUPPORTED_CPU:
      return "unsupported CPU";
    case RTC_ERROR_CANCELLED:
      return "cancelled";
    default:
      return "unknown error";
  }
}

void ThrowOnError(RTCDevice device, const char* doing) {
  const RTCError error = rtcGetDeviceError(device);
  if (error != RTC_ERROR_NONE) throw Error(std::string("Embree, ") + doing + ": " + ErrorName(error));
}

}  // namespace

struct GeometryScene::Implementation {
  GeometryDescription description;
  SceneTables tables;
  std::deque<PreparedQuadric> quadrics;  // a deque: records point into it
  DeviceHandle device;
  std::vector<SceneHandle> objectScenes;
  SceneHandle scene;
  std::unique_ptr<const FewSurfaces> few;  // null: Embree traces the rays
  Bounds3 bounds;
  float largest = kFarthest;
  bool hasTints = false;       // some thin surface is not clear
  bool hasBoundaries = false;  // some surface separates media
  bool letsPass = false;       // some surface lets rays pass: without, connecting rays have no crossings
  mutable std::atomic<uint64_t> rejected{0};

  explicit Implementation(GeometryDescription given) : description(std::move(given)) {
    FillTables();
    ComputeBounds();
    if (description.tracer == Tracer::BySize) few = FewSurfaces::Of(tables);
    if (!few) BuildScenes();
  }

  void AddEntries(const std::vector<GeometryEntry>& entries);
  void SetMedia(const GeometryAttributes& attributes, PrimitiveRecord& record);
  void FillTables();
  void AddInstance(const GeometryInstance& instance, uint32_t firstPrimitive);
  template <class Visit>
  void VisitBoxes(const Visit& visit) const;
  void ComputeBounds();
  SceneHandle NewScene() const;
  void AttachEntries(RTCScene target, size_t first, size_t count);
  void BuildScenes();
  // Inlined: a call costs as much as all else in these functions besides Embree.
  [[gnu::always_inline]] bool Query(const Ray& ray, uint32_t kinds, RayHit& hit, TraceContext& trace) const;
  [[gnu::always_inline]] bool Trace(const Ray& ray, uint32_t kinds, RayHit& hit, TraceContext& trace) const;
  [[gnu::always_inline]] bool Passes(const Ray& ray, uint32_t kinds, TraceContext& trace) const;
  [[gnu::always_inline]] Color Transmittance(const Ray& ray, uint32_t kinds, TraceContext& trace) const;
  LineHit Trace(const Ray& ray, double ahead, const FineLine& line, uint32_t kinds, RayHit& hit,
                TraceContext& trace) const;
  Color Transmittance(const Ray& ray, const FineLine& line, uint32_t kinds, TraceContext& trace) const;
  // `largest`: the largest coordinate of the start of the ray.
  void OrderCrossings(double largest, std::vector<Crossing>& crossings, bool withBoundaries) const;
  void DropCutOuts(std::vector<Crossing>& crossings) const;

  // True if Embree survives the ray. A NaN anywhere makes a comparison false.
  bool Accept(const Ray& ray) const {
    const float direction = std::abs(ray.direction.x) + std::abs(ray.direction.y) + std::abs(ray.direction.z);
    const float origin = std::abs(ray.origin.x) + std::abs(ray.origin.y) + std::abs(ray.origin.z);
    if (direction > 0 && origin + direction < largest && ray.tMax >= 0) [[likely]]
      return true;
    rejected.fetch_add(1, std::memory_order_relaxed);
    return false;
  }
};

void GeometryScene::Implementation::AddEntries(const std::vector<GeometryEntry>& entries) {
  for (const GeometryEntry& entry : entries) {
    CheckShape(entry.shape);
    PrimitiveRecord record;
    if (const Quadric* quadric = std::get_if<Quadric>(&entry.shape)) {
      record.shape = &quadrics.emplace_back(*quadric);
    } else {
      std::visit(
          [&]<class Kind>(const Kind& shape) {
            if constexpr (!std::is_same_v<Kind, Quadric>) record.shape = shape.get();
          },
          entry.shape);
    }
    record.alpha = entry.attributes.alpha.get();
    record.thin = entry.attributes.thin.get();
    const CurveSet* curves = record.As<CurveSet>();
    record.hasNoInside = entry.attributes.isFibrous && curves && curves->kind == CurveSet::Kind::Cylinder;
    hasTints = hasTints || (record.thin && !record.thin->IsClear());
    record.isParametrized = entry.attributes.isParametrized;
    if (entry.attributes.isBoundary || SeparatesMedia(entry.attributes)) SetMedia(entry.attributes, record);
    record.SetLetsPass();
    letsPass = letsPass || record.LetsPass();
    record.tables = &tables;
    tables.primitives.push_back(record);
    tables.attributes.push_back(entry.attributes);
  }
}

// A surface that separates media does so for all rays. For rays to which it is invisible it is a boundary alone, so
// that the medium at a point is the same on every path.
void GeometryScene::Implementation::SetMedia(const GeometryAttributes& attributes, PrimitiveRecord& record) {
  if (record.As<CurveSet>() || record.As<CustomSurface>())
    throw Error("curves and custom surfaces cannot separate participating media");
  record.separatesMedia = true;
  record.insideMedium = attributes.insideMedium;
  record.outsideMedium = attributes.outsideMedium;
  record.stops = attributes.isBoundary ? 0 : attributes.visibility;
  hasBoundaries = hasBoundaries || SeparatesMedia(attributes);
}

void GeometryScene::Implementation::FillTables() {
  AddEntries(description.entries);
  tables.firstInstanceId = static_cast<uint32_t>(description.entries.size());
  std::vector<uint32_t> firstPrimitives;
  for (const GeometryObject& object : description.objects) {
    firstPrimitives.push_back(static_cast<uint32_t>(tables.primitives.size()));
    for (const GeometryEntry& entry : object.entries) {
      if (std::holds_alternative<std::shared_ptr<const CustomSurface>>(entry.shape))
        throw Error("a custom surface cannot be part of an object");
    }
    AddEntries(object.entries);
  }
  for (const GeometryInstance& instance : description.instances) {
    if (instance.object >= description.objects.size()) throw Error("instance of an object that does not exist");
    AddInstance(instance, firstPrimitives[instance.object]);
  }
}

void GeometryScene::Implementation::AddInstance(const GeometryInstance& instance, uint32_t firstPrimitive) {
  InstanceRecord record;
  record.object = instance.object;
  record.firstPrimitive = firstPrimitive;
  record.firstLight = instance.firstLight;
  largest = std::min(largest, CheckInstance(instance));
  const auto add = [&](const Affine& toRender, const Affine& toObject, float begin, float end) {
    record.placement = {toRender, toObject};
    record.begin = begin;
    record.end = end;
    tables.instances.push_back(record);
  };
  if (!instance.motion) return add(instance.toRender, instance.toObject, 0, 1);
  // Embree spreads the keys of a geometry evenly over the time in which it exists: the parts before, during and after
  // the motion are separate geometries.
  const Motion& motion = *instance.motion;
  const Affine &first = motion.Keys().front(), &last = motion.Keys().back();
  if (motion.Begin() > 0) add(first, first.Inverse(), 0, motion.Begin());
  if (motion.End() < 1) add(last, last.Inverse(), motion.End(), 1);
  record.motion = &motion;
  if (motion.Begin() < motion.End()) add(first, first.Inverse(), motion.Begin(), motion.End());
}

namespace {

void AddPlacedBox(const Affine& toRender, const Bounds3& box, Bounds3& bounds) {
  if (box.IsEmpty()) return;
  for (int i = 0; i < 8; ++i) {
    const Point3 corner = toRender.Point(box.Corner(i));
    const Vector3 error = toRender.PointError(box.Corner(i), Vector3(0.0f));
    bounds.Add(corner - error);
    bounds.Add(corner + error);
  }
}

}  // namespace

// Calls visit(box, moves, attributes) for all shapes, once for each instance, with their boxes over the shutter.
template <class Visit>
void GeometryScene::Implementation::VisitBoxes(const Visit& visit) const {
  for (const GeometryEntry& entry : description.entries) visit(lampyr::GetBounds(entry.shape), false, entry.attributes);
  std::vector<std::vector<Bounds3>> boxes(description.objects.size());
  for (const GeometryInstance& instance : description.instances) {
    std::vector<Bounds3>& object = boxes[instance.object];
    if (object.empty()) {
      for (const GeometryEntry& entry : description.objects[instance.object].entries) {
        object.push_back(lampyr::GetBounds(entry.shape));
      }
    }
    for (size_t i = 0; i < object.size(); ++i) {
      Bounds3 placed;
      if (!instance.motion) AddPlacedBox(instance.toRender, object[i], placed);
      // A point moves along straight lines between keys: its positions at the keys bound it.
      if (instance.motion)
        for (const Affine& key : instance.motion->Keys()) AddPlacedBox(key, object[i], placed);
      visit(placed, instance.motion != nullptr, description.objects[instance.object].entries[i].attributes);
    }
  }
}

void GeometryScene::Implementation::ComputeBounds() {
  VisitBoxes([&](const Bounds3& box, bool, const GeometryAttributes&) { bounds.Add(box); });
}

SceneHandle GeometryScene::Implementation::NewScene() const {
  SceneHandle created(rtcNewScene(device.get()));
  rtcSetSceneFlags(created.get(), description.robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE);
  rtcSetSceneBuildQuality(created.get(), RTC_BUILD_QUALITY_MEDIUM);
  return created;
}

namespace {

void Attach(RTCScene scene, RTCGeometry geometry, uint32_t id) {
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(scene, geometry, id);
  rtcReleaseGeometry(geometry);
}

}  // namespace

void GeometryScene::Implementation::AttachEntries(RTCScene target, size_t first, size_t count) {
  for (size_t i = 0; i < count; ++i) {
    const PrimitiveRecord& record = tables.primitives[first + i];
    RTCGeometry geometry = NewGeometry(device.get(), record, VisibleTo(record, tables.attributes[first + i]));
    if (!geometry) continue;
    Attach(target, geometry, static_cast<uint32_t>(i));
  }
}

void GeometryScene::Implementation::BuildScenes() {
  device.reset(rtcNewDevice(kDeviceSettings));
  if (!device) throw Error(std::string("Embree cannot start: ") + ErrorName(rtcGetDeviceError(nullptr)));
  objectScenes.resize(description.objects.size());
  scene = NewScene();
  AttachEntries(scene.get(), 0, description.entries.size());
  for (size_t i = 0; i < tables.instances.size(); ++i) {
    const InstanceRecord& instance = tables.instances[i];
    const uint32_t object = instance.object;
    if (!objectScenes[object]) {
      objectScenes[object] = NewScene();
      AttachEntries(objectScenes[object].get(), instance.firstPrimitive, description.objects[object].entries.size());
      rtcCommitScene(objectScenes[object].get());
    }
    RTCGeometry geometry = NewInstance(device.get(), instance, objectScenes[object].get());
    Attach(scene.get(), geometry, tables.firstInstanceId + static_cast<uint32_t>(i));
  }
  rtcCommitScene(scene.get());
  ThrowOnError(device.get(), "building the scene");
}

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

MediumSurfaces GeometryScene::SurfacesOf(int32_t medium) const {
  if (medium < 0) return {};
  return SurfacesOfAll(static_cast<size_t>(medium) + 1).back();
}

std::vector<MediumSurfaces> GeometryScene::SurfacesOfAll(size_t media) const {
  std::vector<MediumSurfaces> all(media);
  implementation_->VisitBoxes([&](const Bounds3& box, bool moves, const GeometryAttributes& attributes) {
    const int32_t sides[] = {attributes.insideMedium, attributes.outsideMedium};
    for (int side = 0; side < 2; ++side) {
      if (sides[side] < 0 || static_cast<size_t>(sides[side]) >= media || (side == 1 && sides[1] == sides[0])) continue;
      MediumSurfaces& found = all[static_cast<size_t>(sides[side])];
      found.box.Add(box);
      found.move = found.move || moves;
      found.passesStraight =
          found.passesStraight || attributes.isBoundary || attributes.thin != nullptr || attributes.alpha != nullptr;
    }
  });
  return all;
}

std::vector<Bounds3> GeometryScene::BoundaryBoxes() const {
  std::vector<Bounds3> boxes;
  implementation_->VisitBoxes([&](const Bounds3& box, bool, const GeometryAttributes& attributes) {
    if (SeparatesMedia(attributes) && !attributes.isOpaque) boxes.push_back(box);
  });
  return boxes;
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
