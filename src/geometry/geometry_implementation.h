// Private to the geometry: what a GeometryScene holds. geometry_build.cpp makes it, geometry_scene.cpp traces rays.
#pragma once

#include <embree3/rtcore.h>

#include <atomic>
#include <cmath>
#include <deque>
#include <memory>
#include <vector>

#include "geometry/crossing_order.h"
#include "geometry/few_surfaces.h"
#include "geometry/fine_distance.h"
#include "geometry/geometry_scene.h"
#include "geometry/scene_tables.h"
#include "geometry/shape_checks.h"

namespace lampyr {

struct DeviceDeleter {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
struct SceneDeleter {
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using DeviceHandle = std::unique_ptr<RTCDeviceTy, DeviceDeleter>;
using SceneHandle = std::unique_ptr<RTCSceneTy, SceneDeleter>;

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

  explicit Implementation(GeometryDescription given);

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

}  // namespace lampyr
