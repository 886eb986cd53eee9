// From a scene's description to what an integrator renders: shapes placed and built, lights made, materials resolved.
#pragma once

#include "integrators/walk/integrator.h"
#include "lights/scene_light.h"
#include "lights/types/type_registry.h"
#include "render/settings/render_settings.h"

namespace lampyr {

struct BuiltScene {
  RenderSettings settings;
  RenderScene scene;
  // Where the scene names its lights and its light filters, by their indices.
  std::vector<FileLocation> lightPlaces, filterPlaces;
};

// Throws located Errors for what cannot be rendered. `robust`: watertight intersection. `types`: what lights there are,
// which is wanted here alone.
//
// Render space is world space moved so that the scene's middle lies near the origin, where floats are dense; a scene
// that is there already is not moved.
BuiltScene BuildScene(const SceneDescription& description, const RenderOverrides& overrides, bool robust,
                      Diagnostics& diagnostics, const TypeRegistry& types = TypeRegistry::BuiltIn());

// The same, and of each light of the scene what checking it takes.
BuiltScene BuildScene(const SceneDescription& description, bool robust, Diagnostics& diagnostics,
                      std::vector<SceneLight>& lights, const TypeRegistry& types = TypeRegistry::BuiltIn());

}  // namespace lampyr
