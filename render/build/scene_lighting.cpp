#include "render/build/scene_lighting.h"

#include "lights/selection/fixed_counts.h"
#include "render/analysis/plan.h"

namespace lampyr {

namespace {

void WarnOfFewerSamples(std::span<const PlacedLight> lights, const std::vector<FileLocation>& places,
                        Diagnostics& diagnostics) {
  const std::vector<int> counts = FixedCounts(lights);
  for (size_t i = 0; i < lights.size(); ++i) {
    const int wanted = lights[i].light->Settings().fixedSampleCount;
    if (wanted <= counts[i]) continue;
    diagnostics.Warn(places[i], "\"fixedSampleCount\" " + std::to_string(wanted) + ": " +
                                    (counts[i] > 0 ? "the light has " + std::to_string(counts[i])
                                                   : std::string("the light is selected as those without a count")) +
                                    ", because a point has " + std::to_string(LightChoices::kMost) +
                                    " samples of all lights at most");
  }
}

}  // namespace

void LightScene(LightsToPlace toPlace, SceneMedia& media, Diagnostics& diagnostics, BuiltScene& built) {
  RenderScene& scene = built.scene;
  WarnOfFewerSamples(toPlace.lights, built.lightPlaces, diagnostics);
  toPlace.linking.Finish(toPlace.lights, diagnostics);
  scene.lighting = std::make_shared<const LightingServices>(*scene.geometry, std::move(toPlace.lights),
                                                            built.settings.LightSampler(), std::move(toPlace.linking),
                                                            built.settings.LightSamples(), toPlace.around);
  scene.outputs = MakeOutputPlan(*scene.lighting, built.settings.layers);
  scene.lightMedia.clear();
  scene.lightBackMedia.clear();
  scene.lightStartsVary.clear();
  media.Locate(toPlace.middleOfFilm, built.lightPlaces, scene);
  if (built.settings.integrator != "auto") return;
  const WorkTimer timer;
  ChooseIntegrator(scene, built.settings, toPlace.threads).Apply(built.settings);
  built.choiceTime = timer.Elapsed();
}

}  // namespace lampyr
