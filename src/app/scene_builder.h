// From a scene's description to what an integrator renders: shapes placed and built, lights made, materials resolved.
#pragma once

#include "app/render_settings.h"
#include "integrators/integrator.h"

namespace lampyr {

struct BuiltScene {
  RenderSettings settings;
  RenderScene scene;
};

// Throws located Errors for what cannot be rendered. `robust`: watertight intersection.
//
// Render space is world space moved so that the scene's middle lies near the origin, where floats are dense; a scene
// that is there already is not moved.
BuiltScene BuildScene(const SceneDescription& description, const RenderOverrides& overrides, bool robust,
                      Diagnostics& diagnostics);

}  // namespace lampyr
