// Private to the geometry: tables of primitives and instances, by the indices of a hit. Flat arrays, no virtual calls.
#pragma once

#include <cstdint>
#include <variant>
#include <vector>

#include "geometry/geometry_scene.h"
#include "geometry/quadric.h"

namespace lampyr {

struct SceneTables;

// The data of a primitive that Embree's callbacks and GetSurfacePoint need.
struct PrimitiveRecord {
  std::variant<const TriangleMesh*, const BilinearMesh*, const PreparedQuadric*, const CurveSet*, const CustomSurface*>
      shape;
  const AlphaSource* alpha = nullptr;  // null: opaque
  const ThinSurface* thin = nullptr;   // null: none

  bool hasNoInside = false;    // a round curve that rays from inside do not hit
  bool isParametrized = true;  // GeometryAttributes::isParametrized

  // The surface separates media, or is a boundary. All rays hit it; those that it does not stop pass it as a boundary.
  bool separatesMedia = false;
  uint32_t stops = visibility::kAll;  // kinds of rays, if it separates media
  int32_t insideMedium = kSameMedium, outsideMedium = kSameMedium;

  bool PassedAsBoundary(uint32_t kinds) const { return separatesMedia && (stops & kinds) == 0; }
  // False: every ray that hits the surface is stopped.
  bool LetsPass() const { return letsPass; }
  void SetLetsPass() { letsPass = alpha || thin || hasNoInside || separatesMedia; }
  // The shape if it is of this kind, or null.
  template <class Kind>
  const Kind* As() const {
    const auto* held = std::get_if<const Kind*>(&shape);
    return held ? *held : nullptr;
  }
  const SceneTables* tables = nullptr;
  bool letsPass = false;  // set last, by SetLetsPass
};

struct InstancePlacement {
  Affine toRender, toObject;
};

// An instance of Embree. It exists during part of the shutter, and stays there or moves by evenly spaced keys.
struct InstanceRecord {
  InstancePlacement placement;  // unless it moves
  uint32_t object = 0;
  uint32_t firstPrimitive = 0;  // of the object
  int32_t firstLight = 0;
  const Motion* motion = nullptr;  // null: static while it exists
  float begin = 0, end = 1;        // shutter times
};

// Placement of a moving instance at a shutter time.
InstancePlacement PlacementAt(const Motion& motion, float time);

struct SceneTables {
  std::vector<PrimitiveRecord> primitives;  // entries of the scene, then of object 0, 1, …
  std::vector<GeometryAttributes> attributes;
  std::vector<InstanceRecord> instances;  // one that appears or vanishes during the shutter has several
  uint32_t firstInstanceId = 0;           // Embree's id of instance 0; the scene's own entries come before
};

// Kinds of rays that hit the surface.
inline uint32_t VisibleTo(const PrimitiveRecord& record, const GeometryAttributes& attributes) {
  return record.separatesMedia ? visibility::kAll | visibility::kMedia : attributes.visibility;
}

// Point of a hit in the space of the primitive, in which `ray` is given, too. `hit` needs t, patch, u and v. `point`:
// output; must be newly constructed.
void EvaluatePrimitive(const PrimitiveRecord& record, const Ray& ray, const RayHit& hit, SurfacePoint& point);

// Transforms a point of an instanced object to render space.
void ApplyInstance(const InstancePlacement& instance, SurfacePoint& point);

}  // namespace lampyr
