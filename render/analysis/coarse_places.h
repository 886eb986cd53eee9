// Surfaces so large that the numbers of a float do not tell apart the places that are looked at.
#pragma once

#include "base/error.h"
#include "integrators/walk/integrator.h"
#include "render/settings/render_settings.h"

namespace lampyr {

// Places on a surface are known to a part of its size: a plain of a million metres is rounded to decimetres. Looked at
// in the middle of the picture; what is large and far away, such as a sky of triangles, is none of it.
void WarnOfCoarsePlaces(const RenderScene& scene, const RenderSettings& settings, Diagnostics& diagnostics);

}  // namespace lampyr
