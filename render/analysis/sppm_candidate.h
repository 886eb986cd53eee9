// The error and the cost of progressive photon mapping, as a candidate of the pilot.
//
// Its photons are not weighted against other techniques, so that its error does not follow from the pilot's other
// paths. It is measured instead: in passes of its own, two at a time with the same pixels of the image, whose
// difference is noise.
#pragma once

#include <optional>

#include "render/analysis/pilot_records.h"

namespace lampyr::pilot {

// `scene`: with the guide of light paths that the render will have, and the lights that it chooses at a vertex;
// `counted`: the same with the wavelengths of a pass. `records`: after Records::SetErrors. None: sppm cannot render the
// scene. `best`: of the others; may be null. `passCount`: of the pilot.
std::optional<PilotCandidate> SppmCandidate(const RenderScene& scene, const RenderScene& counted,
                                            const RenderSettings& settings, const Grid& grid, const Records& records,
                                            const PilotCandidate* best, int passCount, int threads);

}  // namespace lampyr::pilot
