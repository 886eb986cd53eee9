// See scene_tables.h.
#include "geometry/scene_tables.h"

#include <limits>

#include "geometry/bilinear.h"
#include "geometry/curves.h"
#include "geometry/robust.h"
#include "geometry/rounding.h"
#include "geometry/triangle_surface.h"

namespace lampyr {

namespace {

// Intersects the surface again: the same ray finds the same hit.
void EvaluateCustom(const CustomSurface& surface, const Ray& ray, float t, SurfacePoint& point) {
  const RayDouble again{Point3d(ray.origin), Vector3d(ray.direction), static_cast<double>(kNearestHit),
                        std::numeric_limits<double>::infinity()};
  if (surface.Intersect(again, ray.time, &point)) return;
  point.position = ray.origin + t * ray.direction;
  point.positionError = Gamma(4) * (Abs(ray.origin) + std::abs(t) * Abs(ray.direction));
  point.Ng = point.Ns = -ray.direction;
}

// Point of a triangle or patch in double. The hit's coordinates are rounded, but the point is on the surface.
Point3d PrecisePoint(const PrimitiveRecord& record, const RayHit& hit) {
  const double u = static_cast<double>(hit.u), v = static_cast<double>(hit.v);
  if (const TriangleMesh* triangles = record.As<TriangleMesh>()) {
    const auto& t = triangles->triangles[hit.patch];
    const auto& x = triangles->positions;
    return (1 - u - v) * Point3d(x[t[0]]) + u * Point3d(x[t[1]]) + v * Point3d(x[t[2]]);
  }
  const BilinearMesh& patches = *record.As<BilinearMesh>();
  const auto& q = patches.patches[hit.patch];
  const auto& x = patches.positions;
  return (1 - v) * ((1 - u) * Point3d(x[q[0]]) + u * Point3d(x[q[1]])) +
         v * ((1 - u) * Point3d(x[q[2]]) + u * Point3d(x[q[3]]));
}

// Barycentric coordinates resolve a plain of a million metres to a tenth of a metre only; the ray resolves it far
// better. If the resolution is coarse relative to the ray's length, the point is moved to the intersection of the ray
// with the tangent plane. The error bound is kept: rays that start here must clear the surface as intersected by other
// rays.
void MoveOntoRay(const PrimitiveRecord& record, const Ray& ray, const RayHit& hit, SurfacePoint& point) {
  const Point3d onSurface = PrecisePoint(record, hit), origin(ray.origin);
  const Vector3d direction(ray.direction), normal(point.Ng);
  const double slope = glm::dot(direction, normal);
  constexpr double kGrazing = 1e-3;
  if (!(std::abs(slope) > kGrazing * glm::length(direction))) return;
  const Point3 moved(origin + direction * (glm::dot(onSurface - origin, normal) / slope));
  const Vector3 way = Abs(moved - point.position);
  if (way.x <= 4 * point.positionError.x && way.y <= 4 * point.positionError.y && way.z <= 4 * point.positionError.z)
    point.position = moved;
}

// One overload for each kind of shape; `uv` are the hit's coordinates.
struct Evaluate {
  const Ray& ray;
  const RayHit& hit;
  SurfacePoint& point;
  bool isParametrized;
  Point2 uv{hit.u, hit.v};

  void operator()(const TriangleMesh* mesh) const {
    EvaluateTriangle(*mesh, hit.patch, uv, -ray.direction, isParametrized, point);
  }
  void operator()(const BilinearMesh* mesh) const { EvaluatePatch(*mesh, hit.patch, uv, -ray.direction, point); }
  void operator()(const PreparedQuadric* quadric) const { quadric->Evaluate(uv, isParametrized, point); }
  void operator()(const CurveSet* curves) const {
    EvaluateCurve(*curves, hit.patch, hit.u, ray.origin, ray.direction, hit.t, point);
  }
  void operator()(const CustomSurface* surface) const { EvaluateCustom(*surface, ray, hit.t, point); }
};

}  // namespace

void EvaluatePrimitive(const PrimitiveRecord& record, const Ray& ray, const RayHit& hit, SurfacePoint& point) {
  std::visit(Evaluate{ray, hit, point, record.isParametrized}, record.shape);
  point.isThin = record.thin != nullptr;
  // A surface in a coordinate plane has no error across it, and a ray that starts exactly on it would hit it again: the
  // error of each component is at least a millionth of the largest.
  const float coarse = MaxComponent(point.positionError);
  point.positionError += Vector3(1e-6f * coarse);
  constexpr float kCoarse = 1e-5f;
  if (coarse > kCoarse * hit.t * MaxAbsComponent(ray.direction)) [[unlikely]] {
    if (record.As<TriangleMesh>() || record.As<BilinearMesh>()) MoveOntoRay(record, ray, hit, point);
  }
}

InstancePlacement PlacementAt(const Motion& motion, float time) {
  const Affine toRender = motion.At(time);
  return {toRender, toRender.Inverse()};
}

void ApplyInstance(const InstancePlacement& instance, SurfacePoint& point) {
  point.positionError = instance.toRender.PointError(point.position, point.positionError);
  point.position = instance.toRender.Point(point.position);
  point.positionError += InstanceRayError(instance.toRender, instance.toObject, point.position);
  // Normals by the inverse transpose: the outer side stays the outer side, mirrored or not.
  point.Ng = SafeNormalize(instance.toObject.NormalByInverse(point.Ng), point.Ng);
  point.Ns = SafeNormalize(instance.toObject.NormalByInverse(point.Ns), point.Ng);
  if (glm::dot(point.Ng, point.Ns) < 0) point.Ns = -point.Ns;
  point.dpdu = instance.toRender.Vector(point.dpdu);
  point.dpdv = instance.toRender.Vector(point.dpdv);
}

}  // namespace lampyr
