// Probability densities whose measure is part of the type, and the only conversions between measures.
//
// A density in solid angle (1/sr) and one in area (1/m²) are different numbers for the same sample; adding or comparing
// the two does not compile. A density of 0 means that the technique cannot generate the sample. Delta distributions are
// flags elsewhere and never a density ([Veach97 §8.3.2]).
#pragma once

#include "math/vec.h"

namespace lampyr {

namespace measure {
struct SolidAngle {};  // 1/sr
struct Area {};        // 1/m²
struct Discrete {};    // a probability
struct AreaPair {};    // 1/m⁴, of two surface points
}  // namespace measure

template <class Measure>
struct Pdf {
  float value = 0;

  Pdf() = default;
  constexpr explicit Pdf(float v) : value(v) {}

  bool IsZero() const { return value == 0; }
  friend Pdf operator+(Pdf a, Pdf b) { return Pdf(a.value + b.value); }
  friend Pdf operator*(Pdf a, float s) { return Pdf(a.value * s); }
  friend Pdf operator*(float s, Pdf a) { return Pdf(a.value * s); }
  friend auto operator<=>(const Pdf&, const Pdf&) = default;
};

using PdfSolidAngle = Pdf<measure::SolidAngle>;
using PdfArea = Pdf<measure::Area>;
using PdfDiscrete = Pdf<measure::Discrete>;

// Density of selecting with a probability and then sampling: in the measure of the sample.
template <class Measure>
Pdf<Measure> operator*(PdfDiscrete selection, Pdf<Measure> pdf) {
  return Pdf<Measure>(selection.value * pdf.value);
}
inline PdfDiscrete operator*(PdfDiscrete a, PdfDiscrete b) {
  return PdfDiscrete(a.value * b.value);
}

// Density in area at a surface point, as one in solid angle at the viewer: p_ω = p_A · d² / cosθ, with d the distance
// and `cosTheta` = |cosθ| between the surface normal and the connecting line. 0 for a surface seen edge-on, which
// subtends no solid angle.
inline PdfSolidAngle ToSolidAngle(PdfArea pdf, float distanceSquared, float cosTheta) {
  return PdfSolidAngle(cosTheta > 0 ? pdf.value * distanceSquared / cosTheta : 0.0f);
}

// dω/dA = cosθ / d² (sr/m²): p_A = p_ω · dω/dA ([Veach97 §8.2.2.2]). 0 at distance 0.
inline float SolidAngleToArea(float distanceSquared, float cosTheta) {
  return distanceSquared > 0 ? cosTheta / distanceSquared : 0.0f;
}
inline PdfArea ToArea(PdfSolidAngle pdf, float solidAngleToArea) {
  return PdfArea(pdf.value * solidAngleToArea);
}

// Densities along a path, in double: they are multiplied, and the densities of a light of 1e-6 m are 1e12. A delta
// distribution has no density; its `value` is the coefficient of the delta, in the measure in which its path is
// compared.
template <class Measure>
struct Density {
  double value = 0;

  Density() = default;
  constexpr explicit Density(double v) : value(v) {}
  explicit Density(Pdf<Measure> pdf) : value(static_cast<double>(pdf.value)) {}

  friend Density operator*(double s, Density a) { return Density(s * a.value); }
  // Ratio of two techniques' densities of the same sample; 0 if the first cannot generate it.
  friend double operator/(Density a, Density b) { return a.value == 0 ? 0.0 : a.value / b.value; }
};

using SolidAngleDensity = Density<measure::SolidAngle>;
using AreaDensity = Density<measure::Area>;
using AreaPairDensity = Density<measure::AreaPair>;

inline AreaPairDensity operator*(AreaDensity a, AreaDensity b) {
  return AreaPairDensity(a.value * b.value);
}
// Density of one point given the other; 0 if the pair has no density.
inline AreaDensity operator/(AreaPairDensity pair, AreaDensity other) {
  return AreaDensity(pair.value == 0 ? 0.0 : pair.value / other.value);
}

// dω/dA = cosθ / d² with θ at the other point: converts a density in solid angle at one point to one in area at the
// other.
struct SolidAnglePerArea {
  double value = 1;
};
inline AreaDensity operator*(SolidAngleDensity density, SolidAnglePerArea edge) {
  return AreaDensity(density.value * edge.value);
}

}  // namespace lampyr
