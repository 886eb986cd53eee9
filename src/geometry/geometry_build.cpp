// Building a GeometryScene: its tables, its bounds, and the Embree scenes.
#include <algorithm>
#include <string>
#include <utility>

#include "base/error.h"
#include "geometry/embree_geometries.h"
#include "geometry/geometry_implementation.h"

namespace lampyr {

namespace {

// ThreadSanitizer does not understand the synchronisation of Embree's own threads: without them there is none.
#if defined(__SANITIZE_THREAD__)
constexpr const char* kDeviceSettings = "frequency_level=simd256,threads=1";
#else
constexpr const char* kDeviceSettings = "frequency_level=simd256";
#endif

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

GeometryScene::Implementation::Implementation(GeometryDescription given) : description(std::move(given)) {
  FillTables();
  ComputeBounds();
  if (description.tracer == Tracer::BySize) few = FewSurfaces::Of(tables);
  if (!few) BuildScenes();
}

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

}  // namespace lampyr
