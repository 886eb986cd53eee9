// Equiangular sampling of a distance along a ray ([Kulla12]): the angle under which an apex, a point of a light,
// sees the ray is sampled uniformly. The density is proportional to 1/(D² + (t-δ)²), the inverse of the squared
// distance to the apex, where D is the distance of the apex from the ray and δ the parameter of its foot:
//
//   t = δ + D tan((1-u) θa + u θb),  p(t) = D / ((θb - θa)(D² + (t-δ)²)),  θ = atan((t-δ)/D) at the ends a and b
//
// All of it is evaluated in double and relative to the start a, without θ itself: with φ = u (θb - θa),
//
//   t - a = (D² + (a-δ)²) sinφ / (D cosφ - (a-δ) sinφ)
//
// Nothing cancels. The result is accurate for an apex far before or behind the range, for ranges that the apex sees
// under 1e-30 rad, and for ranges without an end.
#pragma once

#include "math/density.h"
#include "math/vec.h"

namespace lampyr {

namespace measure {
struct Distance {};  // 1/scene unit, along a ray
}  // namespace measure
using PdfDistance = Pdf<measure::Distance>;

class EquiangularDistance {
 public:
  // For the part [tMin, tMax] of the ray from `origin` along the unit `direction`; 0 <= tMin, and tMax may be infinite.
  // An apex nearer to the line than 2^-16 of its distance along it is taken to be that far: floats still resolve the
  // density, which stays finite.
  EquiangularDistance(const Point3& origin, const Vector3& direction, const Point3& apex, float tMin, float tMax);

  // True if the range has no length, or does not exist. Nothing can be sampled then, and all densities are 0.
  bool IsEmpty() const { return !(angle_ > 0); }

  // Distance for the random number u in [0,1], within the range. Requires !IsEmpty().
  float Sample(float u) const;
  // Density of Sample at t; 0 outside of the range.
  PdfDistance Density(float t) const;
  // The random number of a distance in the range: the inverse of Sample, up to rounding.
  double Invert(float t) const;

 private:
  float tMin_, tMax_;
  double foot_ = 0;      // δ
  double distance_ = 0;  // D
  double start_ = 0;     // tMin - δ
  double angle_ = 0;     // θb - θa
};

}  // namespace lampyr
