// A scene as a whole put somewhere else: the same picture, for the camera goes with it.
#pragma once

#include "scene/scene_description.h"

namespace lampyr::test {

// Everything in the world and the camera, moved by `change`, which may turn, mirror and scale evenly. Lengths that are
// no placements, such as the heights of bumps, and the intensities of points go along: these by the square of the
// scale. Portals and moving things: not supported.
SceneDescription Transformed(const SceneDescription& scene, const Transform& change);

}  // namespace lampyr::test
