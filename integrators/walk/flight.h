// Participating media along the edges of paths: where a walk collides, what of the light a connection loses, and the
// factors of both on densities.
//
// In a homogeneous medium transmittance and density of a distance are known. In a grid an edge passes null collisions,
// which are vertices of an extended path ([Miller19]): they are sampled from the majorant σ̄ alone, by walks and by
// connections alike, so that the density T̄ Π σ̄ of an edge's null vertices is a factor of every technique, and cancels
// in weights. What remains is
//   walk         the mean over the channels of Π (σ_n / σ̄) · σ_t at a vertex that is a collision
//   connection   1
// with Π (σ_n / σ̄) in the value of both. Of a homogeneous medium the product is the transmittance. A walk chooses the
// channel by which it samples an edge evenly, so that the mean is the density, and all channels are weighted by it
// (balance heuristic, one sample; [Wilkie14]).
//
// A medium without scattering makes no collisions: its transmittance is a factor of the value alone.
#pragma once

#include "integrators/walk/integrator.h"

namespace lampyr {

// Factors of an edge on area densities (EdgeDensity), by what a walk along it collides with.
struct EdgeFactors {
  double forward = 1;  // of the edge's end, by a walk from its start
  double reverse = 1;  // of its start, by a walk from its end

  EdgeFactors Reversed() const { return {reverse, forward}; }
};

// What a walk meets along a ray.
struct Flight {
  bool isHit = false;  // a surface; `hit` is set, also if the walk collides before it
  RayHit hit;
  const Medium* collidesWith = nullptr;  // null: none
  int32_t medium = kVacuum;              // in which the flight ends: of the collision, or before the surface
  float t = kInfinity;                   // of the end
  MediumCoefficients coefficients;       // at the collision
  Color passed{1.0f};                    // factor on the throughput: tints, and transmittance over its density
  EdgeFactors factors;
  Color emission;  // radiance of media on the way, at the start of the ray; an estimate
};

// Traces a ray that starts in `medium` from a vertex of the extinction `extinction` (1 of what is not in a medium).
// `dimension`: of the sampler, of a pair for the distance and the channel.
void Fly(const SampleContext& context, const Ray& ray, uint32_t kinds, int32_t medium, const Color& extinction,
         uint32_t dimension, Flight& flight);

// The end of a connection.
struct EdgeEnd {
  int32_t medium = kVacuum;  // in which the ray starts; not looked at of the end of the ray
  Color extinction{1.0f};    // 1 of what is not in a medium
};

// Estimates the transmittance of a connecting ray, surfaces included, and sets the factors of its edge, both from the
// start of the ray. `decider`: random bits of the connection that decide nothing else.
Color TransmittanceOf(const SampleContext& context, const Ray& ray, uint32_t kinds, const EdgeEnd& start,
                      const Color& endExtinction, uint64_t decider, EdgeFactors& factors);

}  // namespace lampyr
