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

// By meeting the surface again: the same ray finds the same hit.
void EvaluateCustom(const CustomSurface& surface, const Ray& ray, float t, SurfacePoint& point) {
  const RayDouble again{Point3d(ray.origin), Vector3d(ray.direction), static_cast<double>(kNearestHit),
                        std::numeric_limits<double>::infinity()};
  if (surface.Intersect(again, ray.time, &point)) return;
  point.position = ray.origin + t * ray.direction;
  point.positionError = Gamma(4) * (glm::abs(ray.origin) + std::abs(t) * glm::abs(ray.direction));
  point.Ng = point.Ns = -ray.direction;
}

}  // namespace

SurfacePoint EvaluatePrimitive(const PrimitiveRecord& record, const Ray& ray, const RayHit& hit) {
  SurfacePoint point;
  const Point2 uv(hit.u, hit.v);
  const Point3& origin = ray.origin;
  const Vector3& direction = ray.direction;
  switch (record.shape.index()) {
    case 0:
      EvaluateTriangle(**std::get_if<0>(&record.shape), hit.patch, uv, -direction, point);
      break;
    case 1:
      EvaluatePatch(**std::get_if<1>(&record.shape), hit.patch, uv, -direction, point);
      break;
    case 2:
      (*std::get_if<2>(&record.shape))->Evaluate(uv, point);
      break;
    case 3:
      EvaluateCurve(**std::get_if<3>(&record.shape), hit.patch, hit.u, origin, direction, hit.t, point);
      break;
    default:
      EvaluateCustom(**std::get_if<4>(&record.shape), ray, hit.t, point);
  }
  point.isSheet = record.sheet != nullptr;
  // A surface in a coordinate plane has no error across it, and a ray that starts on it exactly would find it again: a
  // floor of a millionth of the largest component.
  point.positionError += Vector3(1e-6f * MaxComponent(point.positionError));
  return point;
}

InstancePlacement PlacementAt(const Motion& motion, float time) {
  const Affine toRender = motion.At(time);
  return {toRender, toRender.Inverse()};
}

void ApplyInstance(const InstancePlacement& instance, SurfacePoint& point) {
  point.positionError = instance.toRender.PointError(point.position, point.positionError);
  point.position = instance.toRender.Point(point.position);
  point.positionError += InstanceRayError(instance.toRender, instance.toObject, point.position);
  // By the inverse transpose: the outer side stays the outer side, mirrored or not.
  point.Ng = SafeNormalize(instance.toObject.NormalByInverse(point.Ng), point.Ng);
  point.Ns = SafeNormalize(instance.toObject.NormalByInverse(point.Ns), point.Ng);
  if (glm::dot(point.Ng, point.Ns) < 0) point.Ns = -point.Ns;
  point.dpdu = instance.toRender.Vector(point.dpdu);
  point.dpdv = instance.toRender.Vector(point.dpdv);
}

}  // namespace lampyr
