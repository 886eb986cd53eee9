// Estimates the brightest sample that a render may not have met yet.
#pragma once

#include "base/error.h"
#include "integrators/walk/integrator.h"
#include "render/settings/render_settings.h"

namespace lampyr {

// Film luminance of the brightest light that illuminates a smooth or nearly smooth surface. A path that finds the light
// over such a surface does so by chance, and is then as bright as the light. 0 if none was found: all other paths to
// lights are also sampled from the lights and weighted down. Found by light paths and, for objects that are small
// against the scene, by camera paths; takes some ten milliseconds.
double LargestUnseenSample(const RenderScene& scene, const RenderSettings& settings);

// Points on a surface have an error in proportion to its size: on a plane of a million metres they are rounded to
// decimetres. Tested in the middle of the image. Large surfaces that are far away, such as a sky of triangles, are
// exempt.
void WarnOfCoarsePlaces(const RenderScene& scene, const RenderSettings& settings, Diagnostics& diagnostics);

}  // namespace lampyr
