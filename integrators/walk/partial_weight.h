// Partial weights of bidirectional techniques, carried along subpaths so that a connection costs the same however long
// its path is ([Georgiev12 §4], dVCM, dVC and dVM there).
//
// A path x_0 … x_k, light first, can be made by techniques s: s vertices by a subpath from the light, the rest from the
// camera. With p_s the density of technique s, F_i that of vertex i (area) when it is sampled from the light's side,
// and B_i from the camera's,
//   p_s / p_(s+1) = B_s / F_s                                    (1)
// and the weight of s is 1 / (1 + Σ_(i≠s) (p_i / p_s)^β) ([Georgiev12 eq. 37]). A vertex x_j of a light subpath knows
// all but the last two reverse densities B_j and B_(j-1), which depend on what it is connected to:
//   Σ_(i≤j) (p_i / p_(j+1))^β = B_j^β · (connect + B_(j-1)^β · earlier).
// The same holds from the camera's side with F and B exchanged.
//
// Merging at x_j, where a photon of any of the N light paths lies within the radius r of the camera's vertex, has the
// density p_(j+1) · B_j · N π r²: with merge = (N π r²)^β each vertex that can be merged at adds the term
// B_j^β · merge, which the recursion carries on like the others.
//
// Departures from [Georgiev12]: β is 2, not 1. The light's end is exact for selection that depends on the receiver: the
// first weight of a light subpath is made where it lands (AtLanding). The part that merging multiplies is kept apart,
// because the radius of the pass in which photons are gathered is not that of the pass in which they were traced.
//
// Russian roulette is in no density: it is in the throughput of both subpaths alone, so that weights do not depend on
// it.
//
// A delta is never connected to: the technique is not there, and the term is 0. Its two densities, discrete
// probabilities with the same delta beside them, occur in every technique that remains, one or the other: the delta
// cancels, up to the ratio in which refraction changes solid angles (DensitiesOf).
#pragma once

#include <cstdint>

#include "integrators/walk/mis.h"
#include "materials/scattering.h"

namespace lampyr {

// The light's end of a path, as the first surface vertex sees it. Densities are with the probability of the light.
struct LightEnd {
  uint32_t light = 0;
  AreaPairDensity emission;             // of the light's point and the first surface vertex, by emission
  AreaDensity position;                 // of the light's point alone, by emission; 0: not on a surface
  AreaDensity direct;                   // of the light's point, by next-event estimation
  SolidAnglePerArea solidAnglePerArea;  // from the first surface vertex to the light's point
  bool canBeHit = false;                // by directions that surfaces sample
};

// The last two reverse densities of a subpath: of its last vertex and of the one before.
struct ReverseDensities {
  AreaDensity last, previous;
};

struct PartialWeight {
  double connect = 0, earlier = 0;
  double merging = 0;  // the part of `earlier` that `merge` multiplies: of the vertices before this one

  // Of the first surface vertex of a light subpath ([Georgiev12 eqs. 31–33]). Without `connects`, of merging alone.
  static PartialWeight AtLanding(const LightEnd& end, bool connects) {
    if (!connects) return {};
    const double perEmission = 1 / Mis(end.emission);
    return {Mis(end.direct) * perEmission, end.canBeHit ? perEmission : 0.0, 0.0};
  }
  // Of the vertex that the camera sees, whose density `camera` is over that of the point on the lens. `isSplatted`:
  // light paths that come there are connected to the lens.
  static PartialWeight AtLens(AreaDensity camera, bool isSplatted) {
    return {isSplatted ? 1 / Mis(camera) : 0.0, 0.0, 0.0};
  }

  // Σ (p_i / p)^β over the techniques with fewer vertices on this side, merging at this vertex included.
  double Sum(const ReverseDensities& reverse, double merge) const {
    return Mis(reverse.last) * (merge + BeforeReverse(reverse.previous, merge));
  }
  // The same without this vertex's own reverse density, and without merging at it.
  double BeforeReverse(AreaDensity previousReverse, double merge) const {
    return connect + Mis(previousReverse) * (earlier + merge * merging);
  }

  // Of the next vertex, whose density is `forward`, after the event at this one whose reverse density towards the
  // previous vertex is `previousReverse` ([Georgiev12 eqs. 34–36]). A delta event forbids to connect at this vertex and
  // over the edge to the next, and to merge at this vertex; so may the vertex itself.
  PartialWeight Next(bool isDelta, bool canMerge, AreaDensity forward, AreaDensity previousReverse) const {
    const double inverse = 1 / Mis(forward), reverse = Mis(previousReverse);
    return {isDelta ? 0.0 : inverse, ((isDelta ? 0.0 : connect) + reverse * earlier) * inverse,
            ((isDelta || !canMerge ? 0.0 : 1.0) + reverse * merging) * inverse};
  }
};

// The two densities of a sampled event, towards the next vertex and back to the previous one. For deltas the
// coefficients of a delta over solid angle on the camera's side: refraction stretches solid angles by
// η_l² cosθ_l / (η_c² cosθ_c) on the way from the light's side.
struct EventDensities {
  SolidAngleDensity forward, reverse;
};
inline EventDensities DensitiesOf(const BsdfSample& sample, float cosIn, float cosOut, TransportMode mode) {
  EventDensities densities{SolidAngleDensity(sample.pdfForward), SolidAngleDensity(sample.pdfReverse)};
  if (!sample.isDelta || !sample.isTransmission || !(cosIn > 0) || !(cosOut > 0)) return densities;
  const double stretch = static_cast<double>(sample.eta) * static_cast<double>(sample.eta) *
                         static_cast<double>(cosOut) / static_cast<double>(cosIn);
  // From the light eta is that of the camera's side over that of the light's; from the camera the other way round.
  if (mode == TransportMode::Importance) {
    densities.reverse.value /= stretch;
  } else {
    densities.forward.value *= stretch;
  }
  return densities;
}

}  // namespace lampyr
