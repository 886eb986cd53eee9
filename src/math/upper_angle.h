// Angles of the upper half plane with their sines and cosines: accurate to a few ulps, in about half of the time of the
// standard library's functions. Solid angles and arcs of lights are sequences of these operations.
#pragma once

#include <cmath>
#include <type_traits>

namespace lampyr {

namespace upper_angle_internal {

// Cosine and sine of the multiples of π/8.
template <class Real>
struct Turn {
  Real cosine, sine;
};
template <class Real>
inline constexpr Turn<Real> kTurns[9] = {
    {Real(1), Real(0)},
    {Real(0.92387953251128675613), Real(0.38268343236508977173)},
    {Real(0.70710678118654752440), Real(0.70710678118654752440)},
    {Real(0.38268343236508977173), Real(0.92387953251128675613)},
    {Real(0), Real(1)},
    {Real(-0.38268343236508977173), Real(0.92387953251128675613)},
    {Real(-0.70710678118654752440), Real(0.70710678118654752440)},
    {Real(-0.92387953251128675613), Real(0.38268343236508977173)},
    {Real(-1), Real(0)},
};

}  // namespace upper_angle_internal

// std::atan2(y, x) in [0, π] for y >= 0 and (x, y) not (0, 0), both finite and far from the ends of Real's range.
template <class Real>
inline Real UpperAngle(Real y, Real x) {
  // Rotated into the first quadrant.
  const bool isLeft = x < 0;
  const Real right = isLeft ? y : x, up = isLeft ? -x : y;
  // Rotated back by the nearest multiple of π/8 (up to rounding), which leaves at most π/16.
  const int k = (up > Real(0.19891236737965800691) * right) + (up > Real(0.66817863791929891999) * right) +
                (up > Real(1.49660576266548901760) * right) + (up > Real(5.02733949212584810451) * right);
  const auto& turn = upper_angle_internal::kTurns<Real>[k];
  const Real t = (up * turn.cosine - right * turn.sine) / (right * turn.cosine + up * turn.sine);
  // The series up to t^19, or t^9 in float: t² < 0.04.
  const Real t2 = t * t, t4 = t2 * t2;
  constexpr Real k3 = Real(1) / 3, k5 = Real(1) / 5, k7 = Real(1) / 7, k9 = Real(1) / 9, k11 = Real(1) / 11,
                 k13 = Real(1) / 13, k15 = Real(1) / 15, k17 = Real(1) / 17, k19 = Real(1) / 19;
  Real beyond = 0;
  if constexpr (std::is_same_v<Real, double>) beyond = k11 - k13 * t2 + t4 * (k15 - k17 * t2 + t4 * k19);
  const Real series = t2 * (k3 - k5 * t2 + t4 * (k7 - k9 * t2 + t4 * beyond));
  const Real angle = Real(0.39269908169872415481) * static_cast<Real>(k) + (t - t * series);
  return isLeft ? Real(1.57079632679489661923) + angle : angle;
}

struct SineCosine {
  double sine, cosine;
};

// Sine and cosine of an angle in [0, π]. The relative precision of the sine is kept for small angles.
inline SineCosine SineCosineOfUpper(double angle) {
  const int k = static_cast<int>(angle * 2.54647908947032537230 + 0.5);
  const auto& turn = upper_angle_internal::kTurns<double>[k];
  // π/8 in two parts, the first short enough that its multiples are exact.
  constexpr double kHigh = 0x1.921fb54p-2, kLow = 0x1.10b4611a62633p-32;
  const double rest = (angle - k * kHigh) - k * kLow, r2 = rest * rest, r4 = r2 * r2;
  // The series up to rest^11 and rest^12: rest² < 0.04.
  const double sine =
      rest *
      (1 + r2 * ((-1.0 / 6 + r2 * (1.0 / 120)) + r4 * ((-1.0 / 5040 + r2 * (1.0 / 362880)) + r4 * (-1.0 / 39916800))));
  const double cosine = 1 + r2 * ((-1.0 / 2 + r2 * (1.0 / 24)) + r4 * ((-1.0 / 720 + r2 * (1.0 / 40320)) +
                                                                       r4 * (-1.0 / 3628800 + r2 * (1.0 / 479001600))));
  return {turn.sine * cosine + turn.cosine * sine, turn.cosine * cosine - turn.sine * sine};
}

}  // namespace lampyr
