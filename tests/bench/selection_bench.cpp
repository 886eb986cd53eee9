// What the ways to select lights are worth: noise and CPU time of whole renders. `efficiency` is 1/(MSE × seconds), of
// pixels that see no light directly; `gain` is it in units of what `power` has.
#include <benchmark/benchmark.h>

#include <filesystem>
#include <map>

#include "support/selection_noise.h"

namespace lampyr::test {
namespace {

struct ManyLightScene {
  const char* name;
  std::string file;
  int size, samplesPerPixel, renders;
};

const ManyLightScene kScenes[] = {
    {"lights600", std::string(LAMPYR_SHARED_DATA) + "/peer/lights600.pbrt", 64, 512, 8},
    {"rooms", std::string(LAMPYR_SOURCE_DIR) + "/scenes/rooms.pbrt", 64, 256, 6},
    {"area-box", std::string(LAMPYR_SHARED_DATA) + "/peer/area-box.pbrt", 64, 64, 64},
    {"mixed-lights", std::string(LAMPYR_SHARED_DATA) + "/peer/mixed-lights.pbrt", 64, 64, 16},
    {"gallery", std::string(LAMPYR_SOURCE_DIR) + "/scenes/gallery.pbrt", 64, 32, 16},
    {"still-life", std::string(LAMPYR_SOURCE_DIR) + "/scenes/still-life.pbrt", 64, 32, 16},
    {"lights-1000", std::string(LAMPYR_SOURCE_DIR) + "/scenes/lights-1000.pbrt", 64, 256, 8},
};

void SelectionEfficiency(benchmark::State& state, const ManyLightScene& scene, const std::string& integrator,
                         const std::string& selection) {
  if (!std::filesystem::exists(scene.file)) return state.SkipWithError("the scene is not here");
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  const SceneDescription description = ReadScene(scene.file, diagnostics);
  RenderOverrides overrides;
  overrides.width = overrides.height = scene.size;
  const std::vector<bool> mask = SeesNoLight(description, overrides);
  static std::map<std::string, SelectionNoise> ofPower;
  SelectionNoise noise;
  for (auto _ : state) {
    noise = MeasureSelection(description, mask, integrator, selection, scene.samplesPerPixel, scene.renders, overrides);
    state.SetIterationTime(noise.seconds);
  }
  const std::string key = scene.name + integrator;
  if (selection == "power") ofPower[key] = noise;
  state.counters["mse"] = noise.meanSquaredError;
  state.counters["nsPerSample"] = 1e9 * noise.seconds / (scene.size * scene.size * scene.samplesPerPixel);
  if (ofPower.count(key)) {
    state.counters["mseOfPower"] = noise.meanSquaredError / ofPower[key].meanSquaredError;
    state.counters["timeOfPower"] = noise.seconds / ofPower[key].seconds;
    state.counters["gain"] = noise.Efficiency() / ofPower[key].Efficiency();
  }
}

const int registered = [] {
  for (const ManyLightScene& scene : kScenes) {
    for (const char* integrator : {"path", "bdpt"}) {
      for (const char* selection : {"power", "uniform", "tree", "tree4", "learned", "exhaustive"}) {
        const std::string name = std::string("selection/") + scene.name + "/" + integrator + "/" + selection;
        benchmark::RegisterBenchmark(name.c_str(),
                                     [&scene, integrator, selection](benchmark::State& state) {
                                       SelectionEfficiency(state, scene, integrator, selection);
                                     })
            ->Iterations(1)
            ->UseManualTime();
      }
    }
  }
  return 0;
}();

}  // namespace
}  // namespace lampyr::test
