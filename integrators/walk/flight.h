// Participating media along the edges of paths: where a walk collides, what of the light a connection loses, and the
// factors of both on densities.
//
// In a homogeneous medium transmittance and density of a distance are known. In a grid an edge passes null collisions,
// which are vertices of an extended path ([Miller19]): they are sampled from the majorant σ̄ alone, by walks and by
// connections alike, so that the density T̄ Π σ̄ of an edge's null vertices is a factor of every technique, and cancels
// in weights. What remains is
//   walk         the mean over the channels of Π (σ_n / σ̄) · σ_t at a vertex that is a collision
//   connection   1
// with Π (σ_n / σ̄) in the value of both. Of a homogeneous medium the product is the transmittance.
//
// A walk samples an edge by one channel, chosen in proportion to the power 3/4 of its throughput, and all channels
// are divided by the density over the choice (balance heuristic, one sample; [Wilkie14]). The throughput then stays
// bounded: chosen evenly, the densest of three channels would be multiplied by 3 or by almost 0 at each collision. In
// proportion to the throughput itself, the variance of the sum would be least; but a channel with a hundredth of the
// throughput of the others would be noisy: behind a red wall, in a fog that is a hundred times as dense for red, the
// relative second moment of blue is then 48 at a collision, and 16 with the power 3/4.
// Weights need a density that follows from the path alone, whoever made it, and take the mean over the channels.
//
// A medium without scattering makes no collisions: its transmittance is a factor of the value alone.
#pragma once

#include <optional>
#include <span>

#include "geometry/fine_line.h"
#include "integrators/walk/integrator.h"

namespace lampyr {

inline double MeanOf(const Color& a) {
  return (static_cast<double>(a.r) + static_cast<double>(a.g) + static_cast<double>(a.b)) / 3;
}

// Factors of an edge on area densities (EdgeDensity), by what a walk along it collides with.
struct EdgeFactors {
  double forward = 1;  // of the edge's end, by a walk from its start
  double reverse = 1;  // of its start, by a walk from its end
  double through = 1;  // probability that a walk does not collide in between

  EdgeFactors Reversed() const { return {reverse, forward, through}; }
};

// A part of a line in one medium.
struct MediumSpan {
  double tMin, tMax;
  int32_t medium;
  Color tint{1.0f};  // of the surfaces before it
};

// A part of a ray in one medium, with one extinction or up to the next null collision of a grid.
struct BeamStep {
  float tMin = 0, tMax = 0;
  int32_t medium = kVacuum;
  Color transmittance, density;  // at tMin: factor on the value of a path, and per channel on the density of a walk
  Color extinction;              // of a homogeneous medium, 1/scene unit; 0 in a grid
  bool scatters = true;

  // Both at t, in [tMin, tMax].
  Color TransmittanceAt(float t) const;
  Color DensityAt(float t) const;
};

// A point of a beam.
struct BeamPoint {
  Color passed;        // factor on the throughput up to there, over the probability that the walk gets there
  Color density;       // that probability, by the channel that samples the distance
  double through = 1;  // their mean
};

// The probabilities of the channels by which a walk samples a distance: in proportion to the power 3/4 of its throughput.
Color ChannelsOf(const Color& throughput);
// A density over the choice of the channel. `density`: by channel.
inline double OverChannels(const Color& channels, const Color& density) {
  return static_cast<double>(channels.r) * static_cast<double>(density.r) +
         static_cast<double>(channels.g) * static_cast<double>(density.g) +
         static_cast<double>(channels.b) * static_cast<double>(density.b);
}

// A point of a medium on a ray, as a walk that collided there would have it.
struct MediumPoint {
  Point3d position{0.0};  // beyond float
  const Medium* medium = nullptr;
  int32_t index = kVacuum;  // of the medium
  MediumCoefficients coefficients;
  Color transmittance;  // from the start of the ray, surfaces included
  EdgeFactors factors;  // of the edge
};

// Result of a walk along one ray: the surface hit or the collision, with the factors of the media passed.
struct Flight {
  bool isHit = false;  // a surface; `hit` is set, also if the walk collides before it
  RayHit hit;
  const Medium* collidesWith = nullptr;  // null: none
  int32_t medium = kVacuum;              // in which the flight ends: of the collision, or before the surface
  float t = kInfinity;                   // of the end
  Point3d end{0.0};                      // beyond float; not set if the ray escapes
  MediumCoefficients coefficients;       // at the collision
  Color passed{1.0f};                    // factor on the throughput: tints, and transmittance over its density
  EdgeFactors factors;
  Color channels{1.0f / 3};  // ChannelsOf the throughput with which the flight begins
  Color emission;            // radiance of media on the way, at the start of the ray; an estimate
  FineLine line;
  // The parts of the line in media up to the surface, in order, whether the walk collides or not; valid until the next
  // flight of the thread.
  std::span<const MediumSpan> spans;
  // The parts of the ray up to t that are in media, in order; valid until the next flight of the thread.
  std::span<const BeamStep> beam;
  std::span<const Crossing> crossings;  // valid as long
  Color startExtinction{1.0f};          // of the vertex at which the ray starts

  // Factor of the surfaces that the ray has passed before `end`.
  Color TintBefore(double end) const;
  // The point of the beam at `at`; nullopt: it is not in `inMedium`.
  std::optional<BeamPoint> PointAt(float at, int32_t inMedium) const;
};

// An end of an edge.
struct EdgeEnd {
  Point3d position{0.0};     // beyond float (PathVertex::Position)
  int32_t medium = kVacuum;  // in which a ray from this end starts; not used at the far end of a ray
  Color extinction{1.0f};    // σ_t at a vertex in a medium, otherwise 1
  bool isFine = false;       // FineLine

  // A vertex in a medium whose mean free path is not far above the rounding of positions.
  static bool IsFineIn(const Color& extinction, const Point3& position) {
    constexpr float kRounding = 0x1p-21f, kOfPath = 1e-4f;
    return extinction.Max() * MaxAbsComponent(position) * kRounding > kOfPath;
  }
};

// Traces a ray from `start`. `throughput`: of the path. `dimension`: sampler dimension of the pair of random numbers
// for distance and channel. `wantsBeam`: Flight::beam is wanted. A ray that is rejected (GeometryScene::RejectedRays)
// carries nothing: Flight::passed is 0.
void Fly(const SampleContext& context, const Ray& ray, uint32_t kinds, const EdgeEnd& start, const Color& throughput,
         uint32_t dimension, bool wantsBeam, Flight& flight);

// The point at `t` of a flight's line. nullopt: nothing scatters there, or no light passes. The transmittance is
// estimated anew, independently of where the walk has collided. `decider`: random bits that decide nothing else.
std::optional<MediumPoint> PointOnFlight(const SampleContext& context, const Flight& flight, double t,
                                         uint64_t decider);

// Estimates the transmittance of a connecting ray, surfaces included, and sets the factors of its edge, both from the
// start of the ray. The position of `end` is not looked at if the ray is infinite. `decider`: random bits of the
// connection that decide nothing else.
Color TransmittanceOf(const SampleContext& context, const Ray& ray, uint32_t kinds, const EdgeEnd& start,
                      const EdgeEnd& end, uint64_t decider, EdgeFactors& factors);

// Traces a ray through `end` to the surface that it meets, past cut-outs and thin surfaces at random, as a walk does.
// `passed` becomes the tints of these times the transmittance of media. False: it meets nothing.
bool TransmittanceToHit(const SampleContext& context, const Ray& ray, uint32_t kinds, const EdgeEnd& start,
                        const EdgeEnd& end, uint64_t decider, RayHit& hit, Color& passed, EdgeFactors& factors);

}  // namespace lampyr
