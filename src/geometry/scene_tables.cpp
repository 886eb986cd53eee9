// See scene_tables.h.
#include "geometry/scene_tables.h"

#include "geometry/bilinear.h"
#include "geometry/curves.h"
#include "geometry/rounding.h"
#include "geometry/triangle_surface.h"

namespace lampyr {

SurfacePoint EvaluatePrimitive(const PrimitiveRecord& record, const Point3& origin, const Vector3& direction,
                               const RayHit& hit) {
  SurfacePoint point;
  const Point2 uv(hit.u, hit.v);
  switch (record.shape.index()) {
    case 0: EvaluateTriangle(**std::get_if<0>(&record.shape), hit.patch, uv, -direction, point); break;
    case 1: EvaluatePatch(**std::get_if<1>(&record.shape), hit.patch, uv, -direction, point); break;
    case 2: (*std::get_if<2>(&record.shape))->Evaluate(uv, point); break;
    default: EvaluateCurve(**std::get_if<3>(&record.shape), hit.patch, hit.u, origin, direction, hit.t, point);
  }
  // A surface in a coordinate plane has no error across it, and a ray that starts on it exactly would find it again: a
  // floor of a millionth of the largest component.
  point.positionError += Vector3(1e-6f * MaxComponent(point.positionError));
  return point;
}

void ApplyInstance(const InstanceRecord& instance, SurfacePoint& point) {
  point.positionError = instance.toRender.PointError(point.position, point.positionError);
  point.position = instance.toRender.Point(point.position);
  // By the inverse transpose: the outer side stays the outer side, mirrored or not.
  point.Ng = SafeNormalize(instance.toObject.NormalByInverse(point.Ng), point.Ng);
  point.Ns = SafeNormalize(instance.toObject.NormalByInverse(point.Ns), point.Ng);
  if (glm::dot(point.Ng, point.Ns) < 0) point.Ns = -point.Ns;
  point.dpdu = instance.toRender.Vector(point.dpdu);
  point.dpdv = instance.toRender.Vector(point.dpdv);
}

}  // namespace lampyr
