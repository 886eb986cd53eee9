// Private to the geometry: what a traced primitive's index leads to. Flat arrays, no virtual calls.
#pragma once

#include <variant>
#include <vector>

#include "geometry/geometry_scene.h"
#include "geometry/quadric.h"

namespace lampyr {

struct SceneTables;

// What Embree's callbacks and GetSurfacePoint need of a primitive.
struct PrimitiveRecord {
  std::variant<const TriangleMesh*, const BilinearMesh*, const PreparedQuadric*, const CurveSet*> shape;
  const AlphaSource* alpha = nullptr;  // null: opaque
  const SceneTables* tables = nullptr;
};

struct InstanceRecord {
  Affine toRender, toObject;
  uint32_t firstPrimitive = 0;  // of the object
  int32_t firstLight = 0;
};

struct SceneTables {
  std::vector<PrimitiveRecord> primitives;  // entries of the scene, then of object 0, 1, …
  std::vector<GeometryAttributes> attributes;
  std::vector<InstanceRecord> instances;
  uint32_t firstInstanceId = 0;  // Embree's id of instance 0; the scene's own entries come before
};

// Texture coordinates and position of a hit, for cut-outs: in the space of the primitive. `hit` needs t, patch, u and v.
SurfacePoint EvaluatePrimitive(const PrimitiveRecord& record, const Point3& origin, const Vector3& direction,
                               const RayHit& hit);

// Carries a point of an instanced object over to render space.
void ApplyInstance(const InstanceRecord& instance, SurfacePoint& point);

}  // namespace lampyr
