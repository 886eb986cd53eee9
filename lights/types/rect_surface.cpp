#include "lights/types/rect_surface.h"

namespace lampyr {

RectSurface::Placed RectSurface::Place(const LightTransform& transform) const {
  Placed placed{PlacedSurface::From({}, {}, transform)};
  placed.SetFlat({0, 0, -1});
  const Vector3d edgeX = -static_cast<double>(width_) * Vector3d(placed.toRender.linear[0]);
  const Vector3d edgeY = static_cast<double>(height_) * Vector3d(placed.toRender.linear[1]);
  placed.width = glm::length(edgeX);
  placed.x = edgeX / placed.width;
  placed.height = glm::length(edgeY);
  placed.y = edgeY / placed.height;
  // Orthogonal up to rounding of the transform.
  const double across = glm::dot(placed.x, placed.y);
  placed.isRectangle = std::abs(across) <= 4e-6;
  placed.y = glm::normalize(placed.y - across * placed.x);
  placed.z = glm::cross(placed.x, placed.y);
  const Vector3 corner(0.5f * width_, 0.5f * height_, 0.0f);
  placed.positionError = placed.toRender.PointError(corner, Gamma(4) * corner);
  return placed;
}

double RectSurface::AreaOf(const PlacedSurface& placed) const {
  const glm::dmat3 m(placed.toRender.linear);
  return static_cast<double>(width_) * static_cast<double>(height_) * glm::length(glm::cross(m[0], m[1]));
}

Bounds3 RectSurface::BoundsOf(const PlacedSurface& placed) const {
  Bounds3 bounds;
  for (const Point2 corner : {Point2(0, 0), Point2(1, 0), Point2(0, 1), Point2(1, 1)}) {
    bounds.Add(placed.toRender.Point(At(corner)));
  }
  return bounds;
}

RectSurface::View RectSurface::ViewFrom(const Placed& placed, const Point3& P, bool twoSided) const {
  View view;
  if (!placed.isRectangle) return view;
  // Relative to P, by way of the offset of the centre, which keeps its precision however far both are from the origin.
  const Vector3 toMiddle = placed.toRender.translation - P;
  if (!twoSided && !(glm::dot(toMiddle, placed.flatNormal) < 0)) return view;
  const Vector3d middle(toMiddle);
  view.rectangle.emplace(Vector3d(glm::dot(middle, placed.x) - 0.5 * placed.width,
                                  glm::dot(middle, placed.y) - 0.5 * placed.height, glm::dot(middle, placed.z)),
                         placed.width, placed.height);
  view.weight = view.rectangle->SolidAngle() > 0 ? 1.0f : 0.0f;
  return view;
}

void RectSurface::SampleView(const View& view, const Placed& placed, const Point3&, const Point2& u, bool,
                             LightSample& sample) const {
  const SphericalRectangle::Result seen = view.rectangle->Sample(u);
  const Vector3d way = placed.x * seen.toPoint.x + placed.y * seen.toPoint.y + placed.z * seen.toPoint.z;
  sample.direction = Vector3(way * (1 / seen.distance));
  sample.distance = static_cast<float>(seen.distance);
  const Point2 uv(seen.uv);
  sample.position = placed.toRender.Point(At(uv));
  sample.positionError = placed.positionError;
  sample.normal = placed.flatNormal;
  sample.uvw = Point3(uv, 0.0f);
}

}  // namespace lampyr
