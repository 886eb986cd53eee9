// The first look of a comparison: trial renders by all integrators, to choose the one that renders the reference.
#pragma once

#include <vector>

#include "app/compare/compared_scene.h"
#include "app/compare/reference.h"
#include "app/compare/results.h"

namespace lampyr {

// Trial renders by all integrators that blur nothing, by vcm and, where it gathers photons, by "auto"; about `seconds`
// each. Chooses the one with the least error among those that find all light: an integrator whose picture is
// significantly darker than another's, anywhere, is excluded. Photons blur: an integrator that gathers them is chosen
// only if no other finds all light, or if its error, noise and blur together, is at most a third of the noise of the
// best of the others, or if all the others are known not to find some kinds of light (IntegratorHints) and in a render
// of `referenceSeconds` may miss more than it blurs; only a blur that is significantly above 0 counts there. If the
// pilot of "auto" has found such light, its error may be up to twice that of the others.
std::vector<Pilot> FlyPilots(const ComparedScene& scene, double seconds, double referenceSeconds,
                             const ReferenceProgress& progress);

}  // namespace lampyr
