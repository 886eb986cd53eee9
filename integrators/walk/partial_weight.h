// Partial weights of bidirectional techniques. They are carried along subpaths, so that weighting a connection takes
// constant time, whatever the length of the path ([Georgiev12 §4]; dVCM and dVC there).
//
// A path x_0 … x_k, ordered from the light, is made by technique s if its first s vertices are sampled from the light
// and the rest from the camera. With p_s the density of technique s, F_i the area density of vertex i when it is
// sampled from the light's side, and B_i from the camera's,
//   p_s / p_(s+1) = B_s / F_s                                    (1)
// and the weight of s is 1 / (1 + Σ_(i≠s) (p_i / p_s)^β) ([Georgiev12 eq. 37]). A vertex x_j of a light subpath knows
// all of this but the last two reverse densities B_j and B_(j-1), which depend on the vertex that it is connected to:
//   Σ_(i≤j) (p_i / p_(j+1))^β = B_j^β · (last + B_(j-1)^β · earlier).
// The same holds from the camera's side with F and B exchanged. The sum has two parts, which are carried apart: the
// techniques at the ends of the path (s = 0, s = 1, t = 1), and the connections of two subpaths, which a pixel may make
// more rarely than there are light paths (technique_counts.h).
//
// With n light paths for each camera path, LightEnd::emission is n times the density of one. A splat (t = 1) has a
// sample count of its own, because it is spread over all pixels in whose filter it is.
//
// Merging is not carried: its terms depend on the whole path, and take time in proportion to its length
// (bidirectional/path_densities.h).
//
// Departures from [Georgiev12]: β is 2, not 1. Selection of lights may depend on the receiver and is weighted exactly:
// the first partial weight of a light subpath is made at its first hit (AtFirstHit), which is the receiver.
//
// Survival probabilities of Russian roulette enter the throughput of both subpaths and no density, so that weights do
// not depend on them.
//
// A vertex with a delta event cannot be connected: the technique does not exist, and its term is 0. The two densities
// of the event, forward and reverse, are discrete probabilities times the same delta distribution. Each of the
// remaining techniques has one of the two, so the delta cancels, up to the ratio by which refraction changes solid
// angles (DensitiesOf).
#pragma once

#include <cstdint>

#include "materials/scattering.h"
#include "math/density.h"
#include "math/wide_float.h"

namespace lampyr {

// (p_i / p)^β, the term of technique i in the denominator of a weight, for the ratio p_i / p of its density to that of
// the technique being weighted. Applied to a density, the factor of that density in such a term.
inline double Mis(double ratio) {
  return ratio * ratio;
}
template <class Measure>
double Mis(Density<Measure> density) {
  return density.value * density.value;
}

// Weight of a sample drawn with density `own`, against one other technique. Computed from the ratio, because densities
// of tiny lights leave the range of float when squared.
inline float PowerHeuristic(PdfSolidAngle own, PdfSolidAngle other) {
  if (own.value <= 0) return 0;
  const float ratio = other.value / own.value;
  return 1.0f / (1.0f + ratio * ratio);
}

// Sample count of next-event estimation in the weights of a path with this many surface vertices. Samples of a light
// differ less among each other than photons and rays that happen to meet it, which densities do not tell ([Grittmann19]
// has the exact factor). Only direct light can have another count than 1: partial weights hold the term of next-event
// estimation apart (ends.last) at the first vertex of a light path only. Measured with 1, 2 and 4 in six scenes, vcm: 2
// is 1.07 × as efficient as 1 on average, and nowhere less.
constexpr double NextEventCount(size_t surfaceVertices) {
  return surfaceVertices == 1 ? 2.0 : 1.0;
}
static_assert(NextEventCount(2) == 1 && NextEventCount(3) == 1);

// Densities at the light's end of a path, for its first surface vertex as receiver. They include the selection
// probability of the light.
struct LightEnd {
  uint32_t light = 0;
  AreaPairDensity emission;  // of the light's point and the first surface vertex, by emission
  AreaDensity position;      // of the light's point alone, by emission; 0: not on a surface that can be hit
  AreaDensity direct;        // of the light's point, by next-event estimation
  // dω/dA from the first vertex to the light's point, times the factor of media on the way (EdgeFactors).
  SolidAnglePerArea solidAnglePerArea;
  bool canBeHit = false;  // rays that surfaces scatter can hit the light
  // The measure of `emission`, besides the area of the first surface vertex.
  enum class Extent : uint8_t { Point, Surface, Sky };  // nothing, the area of the light's point, its direction
  Extent extent = Extent::Point;
};

// Densities of a vertex of a subpath, for weights that need all vertices of a path.
struct SubpathDensities {
  double forward = 0;  // by its own subpath, 1/m²; of the first vertex of a light path: LightEnd::emission
  double reverse = 0;  // by the other one; valid once the next vertex has scattered
  // In a medium: MergeVolume. Valid once there is a next vertex.
  WideFloat mergeVolume = {};
  bool forwardIsDelta = false;  // a delta event finds the vertex: the density is a coefficient
  bool canMerge = false;        // with the event by which the subpath goes on; valid once there is a next vertex
  bool reverseIsDelta : 1 = false;
  bool isInMedium : 1 = false;                        // densities are per volume
  LightEnd::Extent extent = LightEnd::Extent::Point;  // of the first vertex of a light path
};
static_assert(sizeof(SubpathDensities) == 24, "kept for the vertices of millions of photons");

// Densities and flags of the two ends of a path, for sums over all its techniques (TechniqueSums).
struct PathEnds {
  double direct = 0, hit = 0;  // of the light's point: by next-event estimation, and by a camera path; 0: impossible
  bool firstIsDelta = false;   // the event at vertex 1
  double splatCount = 0;       // of t = 1; 0: it does not exist
  bool canBeHit = false;       // the light; `hit` may be unknown yet
  double flightRatio = 0;      // FlightPoints::RatioAt of the vertex that the camera sees
  bool isOfFlight = false;     // t = 1 has made the path, by a point of a flight

  // Stored as the record before those of the path's vertices: one index per photon finds both.
  SubpathDensities Packed() const {
    return {.forward = direct, .reverse = hit, .forwardIsDelta = firstIsDelta, .canMerge = canBeHit};
  }
  static PathEnds Unpacked(const SubpathDensities& packed) {
    return {packed.forward, packed.reverse, packed.forwardIsDelta, 0, packed.canMerge};
  }
};

// The last two reverse densities of a subpath: of its last vertex and of the one before.
struct ReverseDensities {
  AreaDensity last, previous;
};

// A sum over techniques, for the vertex that it is carried to.
struct PartialSum {
  double last = 0, earlier = 0;

  double Before(AreaDensity previousReverse) const { return last + Mis(previousReverse) * earlier; }
  // The terms of `this` at the next vertex, and `nextLast` of the technique that ends here.
  PartialSum Next(bool isDelta, double nextLast, double inverse, double reverse) const {
    return {nextLast, ((isDelta ? 0.0 : last) + reverse * earlier) * inverse};
  }
};

// Sums over the techniques with fewer vertices on one side: those at the path's ends, and connections.
struct TechniqueTerms {
  double ends = 0, connections = 0;

  // All terms, for a technique at the ends or merging. `connectionCount`: connections per light path, squared.
  double ForEnds(double connectionCount) const { return ends + connectionCount * connections; }
  // For a connection. `merging`: the terms of merging, relative to one connection per light path.
  double ForConnection(double connectionCount, double merging) const {
    return connections + (ends + merging) / connectionCount;
  }
  TechniqueTerms operator+(const TechniqueTerms& other) const {
    return {ends + other.ends, connections + other.connections};
  }
};

struct PartialWeight {
  PartialSum ends, connections;

  // Partial weight at the first hit of a light subpath ([Georgiev12 eqs. 31–33]). Without `connects`: for merging
  // alone.
  static PartialWeight AtFirstHit(const LightEnd& end, bool connects) {
    if (!connects) return {};
    const double perEmission = 1 / Mis(end.emission);
    return {{Mis(end.direct) * perEmission, end.canBeHit ? perEmission : 0.0}, {}};
  }
  // Partial weight at the first vertex of a camera subpath. `camera`: density of the vertex by a camera ray, over that
  // of the lens point (DensityAtLens). `splatCount`: 0 if light paths that reach the vertex are not connected to the
  // lens.
  static PartialWeight AtLens(AreaDensity camera, double splatCount) {
    return {{splatCount > 0 ? Mis(splatCount / camera.value) : 0.0, 0.0}, {}};
  }

  // The partial weight at the first vertex of a camera subpath, with the term of splats of sampled flight points added.
  // `ratio`: FlightPoints::RatioAt.
  PartialWeight WithFlights(double ratio) const {
    PartialWeight counted = *this;
    counted.ends.last *= 1 + Mis(ratio);
    return counted;
  }
  // The partial weight of a light subpath, with next-event estimation counted as in a path of this many surface
  // vertices.
  PartialWeight WithNextEvents(size_t surfaceVertices) const {
    PartialWeight counted = *this;
    counted.ends.last *= Mis(NextEventCount(surfaceVertices));
    return counted;
  }

  // Σ (p_i / p)^β over the techniques with fewer vertices on this side, merging left out.
  TechniqueTerms Sum(const ReverseDensities& reverse) const {
    const TechniqueTerms before = BeforeReverse(reverse.previous);
    const double last = Mis(reverse.last);
    return {last * before.ends, last * before.connections};
  }
  // The sum without the factor of this vertex's own reverse density.
  TechniqueTerms BeforeReverse(AreaDensity previousReverse) const {
    return {ends.Before(previousReverse), connections.Before(previousReverse)};
  }

  // Partial weight at the next vertex ([Georgiev12 eqs. 34–36]). `forward`: density of the next vertex.
  // `previousReverse`: reverse density of the previous vertex, by the event at this one. A delta event rules out
  // connections at this vertex and over the edge to the next one.
  PartialWeight Next(bool isDelta, AreaDensity forward, AreaDensity previousReverse) const {
    const double inverse = 1 / Mis(forward), reverse = Mis(previousReverse);
    return {ends.Next(isDelta, 0, inverse, reverse),
            connections.Next(isDelta, isDelta ? 0.0 : inverse, inverse, reverse)};
  }
};

// Densities of a sampled scattering event, forward to the next vertex and reverse to the previous one. For deltas: the
// coefficients of a delta over solid angle on the camera's side. Refraction scales solid angles by η_l² cosθ_l / (η_c²
// cosθ_c) from the light's side to the camera's.
struct EventDensities {
  SolidAngleDensity forward, reverse;
};
inline EventDensities DensitiesOf(const BsdfSample& sample, float cosIn, float cosOut, TransportMode mode) {
  EventDensities densities{SolidAngleDensity(sample.pdfForward), SolidAngleDensity(sample.pdfReverse)};
  if (!sample.isDelta || !sample.isTransmission || !(cosIn > 0) || !(cosOut > 0)) return densities;
  const double stretch = static_cast<double>(sample.eta) * static_cast<double>(sample.eta) *
                         static_cast<double>(cosOut) / static_cast<double>(cosIn);
  // eta is the index of the side that the path enters over that of the side it leaves: η_c / η_l on light subpaths, η_l
  // / η_c on camera subpaths.
  if (mode == TransportMode::Importance) {
    densities.reverse.value /= stretch;
  } else {
    densities.forward.value *= stretch;
  }
  return densities;
}

}  // namespace lampyr
