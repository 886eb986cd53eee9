// Spheres, disks and cylinders, whole or partial: intersection and surface parametrisation in the conventions of
// pbrt-v4 (u along φ from 0 to phiMax; v from the lower to the upper end of sphere and cylinder, and from the rim to
// the inner radius of the disk).
#pragma once

#include <optional>

#include <glm/mat3x3.hpp>

#include "geometry/ray.h"
#include "geometry/shapes.h"

namespace lampyr {

// Intersection of a ray with a quadric. `coordinates` are accurate to an ulp of the radius and cheap, without angles:
// sphere: its unit normal, octahedrally mapped; disk: (x, y) / radius; cylinder: diamond angle of φ in [0,4) and v.
struct QuadricHit {
  double t = 0;
  Point2 coordinates{0.0f};
};

// A quadric prepared for intersection. The inverse transform is computed in double from the matrix that places hit
// points, so that both agree.
class PreparedQuadric {
 public:
  explicit PreparedQuadric(const Quadric& quadric);

  // Finds the hits with t in (tMin, tMax], nearest first, at most `most` of them; returns their number. The ray is in
  // render space (the target of `toRender`).
  int Intersect(const RayDouble& ray, QuadricHit hits[2], int most = 2) const;

  // Sets position, error, normals and, with `isParametrized`, uv and tangents, in the target space of `toRender`. Does
  // not set the indices.
  void Evaluate(const Point2& coordinates, bool isParametrized, SurfacePoint& point) const;

  const Quadric& Shape() const { return quadric_; }

 private:
  int IntersectSphere(const Point3d& o, const Vector3d& d, double tMax, double roots[2]) const;
  int IntersectCylinder(const Point3d& o, const Vector3d& d, double roots[2]) const;
  bool Accept(const Point3d& p) const;
  Point2 Encode(const Point3d& p) const;
  Point3 Decode(const Point2& coordinates) const;
  // Sets uv and tangents at p, in object space. `v`: for cylinders.
  void Parametrize(const Point3& p, float v, SurfacePoint& point) const;

  Quadric quadric_;
  glm::dmat3 toObject_{1.0};
  Vector3d toObjectTranslation_{0.0};
  float thetaZMin_ = 0, thetaZMax_ = 0;
  float normalSign_ = 1;  // of the outer side against the object-space normal
};

// +1 if the outer side of the quadric is the image of the object-space cross product dpdu × dpdv, -1 if it is the other
// side. ReverseOrientation changes it; mirroring does not.
inline float OutsideSign(const Quadric& quadric) {
  return quadric.flipNormals != quadric.toRender.SwapsHandedness() ? -1.0f : 1.0f;
}

}  // namespace lampyr
