// A box of cells from which points are sampled by the weights of the cells, and the search for the places of media.
// Internal to MediumEmission.
#pragma once

#include <array>
#include <span>

#include "geometry/geometry_scene.h"
#include "math/bounds.h"
#include "math/transform.h"
#include "media/medium.h"
#include "sampling/tables.h"

namespace lampyr {

class EmissionRegion {
 public:
  // `box`: of the cells, in the space that `toRender` maps to render space. `weights`: x fastest; not all 0.
  EmissionRegion(const Bounds3& box, const std::array<int, 3>& resolution, std::span<const float> weights,
                 const Affine& toRender);

  // A point of render space, within the box up to rounding. `u`: in [0,1).
  struct Point {
    Point3 position{0.0f};
    double density = 0;  // per volume of render space
  };
  Point Sample(double uCell, const Vector3& u) const;
  // Density of a point of render space; 0 beyond the box.
  double Density(const Point3& position) const;

 private:
  double DensityOf(uint32_t cell) const;

  Bounds3 box_;
  std::array<int, 3> resolution_;
  Affine toRender_, fromRender_;
  AliasTable cells_;
  double cellVolume_;  // in render space
};

// The region of the cells of a grid's majorants, weighted by their emission, and an estimate of the emitted power over
// 4π: the mean of the channels of ∫ σ_a L_e dV.
EmissionRegion RegionOfGrid(const Medium& medium, double& emission);

// Calls visit(tMin, tMax) for the parts of a ray in `medium`; the ray starts in `start`. Opaque surfaces do not stop
// it.
template <class Visit>
void ForEachSpan(const GeometryScene& geometry, const Ray& ray, int32_t start, int32_t medium, const Visit& visit) {
  std::vector<Crossing> crossings;
  RayHit hit;
  geometry.Trace(ray, visibility::kMedia, hit, crossings);
  int32_t current = start;
  float from = 0;
  for (const Crossing& crossing : crossings) {
    const auto t = static_cast<float>(crossing.t);
    if (current == medium) visit(from, t);
    if (crossing.medium != kSameMedium) current = crossing.medium;
    from = t;
  }
  if (current == medium) visit(from, ray.tMax);
}

// The part of the cube `within` in which a medium is found by rays along the axes, over the shutter if its surfaces
// move. `exterior`: the medium where the rays start.
struct FoundPlace {
  Bounds3 box;        // with a margin of the distance between rays; empty: nowhere
  double volume = 0;  // estimate
  std::array<int, 3> resolution{};
  std::vector<float> weights;  // per cell of the box: √ of the fraction that is in the medium; above 0
};
FoundPlace FindPlaceOf(const GeometryScene& geometry, const Bounds3& within, int32_t exterior, int32_t medium);

}  // namespace lampyr
