// A pass of camera and light paths, with the photons that it gathers and leaves.
#pragma once

#include "render/pass.h"

namespace lampyr {

// The shutter time and the wavelengths that all paths of a pass with photons share, in scenes with motion. A photon
// lies where the surface was at the time of its path, so that only paths of the same time may gather it. `wavelengths`
// is the number that the wavelengths are chosen by. Times and wavelengths of consecutive passes are stratified
// together, whatever the sampler of the pixels: what a moving object shows or covers for a part of the shutter has all
// of the spectrum. `pass`: index in the render.
//
// The stages of an adaptive render (`allocation`) share a sequence that begins with its first pass. Each of them is an
// aligned block of it, which Owen scrambling puts in random order: given the times of earlier stages, which the rates
// depend on, all passes of a stage have the same distribution of times. What a stage adds to a pixel has therefore an
// expectation that does not depend on the rates, and over all earlier times that is the pixel's.
struct SharedByPass {
  float time = 0, wavelengths = 0;  // in [0, 1)

  SharedByPass(uint64_t seed, const SampleAllocation* allocation, uint32_t pass);
};

RenderCounts TraceBothPaths(const Pass& pass, PhotonStore* kept);

}  // namespace lampyr
