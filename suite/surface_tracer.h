// A light's own surface in render space, by ray tracing, in double: all that the suite uses of its shape.
#pragma once

#include <glm/mat3x3.hpp>

#include "suite/area_common.h"

namespace lampyr::suite {

struct SurfaceHit {
  double distance = 0;    // along the unit ray
  Point3d position{0.0};  // render space
  Vector3d normal{0.0};   // unit, outer side, render space
  Point2 uv{0.0f};
  Point3d local{0.0};  // the same point in the light's space
  double stretch = 1;  // area in render space over area in the light's
};

class SurfaceTracer {
 public:
  SurfaceTracer(const IntersectableLight& surface, const LightTransform& transform);

  // Nearest hit beyond `from`, at most `to` away.
  std::optional<SurfaceHit> Trace(const Point3d& origin, const Vector3d& direction, double from = 0,
                                  double to = std::numeric_limits<double>::infinity()) const;
  // The hit of the ray nearest to `position`, and whether it is the first hit along the ray.
  struct Found {
    SurfaceHit hit;
    bool isFirst = true;
  };
  std::optional<Found> Find(const Point3d& origin, const Vector3d& direction, const Point3d& position) const;

  // ∫ f dA over the surface in `cells` of its box in its own space: f(hit) of all points that random lines hit. A line
  // that enters the box at a uniform point in a cosine-distributed direction is one of the uniform measure of all
  // lines, so that ∫_A f dA is half the box's area times the mean of the sum over a line's hits [Santaló04 §14.7].
  std::vector<Estimate> IntegrateOver(size_t cells, const std::function<size_t(const SurfaceHit&)>& cellOf,
                                      const std::function<double(const SurfaceHit&)>& f, Rng& rng) const;

  const Bounds3d& LocalBox() const { return box_; }
  const Enclosure& Around() const { return enclosure_; }
  Point3d ToLocal(const Point3d& p) const { return inverse_ * (p - translation_); }

 private:
  SurfaceHit Complete(const LocalHit& hit, double distance) const;
  std::optional<LocalHit> IntersectLocal(const Point3d& origin, const Vector3d& direction, double from,
                                         double to) const;

  const IntersectableLight& surface_;
  glm::dmat3 linear_, inverse_;
  Vector3d translation_;
  double determinant_;
  Bounds3d box_;  // local
  Enclosure enclosure_;
};

// The LightHit of a surface hit on a ray in `direction`.
LightHit HitFrom(const SurfaceHit& found, const Vector3d& direction);
// Cap of all directions from P in which a ray may hit the light.
Cap CapTowards(const Enclosure& around, const Point3& P);

}  // namespace lampyr::suite
