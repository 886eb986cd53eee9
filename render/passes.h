// Render passes: samples of every pixel, divided among threads.
//
// The picture after n samples per pixel is a pure function of scene, settings and seed. It depends neither on the
// number of threads nor on the division into passes.
#pragma once

#include "film/film.h"
#include "integrators/guide/path_learning.h"
#include "integrators/guide/selection_test.h"
#include "integrators/photon/photon_store.h"
#include "integrators/walk/integrator.h"
#include "render/adaptive_sampling.h"
#include "render/settings/render_settings.h"

namespace lampyr {

class LightEdges;  // light_edges.h

// Adds samples [first, first + count) of every pixel of the crop to the film.
//
// Integrators of camera paths: all samples of one pixel after the other.
//
// Integrators of light paths: width · height light paths of the full image are one sample per pixel. They are numbered
// through the whole render, whatever the crop, and are points of one Sobol sequence.
//
// Integrators of both: one light path for each sample of each pixel of the full image, and one camera path for each of
// the crop. A crop equals that part of the full image, unless something was learned from what the camera sees. If the
// integrator gathers photons, each sample of all pixels is a pass that gathers the photons of the sample before. `kept`
// carries photons from one call to the next; without it, or if it holds those of another sample, the light paths of the
// sample before are traced again. In scenes with motion all paths of such a pass have the same time, and its photons
// come from light paths of that time.
//
// In a scene that carries light by wavelength each sample of all pixels is a pass at wavelengths of its own, and
// photons come from light paths of that pass.
//
// `learning`: receives records of the camera paths; may be null. `selection`: receives tested samples; may be null.
// `edges`: pixels whose samples have several camera rays; may be null.
//
// `allocation`: of the stage of an adaptive film that all of these passes are in; null: one sample for each pixel. The
// samples of a pixel are numbered through the stage. Rates are relative to what the crop sees: a crop of an adaptive
// render is not that part of the full image.
RenderCounts RenderPass(const RenderScene& scene, const Integrator& integrator, const RenderSettings& settings,
                        const PixelFilter& filter, uint32_t first, uint32_t count, int threads, Film& film,
                        PhotonStore* kept = nullptr, const SampleAllocation* allocation = nullptr,
                        PathLearning* learning = nullptr, SelectionTest* selection = nullptr,
                        const LightEdges* edges = nullptr);

}  // namespace lampyr
