// A portal in render space, a rectangle or under shear a parallelogram, and its view from a point. In double, because a
// portal may be tiny and distant, or very close.
#pragma once

#include <optional>

#include "lights/light.h"

namespace lampyr {

// corner + u·edgeX + v·edgeY, in the space of the scene file; edgeX × edgeY points outwards, towards the sky.
struct PortalShape {
  Point3d corner{0.0};
  Vector3d edgeX{1, 0, 0}, edgeY{0, 1, 0};
};

struct PortalPlace {
  PortalShape shape;  // in render space
  Vector3d outward{0, 0, 1};
  Vector3d dualX{1, 0, 0}, dualY{0, 1, 0};  // u and v of an offset in the plane, by dot products
  Vector3d axisX{1, 0, 0}, axisY{0, 1, 0};  // orthonormal with `outward`; axisX along edgeX
  double area = 1, lengthX = 1, lengthY = 1;
  double dualLengthX = 1, dualLengthY = 1;
  bool isRectangle = true;

  PortalPlace() = default;
  // `local` placed by a map that may rotate, mirror, scale or shear it.
  PortalPlace(const PortalShape& local, const Affine& toRender) {
    const glm::dmat3 linear(toRender.linear);
    shape.corner = linear * local.corner + Vector3d(toRender.translation);
    shape.edgeX = linear * local.edgeX;
    shape.edgeY = linear * local.edgeY;
    // A reflection flips the product of the edges.
    if (glm::determinant(linear) < 0) std::swap(shape.edgeX, shape.edgeY);
    const Vector3d product = glm::cross(shape.edgeX, shape.edgeY);
    area = glm::length(product);
    outward = product / area;
    dualX = glm::cross(shape.edgeY, outward) / area;
    dualY = glm::cross(outward, shape.edgeX) / area;
    axisX = glm::normalize(shape.edgeX);
    axisY = glm::cross(outward, axisX);
    dualLengthX = glm::length(dualX);
    dualLengthY = glm::length(dualY);
    lengthX = glm::length(shape.edgeX);
    lengthY = glm::length(shape.edgeY);
    isRectangle = std::abs(glm::dot(shape.edgeX, shape.edgeY)) <= 2e-6 * area;
  }

  Point3d At(const Point2d& uv) const { return shape.corner + uv.x * shape.edgeX + uv.y * shape.edgeY; }

  // A point of the portal, no nearer to its edge than `margin`.
  Point2d Inside(const Point2d& uv, double margin) const {
    const double x = std::min(margin * dualLengthX, 0.5), y = std::min(margin * dualLengthY, 0.5);
    return {std::clamp(uv.x, x, 1 - x), std::clamp(uv.y, y, 1 - y)};
  }

  // Upright space, in which a parallelogram is a lengthX × lengthY rectangle as well; for a rectangle it is only
  // turned.
  Vector3d ToUpright(const Vector3d& v) const {
    return {glm::dot(v, dualX) * lengthX, glm::dot(v, dualY) * lengthY, glm::dot(v, outward)};
  }
  // dω_upright / dω at a unit direction (lights/direction_map.h).
  float UprightSolidAngleFactor(const Vector3d& direction) const {
    if (isRectangle) return 1;
    const Vector3d upright = ToUpright(direction);
    const double squared = glm::dot(upright, upright);
    return static_cast<float>(lengthX * lengthY / (area * squared * std::sqrt(squared)));
  }

  // 1/m² on a plane perpendicular to the direction, for photons that start uniformly on the portal.
  PdfArea EmissionDensity(double cosine) const {
    const double density = cosine > 0 ? 1 / (area * cosine) : 0.0;
    return PdfArea(density < 3e38 ? static_cast<float>(density) : 0.0f);
  }
};

struct PortalView {
  const PortalPlace& place;
  Vector3d toCorner;
  double height;  // of the plane over the point; light arrives where it is positive

  PortalView(const PortalPlace& seen, const Point3& P)
      : place(seen), toCorner(seen.shape.corner - Point3d(P)), height(glm::dot(toCorner, seen.outward)) {
    // A point within its rounding of the plane counts as in the plane, where nothing arrives.
    const double rounding = 0x1p-22 * (static_cast<double>(MaxAbsComponent(P)));
    if (!(height > rounding)) height = 0;
  }

  // Intersection of a direction towards the sky with the portal.
  std::optional<Point2d> Meet(const Vector3d& direction) const {
    const double slope = glm::dot(direction, place.outward);
    if (!(height > 0 && slope > 0)) return std::nullopt;
    const Vector3d offset = direction * (height / slope) - toCorner;
    const Point2d uv(glm::dot(offset, place.dualX), glm::dot(offset, place.dualY));
    if (!(uv.x >= 0 && uv.x <= 1 && uv.y >= 0 && uv.y <= 1)) return std::nullopt;
    return uv;
  }

  // The direction through uv, rounded to float. It is kept away from the portal's edge so that the rounded direction
  // still passes through it, if the portal is wider than the spacing of directions.
  Vector3 Through(Point2d& uv) const {
    const Vector3d way = toCorner + uv.x * place.shape.edgeX + uv.y * place.shape.edgeY;
    const double step = 2.5e-7 * glm::dot(way, way) / height;
    const Point2d inside = place.Inside(uv, step);
    if (inside == uv) return Vector3(glm::normalize(way));
    uv = inside;
    return Vector3(glm::normalize(toCorner + uv.x * place.shape.edgeX + uv.y * place.shape.edgeY));
  }
};

}  // namespace lampyr
