// Light that participating media scatter towards the start of a camera ray, from photons in media: the point-beam
// estimate ([Jarosz08]; *point-beam 2D* in [Křivánek14]) with a constant kernel on a disk across the ray.
#pragma once

#include "integrators/photon/photon_pass.h"
#include "integrators/walk/walk.h"

namespace lampyr {

class VolumeEstimate {
 public:
  struct Rules {
    int maxDepth = 5;  // scattering events of the whole path
    // 1/sr. Photons from directions that the phase function samples with a higher density are left to camera paths.
    float gatherBelow = 0;
    // Weight for emission guiding of a photon that is seen with a radius of one scene unit: such that photons on
    // surfaces have a comparable one.
    float importance = 1;
  };

  // `lookup`: of the thread.
  VolumeEstimate(const SampleContext& context, const Rules& rules, PhotonLookup& lookup)
      : context_(context), rules_(rules), lookup_(lookup) {}

  // The photons that the ray of `state` passes before it collides or meets a surface, scattered towards its start,
  // times the throughput there. `path`: before that.
  //
  // A ray passes a photon with the probability of not colliding before, by which its value is divided
  // (Flight::PointAt).
  Color Gather(const Subpath& path, const PathState& state, const Flight& flight);

 private:
  // The light of one photon, without flux and kernel; black: the photon is not seen, or is left to camera paths.
  Color Scattered(const PathState& state, int events, const Flight& flight, const BeamHit& hit);

  const SampleContext& context_;
  const Rules rules_;
  PhotonLookup& lookup_;
};

}  // namespace lampyr
