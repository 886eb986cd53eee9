// Comparison of light selections: noise and CPU time of whole renders. `efficiency` is 1/(MSE × seconds), over pixels
// that see no light directly; `gain` is the efficiency relative to that of `power`.
#include <benchmark/benchmark.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>

#include "sampling/rng.h"
#include "sampling/warp.h"
#include "support/selection_noise.h"
#include "support/temporary_folder.h"

namespace lampyr::test {
namespace {

struct ManyLightScene {
  const char* name;
  std::string file;
  int size, samplesPerPixel, renders;
};

const ManyLightScene kScenes[] = {
    {"lights600", std::string(LAMPYR_SHARED_DATA) + "/peer/lights600.pbrt", 64, 128, 12},
    {"rooms", std::string(LAMPYR_SOURCE_DIR) + "/scenes/rooms.pbrt", 64, 64, 6},
    {"area-box", std::string(LAMPYR_SHARED_DATA) + "/peer/area-box.pbrt", 64, 64, 16},
    {"mixed-lights", std::string(LAMPYR_SHARED_DATA) + "/peer/mixed-lights.pbrt", 64, 64, 16},
    {"gallery", std::string(LAMPYR_SOURCE_DIR) + "/scenes/gallery.pbrt", 64, 32, 16},
    {"still-life", std::string(LAMPYR_SOURCE_DIR) + "/scenes/still-life.pbrt", 64, 32, 16},
    {"lights-1000", std::string(LAMPYR_SOURCE_DIR) + "/scenes/lights-1000.pbrt", 64, 128, 8},
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

// A hall with a million small triangles under its ceiling, of which some emit, each its own way: how the cost of a
// sample grows with the emitters alone. With the geometry: what a user sees.
void WriteTriangles(const std::filesystem::path& file, size_t first, size_t count, size_t ofAll) {
  std::ofstream out(file, std::ios::binary);
  out << "ply\nformat binary_little_endian 1.0\nelement vertex " << 3 * count
      << "\nproperty float x\nproperty float y\nproperty float z\nelement face " << count
      << "\nproperty list uchar int vertex_indices\nend_header\n";
  Rng rng(1, first);
  const float size = 2 / std::sqrt(static_cast<float>(ofAll));
  for (size_t i = 0; i < count; ++i) {
    const Point3 p(10 * rng.NextFloat() - 5, 3 + rng.NextFloat(), 10 * rng.NextFloat() - 5);
    for (int corner = 0; corner < 3; ++corner) {
      const Point3 q = p + size * SampleUniformSphere(rng.NextPoint2());
      out.write(reinterpret_cast<const char*>(&q), sizeof q);
    }
  }
  for (int i = 0; i < static_cast<int>(count); ++i) {
    const int indices[3] = {3 * i, 3 * i + 1, 3 * i + 2};
    out.put(3);
    out.write(reinterpret_cast<const char*>(indices), sizeof indices);
  }
}

void TimeSamples(benchmark::State& state, const std::string& text, const std::filesystem::path& folder) {
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  const SceneDescription description = ParseScene(text, (folder / "scene.pbrt").string(), diagnostics);
  const BuiltScene built = BuildScene(description, {}, true, diagnostics);
  constexpr int samplesPerPixel = 64;
  for (auto _ : state) {
    const std::clock_t start = std::clock();
    benchmark::DoNotOptimize(RenderBuilt(built, samplesPerPixel, 2).image.data.data());
    state.SetIterationTime(static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC /
                           (128.0 * 128 * samplesPerPixel));
  }
}

constexpr const char* kHall = R"(LookAt 0 1.5 -4.5  0 0.5 0  0 1 0
Camera "perspective" "float fov" 60
Film "rgb" "integer xresolution" 128 "integer yresolution" 128
Integrator "path" "integer maxdepth" 3
WorldBegin
Material "diffuse" "rgb reflectance" [0.5 0.5 0.5]
Shape "bilinearmesh" "point3 P" [-5 0 -5  5 0 -5  -5 0 5  5 0 5]
)";

// Closed, and seen for five events: every vertex chooses.
constexpr const char* kRoom = R"(LookAt 4.5 1 4.5  0 1 0  0 1 0
Camera "perspective" "float fov" 70
Film "rgb" "integer xresolution" 128 "integer yresolution" 128
Integrator "path" "integer maxdepth" 5
WorldBegin
Material "diffuse" "rgb reflectance" [0.5 0.5 0.5]
Shape "bilinearmesh" "point3 P" [-5.5 0 -5.5  5.5 0 -5.5  -5.5 0 5.5  5.5 0 5.5]
Shape "bilinearmesh" "point3 P" [-5.5 5 -5.5  5.5 5 -5.5  -5.5 5 5.5  5.5 5 5.5]
Shape "bilinearmesh" "point3 P" [-5.5 0 -5.5  5.5 0 -5.5  -5.5 5 -5.5  5.5 5 -5.5]
Shape "bilinearmesh" "point3 P" [-5.5 0 5.5  5.5 0 5.5  -5.5 5 5.5  5.5 5 5.5]
Shape "bilinearmesh" "point3 P" [-5.5 0 -5.5  -5.5 0 5.5  -5.5 5 -5.5  -5.5 5 5.5]
Shape "bilinearmesh" "point3 P" [5.5 0 -5.5  5.5 0 5.5  5.5 5 -5.5  5.5 5 5.5]
)";

void CostOfASample(benchmark::State& state) {
  const TemporaryFolder folder;
  const auto emitters = static_cast<size_t>(state.range(0)), all = static_cast<size_t>(state.range(1));
  WriteTriangles(folder.Path() / "emitters.ply", 0, emitters, all);
  if (all > emitters) WriteTriangles(folder.Path() / "dark.ply", emitters, all - emitters, all);
  std::string text = kHall;
  if (all > emitters) text += "Shape \"plymesh\" \"string filename\" \"dark.ply\"\n";
  text +=
      "AreaLightSource \"diffuse\" \"rgb L\" [1 1 1] \"bool twosided\" true\n"
      "Shape \"plymesh\" \"string filename\" \"emitters.ply\"\n";
  TimeSamples(state, text, folder.Path());
}

// Without triangles, lit by points: where rays cost least, and lights are all there is.
void CostOfASampleOfPoints(benchmark::State& state, const char* place) {
  const TemporaryFolder folder;
  std::string text = place;
  Rng rng(1);
  const std::string intensity = std::to_string(1e3 / static_cast<double>(state.range(0)));
  for (int64_t i = 0; i < state.range(0); ++i) {
    text += "LightSource \"point\" \"rgb I\" [" + intensity + " " + intensity + " " + intensity + "] \"point3 from\" [";
    for (const float x : {10 * rng.NextFloat() - 5, 3 + rng.NextFloat(), 10 * rng.NextFloat() - 5})
      text += std::to_string(x) + " ";
    text += "]\n";
  }
  TimeSamples(state, text, folder.Path());
}
BENCHMARK(CostOfASample)
    ->Name("selection/costOfASample")
    ->ArgNames({"emitters", "triangles"})
    ->Args({10, 1000000})
    ->Args({1000, 1000000})
    ->Args({1000000, 1000000})
    ->Args({10, 10})
    ->Iterations(3)
    ->UseManualTime();

BENCHMARK_CAPTURE(CostOfASampleOfPoints, hall, kHall)
    ->Name("selection/costOfASampleOfPoints")
    ->Arg(10)
    ->Arg(1000)
    ->Arg(1000000)
    ->Iterations(3)
    ->UseManualTime();

BENCHMARK_CAPTURE(CostOfASampleOfPoints, room, kRoom)
    ->Name("selection/costOfASampleOfPointsInARoom")
    ->Arg(10)
    ->Arg(1000)
    ->Arg(1000000)
    ->Iterations(3)
    ->UseManualTime();

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
