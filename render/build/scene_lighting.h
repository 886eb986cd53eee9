// The lighting of a scene whose shapes are built: all that depends on its lights. It is made with the scene, and may be
// made again with other lights of the same shapes.
#pragma once

#include <memory>
#include <vector>

#include "render/build/light_table.h"
#include "render/build/scene_builder.h"
#include "render/build/scene_media.h"

namespace lampyr {

// What a scene is lit with.
struct LightsToPlace {
  std::vector<PlacedLight> lights;
  LightLinking linking;  // not finished
  MediaAround around;
  Point2 middleOfFilm{0.0f};  // pixels
  int threads = 0;            // of the choice of an integrator; 0: all
};

// Makes the selection and the services of the lights, the plan of the layers, the media around the lights, and the
// choice of "auto". `built`: with geometry, camera and media; its settings are those that were asked for.
void LightScene(LightsToPlace toPlace, SceneMedia& media, Diagnostics& diagnostics, BuiltScene& built);

// What it takes to light a built scene again. The description and the diagnostics that it was built with have to
// outlive it.
struct KeptLighting {
  RenderSettings settings;  // before "auto" has chosen
  std::vector<PlacedLight> lights;
  std::vector<KeptContext> contexts;  // by light
  LightLinking linking;               // not finished
  MediaAround around;
  Point2 middleOfFilm{0.0f};
  int threads = 0;
  std::unique_ptr<TextureLibrary> textures;
  std::unique_ptr<SceneMedia> media;
};

}  // namespace lampyr
