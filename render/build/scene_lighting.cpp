#include "render/build/scene_lighting.h"

#include <chrono>

#include "render/analysis/plan.h"

namespace lampyr {

void LightScene(LightsToPlace toPlace, SceneMedia& media, Diagnostics& diagnostics, BuiltScene& built) {
  RenderScene& scene = built.scene;
  toPlace.linking.Finish(toPlace.lights, diagnostics);
  scene.lighting = std::make_shared<const LightingServices>(
      *scene.geometry, std::move(toPlace.lights), built.settings.LightSampler(), std::move(toPlace.linking),
      static_cast<int>(built.settings.values.Integer("light-samples")), toPlace.around);
  scene.outputs = MakeOutputPlan(*scene.lighting, built.settings.layers);
  scene.lightMedia.clear();
  scene.lightBackMedia.clear();
  media.Locate(toPlace.middleOfFilm, built.lightPlaces, scene);
  if (built.settings.integrator != "auto") return;
  const auto start = std::chrono::steady_clock::now();
  ChooseIntegrator(scene, built.settings, toPlace.threads).Apply(built.settings);
  built.choiceSeconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace lampyr
