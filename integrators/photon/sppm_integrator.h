// Progressive photon mapping ([Hachisuka08], [Hachisuka09]; the radius is a function of the pass alone, as in
// [Knaus11]).
//
// A path from the camera is followed through what is smooth, or nearly, to where light is scattered widely; the light
// that arrives there is sampled, directly, and gathered from photons, indirectly. Which of the two a direction belongs
// to is told by the density with which the BSDF samples it: at every vertex directions of high density are followed,
// and photons that come from the others are gathered. Nothing is counted twice and nothing is missed, whatever lobes a
// material mixes.
//
// Finds all light, caustics seen in mirrors and through glass included. Photons blur it by the radius, which shrinks
// from pass to pass as i^((α - 1) / 2): the error vanishes, the squared one as i^(-α) at best.
//
// Lights with traceLightPaths off are sampled directly and light nothing else.
#pragma once

#include <memory>

#include "integrators/walk/integrator.h"
#include "integrators/walk/shadow_roulette.h"

namespace lampyr {

struct SppmSettings {
  int maxDepth = 5;       // scattering events
  double filmPixels = 1;  // of the full image: light paths per pass
  PhotonSettings photons;
  // Light that comes straight from lights is gathered as well, and lights with traceLightPaths off are lost.
  bool directFromPhotons = false;
  ShadowRays shadowRays;
};

std::unique_ptr<Integrator> MakeSppmIntegrator(const SppmSettings& settings);

}  // namespace lampyr
