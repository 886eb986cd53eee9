// A density of directions at a place: a mixture of von Mises-Fisher lobes, each aimed at a target, so that it turns as
// the place moves ([Ruppert20]: parallax-aware mixtures).
//
// A target at a finite distance is a position. Its lobe is as wide as something of constant size there looks: κ grows
// with the squared distance. A target at infinity is a direction, and its κ is the same everywhere.
#pragma once

#include <array>

#include "math/density.h"
#include "math/vec.h"

namespace lampyr {

struct DirectionMixture {
  static constexpr int kLobes = 8;
  // Bounds of κ. The highest is a lobe of a degree; from the lowest on, 1 - exp(-2κ) has its precision.
  static constexpr float kLeastKappa = 0.1f, kMostKappa = 4000;
  using Lanes = std::array<float, kLobes>;

  // One entry for each lobe; an unused lobe has the weight 0. The vector from a point p to the target is
  // (x, y, z) - nearness · p:
  // nearness is 1 for a position and 0 for a direction, of length 1.
  alignas(32) Lanes x{}, y{}, z{}, nearness{};
  alignas(32) Lanes kappaPerSquare{};  // κ over the squared distance to the target
  alignas(32) Lanes weight{};          // sum: 1

  void SetTarget(size_t lobe, const Point3& target, bool isDirection);
  // Density of `direction`, a unit vector, at `point`.
  PdfSolidAngle Density(const Point3& point, const Vector3& direction) const;
  // A direction with this density; `uLobe` chooses the lobe, `u` a direction of it; all in [0,1).
  Vector3 Sample(const Point3& point, float uLobe, const Point2& u) const;
  // False for what is no mixture: read from a damaged file.
  bool IsValid() const;

  // The density of each lobe alone, without its weight.
  void Densities(const Point3& point, const Vector3& direction, Lanes& densities) const;
};

}  // namespace lampyr
