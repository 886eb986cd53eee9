// The weights of bidirectional techniques, carried along subpaths so that a connection costs the same however long the
// path is ([Georgiev12 §4]; the recursion is arranged anew, and the light's end of it is exact for selection that
// depends on the receiver).
//
// A path x_0 … x_k, light first, can be made by techniques s: s vertices by a subpath from the light, the rest from the
// camera. With p_s the density of technique s, F_i that of vertex i (area) when it is sampled from the light's side,
// and B_i from the camera's,
//   p_s / p_(s+1) = B_s / F_s                                    (2)
// and the weight of s is 1 / (1 + Σ_(i≠s) (p_i / p_s)^β). A vertex x_j of a light subpath knows all but the last two
// reverse densities B_j and B_(j-1), which depend on what it is connected to:
//   Σ_(i≤j) (p_i / p_(j+1))^β = B_j^β · (connect + B_(j-1)^β · earlier).
// The same holds from the camera's side with F and B exchanged.
//
// Merging at x_j, where a photon of any of the N light paths lies within the radius r of the camera's vertex, has the
// density p_(j+1) · B_j · N π r² ([Georgiev12 eq. 22]): with merge = (N π r²)^β each vertex that can be merged at adds
// the term B_j^β · merge, which the recursion carries on like the others. It is kept apart, because the radius of the
// pass that photons are gathered in is not that of the pass in which they were traced. Without merging, merge is 0.
//
// Russian roulette is in no density: it is in the
// throughput of both subpaths alone, so that weights do not depend on it.
//
// A delta is never connected to: the technique is not there, and the term is 0. Its two densities, discrete
// probabilities with the same delta beside them, occur in every technique that remains, one or the other: the delta
// cancels, up to the ratio in which refraction changes solid angles (ReverseOfDelta).
//
// In double: densities of lights of 1e-6 m are 1e12, and their squares multiply along a path.
#pragma once

#include "materials/scattering.h"

namespace lampyr {

// The power heuristic with β = 2 ([Veach97 §9.2.4]).
inline double Mis(double ratio) {
  return ratio * ratio;
}

struct PartialWeight {
  double connect = 0, earlier = 0;
  double merging = 0;  // what `merge` multiplies: of the vertices before this one

  // Σ (p_i / p)^β over the techniques with fewer vertices on this side, merging at this vertex included.
  double Sum(double pdfReverse, double pdfPreviousReverse, double merge) const {
    return Mis(pdfReverse) * (merge + BeforeReverse(pdfPreviousReverse, merge));
  }
  // The same without this vertex's own reverse density, and without merging at it.
  double BeforeReverse(double pdfPreviousReverse, double merge) const {
    return connect + Mis(pdfPreviousReverse) * (earlier + merge * merging);
  }

  // Of the next vertex, whose density (area) is pdfForward, after the event at this one whose reverse density towards
  // the previous vertex is pdfPreviousReverse (area). A delta event forbids to connect at this vertex and over the edge
  // to the next, and to merge at this vertex; so may the vertex itself.
  PartialWeight Next(bool isDelta, bool canMerge, double pdfForward, double pdfPreviousReverse) const {
    const double inverse = 1 / Mis(pdfForward), reverse = Mis(pdfPreviousReverse);
    return {isDelta ? 0.0 : inverse, ((isDelta ? 0.0 : connect) + reverse * earlier) * inverse,
            ((isDelta || !canMerge ? 0.0 : 1.0) + reverse * merging) * inverse};
  }
};

// From solid angle at a point to area at another: |cosθ| there over the squared distance. A cosine is known to rounding
// only: the smallest that counts is the same for every technique.
inline double AreaPerSolidAngle(float cosTheta, double distanceSquared) {
  constexpr double kSmallestCosine = 1e-6;
  const double cosine = cosTheta < 0 ? -static_cast<double>(cosTheta) : static_cast<double>(cosTheta);
  return (cosine > kSmallestCosine ? cosine : kSmallestCosine) / distanceSquared;
}

// The two densities of a sampled event, towards the next vertex and back to the previous one, per solid angle. For
// deltas the coefficients of a delta over solid angle on the camera's side: refraction stretches solid angles by
// η_l² cosθ_l / (η_c² cosθ_c) on the way from the light's side.
struct EventDensities {
  double forward, reverse;
};
inline EventDensities DensitiesOf(const BsdfSample& sample, float cosIn, float cosOut, TransportMode mode) {
  EventDensities densities{static_cast<double>(sample.pdfForward.value), static_cast<double>(sample.pdfReverse.value)};
  if (!sample.isDelta || !sample.isTransmission || !(cosIn > 0) || !(cosOut > 0)) return densities;
  const double stretch = static_cast<double>(sample.eta) * static_cast<double>(sample.eta) *
                         static_cast<double>(cosOut) / static_cast<double>(cosIn);
  // From the light eta is that of the camera's side over that of the light's; from the camera the other way round.
  if (mode == TransportMode::Importance) {
    densities.reverse /= stretch;
  } else {
    densities.forward *= stretch;
  }
  return densities;
}

}  // namespace lampyr
