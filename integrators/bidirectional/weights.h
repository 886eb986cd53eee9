// MIS weights of bidirectional path tracing and vertex merging: one function per technique, from the partial weights of
// both subpaths ([Veach97 §10.2], [Georgiev12 §4]; the departures from both are in walk/partial_weight.h). The
// integrator calls these functions, and so does the test against explicit densities (full_path.h).
//
// `merging`: Σ (p_i / p)^β over the techniques that merge (PathDensities). `connectionCount`: connections per light
// path in the pixel, squared. `splatCount`: sample count of splats (SplatCount). `nextCount`: NextEventCount of the
// path.
#pragma once

#include "integrators/walk/vertex.h"

namespace lampyr {

// 1 / (1 + Σ (p_i / p)^β) ([Georgiev12 eq. 37]).
inline double WeightAgainst(double others) {
  return 1 / (1 + others);
}

// (0,2): the camera hits a point of a light, which (1,1) also finds. Densities of the point: `position` by emission,
// `camera` by the camera ray.
inline double SeenLightWeight(AreaDensity position, AreaDensity camera, double splatCount) {
  return WeightAgainst(Mis(splatCount * (position / camera)));
}
// (1,1): a point of a light is connected to the lens.
inline double SplatLightWeight(AreaDensity position, AreaDensity camera, double splatCount) {
  return WeightAgainst(Mis(camera / position / splatCount));
}

// The scattering event at the last vertex of a camera subpath that hit a light.
struct LastEvent {
  bool isDelta = false;
  AreaDensity previousReverse;  // reverse density of the vertex before
};
// s = 0, t > 2: the camera subpath hits the light, whose point has the density `hit` ([Georgiev12 eq. 43]).
inline double HitWeight(const LightEnd& end, const PartialWeight& camera, const LastEvent& event, AreaDensity hit,
                        double connectionCount, double nextCount, double merging) {
  const PartialWeight atLight = camera.Next(event.isDelta, AreaDensity(1), event.previousReverse);
  const TechniqueTerms others{atLight.ends.earlier, atLight.connections.earlier};
  const double direct = event.isDelta ? 0.0 : Mis(nextCount * (end.direct / hit));
  return WeightAgainst(direct + Mis(end.emission / hit) * others.ForEnds(connectionCount) + merging);
}

// s = 1, t > 1: the light is sampled at the last vertex of the camera subpath ([Georgiev12 eqs. 44, 45]). `hit`:
// density with which scattering there would find the light's point; 0: it cannot. `previousReverse`: reverse density of
// the vertex before.
inline double NextEventWeight(const LightEnd& end, const PartialWeight& camera, AreaDensity hit,
                              AreaDensity previousReverse, double connectionCount, double nextCount, double merging) {
  const TechniqueTerms others = camera.Sum({end.emission / end.direct, previousReverse});
  return WeightAgainst((Mis(hit / end.direct) + others.ForEnds(connectionCount) + merging) / Mis(nextCount));
}

// s > 1, t > 1: the last vertices of both subpaths are connected ([Georgiev12 eqs. 40, 41]).
inline double ConnectWeight(const PartialWeight& light, const ReverseDensities& ofLight, const PartialWeight& camera,
                            const ReverseDensities& ofCamera, double connectionCount, double merging) {
  return WeightAgainst((light.Sum(ofLight) + camera.Sum(ofCamera)).ForConnection(connectionCount, merging));
}

// s > 1, t = 1: the last vertex of the light subpath is connected to the lens ([Georgiev12 eq. 46]). `reverse`: reverse
// densities of that vertex, by a camera ray, and of the one before. If it is the first vertex, the path is of direct
// light; further on there is no term of next-event estimation to count. `flightRatio`:
// FlightPoints::RatioAt of that vertex. `isOfFlight`: it is a point of a flight, and not a collision.
inline double SplatWeight(const PartialWeight& light, const ReverseDensities& reverse, double connectionCount,
                          double splatCount, double merging, double flightRatio, bool isOfFlight) {
  const double others = (light.WithNextEvents(1).Sum(reverse).ForEnds(connectionCount) + merging) / Mis(splatCount);
  return isOfFlight ? WeightAgainst((1 + others) / Mis(flightRatio)) : WeightAgainst(Mis(flightRatio) + others);
}

// The last vertices of both subpaths are merged ([Georgiev12 eqs. 38, 39]). `light`, `camera`: BeforeReverse of the two
// subpaths. `perDensity`: Merging::perDensity · c at the vertex. `merging`: of merging at the other vertices.
inline double MergeWeight(const TechniqueTerms& light, const TechniqueTerms& camera, double perDensity,
                          double connectionCount, double merging) {
  return WeightAgainst((light + camera).ForEnds(connectionCount) / Mis(perDensity) + merging);
}

}  // namespace lampyr
