// Distributions of directions: their integral over the sphere, and the χ² test of sampled directions against them.
#pragma once

#include <span>
#include <string>

#include "suite/adaptive_square.h"

namespace lampyr::suite {

// Directions within `wMax` = 1 - cosθ of an axis: uniform in (w, turns) is uniform in solid angle.
struct Cap {
  Vector3d axis{0, 0, 1};
  double wMax = 2;

  double SolidAngle() const;
  Vector3d Direction(double w, double turns) const;
  // (w / wMax, turns), both in [0,1] within the cap.
  Point2d Invert(const Vector3d& direction) const;
  bool IsSphere() const { return wMax >= 2; }
};

// A cap around the mean of `directions`, of twice the solid angle that holds them all; the sphere if they extend beyond
// 60°.
Cap CapAround(std::span<const Vector3d> directions);

// Quadrature over the whole sphere in two parts: the cap that holds the light, and its complement.
class DirectionQuadrature {
 public:
  using Function = std::function<Integrands(const Vector3d&)>;  // of a unit direction, per sr
  static constexpr int kBudget = 48000;
  // `hints`: directions where the integrand is large; they must be independent of the directions under test.
  DirectionQuadrature(const Cap& cap, std::span<const Vector3d> hints, const Function& function, Rng& rng,
                      int budget = kBudget);

  Estimate Density() const;
  Estimate Radiance() const;
  // p-value of the χ² test of `directions` against the density; draws - directions.size() draws gave no direction.
  // `worst`, unless null, receives a description of the cell that differs most.
  double Test(std::span<const Vector3d> directions, double draws, int cells = 48, std::string* worst = nullptr);

  // ∫ f dω of `count` functions evaluated at shared points, which are distributed like those of Density().
  using Functions = std::function<void(const Vector3d&, std::span<double> values)>;
  std::vector<Estimate> Integrate(size_t count, const Functions& f, Rng& rng) const;

 private:
  struct Part {
    Cap cap;
    AdaptiveSquare square;
  };
  size_t PartOf(const Vector3d& direction) const {
    return parts_.size() > 1 && parts_[0].cap.Invert(direction).x >= 1 ? 1 : 0;
  }
  std::vector<Part> parts_;
};

}  // namespace lampyr::suite
