// Warns of a surface so large that the rounding of points on it is coarser than what the camera resolves.
#pragma once

#include "base/error.h"
#include "integrators/walk/integrator.h"
#include "render/settings/render_settings.h"

namespace lampyr {

// Points on a surface have an error in proportion to its size: on a plane of a million metres they are rounded to
// decimetres. Tested in the middle of the image. Large surfaces that are far away, such as a sky of triangles, are
// exempt.
void WarnOfCoarsePlaces(const RenderScene& scene, const RenderSettings& settings, Diagnostics& diagnostics);

}  // namespace lampyr
