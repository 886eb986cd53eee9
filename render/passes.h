// Passes: samples of every pixel, shared among threads.
//
// The picture after n samples per pixel is a pure function of scene, settings and seed: neither the number of threads
// nor the division into passes shows in it.
#pragma once

#include "film/film.h"
#include "integrators/photon/photon_store.h"
#include "integrators/walk/integrator.h"
#include "render/settings/render_settings.h"
#include "render/technique_images.h"

namespace lampyr {

// Samples [first, first + count) of every pixel of the crop, added to the film.
//
// An integrator of camera paths: of each pixel one after the other.
//
// An integrator of light paths: width · height of them, of the full image, are a sample per pixel. They are numbered
// through all of a render, whatever is cropped, and are points of one Sobol sequence.
//
// An integrator of both: a light path for each sample of each pixel of the full image, a camera path for those of the
// crop. What lies in a crop is the same as in the whole, unless something was learned from what is seen. Where the
// integrator gathers photons, each sample is a pass: it uses those that the sample before has left. `kept` is what one
// call leaves to the next; without it, or where it does not continue, the light paths of the sample before are traced
// again. In scenes with motion all paths of such a pass have one time, and its photons are of light paths of that time.
RenderCounts RenderPass(const RenderScene& scene, const Integrator& integrator, const RenderSettings& settings,
                        const PixelFilter& filter, uint32_t first, uint32_t count, int threads, Film& film,
                        TechniqueImages* techniques = nullptr, PhotonStore* kept = nullptr);

}  // namespace lampyr
