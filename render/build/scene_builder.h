// Builds the scene that integrators render from its description: places shapes, makes lights, resolves materials.
#pragma once

#include "base/work_timer.h"
#include "integrators/walk/integrator.h"
#include "lights/scene_light.h"
#include "lights/types/type_registry.h"
#include "render/settings/render_settings.h"

namespace lampyr {

struct BuiltScene {
  RenderSettings settings;
  RenderScene scene;
  // From render space to the space of the layers of what is seen first (RenderSettings::firstHit; world without it),
  // and from there to the camera's at the start of the shutter.
  Affine renderToLayers, layersToCamera;
  // Names by GeometryAttributes::object and ::material; empty where no layer asks for them.
  std::vector<std::string> objectNames, materialNames;
  // Locations of the lights and the light filters in the scene file, by their indices.
  std::vector<FileLocation> lightPlaces, filterPlaces;
  WorkTime choiceTime;  // that "auto" took to choose the integrator; 0 if it was set

  // The layers of a film that has all that the settings ask for: of light, and of bands of the spectrum.
  std::vector<std::string> FilmLayers() const;
};

// Throws located Errors for what cannot be rendered. `robust`: watertight intersection. `types`: the types of lights
// and filters, used only during the call.
//
// Render space is world space, translated so that the scene's middle lies near the origin, where floats are dense. A
// scene that is near the origin already is not moved.
BuiltScene BuildScene(const SceneDescription& description, const RenderOverrides& overrides, bool robust,
                      Diagnostics& diagnostics, const TypeRegistry& types = TypeRegistry::BuiltIn());

// The same, and fills `kept` with what it takes to light the scene again, with other lights (scene_lighting.h).
struct KeptLighting;
BuiltScene BuildScene(const SceneDescription& description, const RenderOverrides& overrides, bool robust,
                      Diagnostics& diagnostics, const TypeRegistry& types, KeptLighting& kept);

// The first, and fills `lights` with what checking each light of the scene requires.
BuiltScene BuildScene(const SceneDescription& description, bool robust, Diagnostics& diagnostics,
                      std::vector<SceneLight>& lights, const TypeRegistry& types = TypeRegistry::BuiltIn());

}  // namespace lampyr
