// Lights that are a point, without the services around them: nanoseconds a sample and a photon.
#include <benchmark/benchmark.h>

#include <filesystem>
#include <fstream>
#include <random>

#include "film/image.h"
#include "lights/light_type.h"
#include "sampling/rng.h"
#include "scene/scene_description.h"
#include "textures/texture_library.h"

namespace lampyr::test {
namespace {

constexpr size_t kCount = 1024;

// Images and a profile, for as long as a benchmark runs.
class Folder {
 public:
  Folder() {
    std::filesystem::create_directories(path_);
    Rng rng(3, 1);
    Image image(512, 512, {"R", "G", "B"});
    for (float& v : image.data) v = rng.NextFloat();
    WriteExr(path_ / "noise.exr", image, ExrPrecision::Half);
    std::ofstream(path_ / "lamp.ies")
        << "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 4 3 1 2 0 0 0\n1 1 0\n0 30 60 90\n0 45 90\n"
           "90 80 40 1\n80 60 30 0\n90 50 30 2\n";
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  const std::filesystem::path& Path() const { return path_; }

 private:
  std::filesystem::path path_ =
      std::filesystem::temp_directory_path() / ("lampyr-bench-" + std::to_string(std::random_device{}()));
};

void PointLightCalls(benchmark::State& state, const std::string& type, const std::string& parameters, bool emission) {
  const Folder folder;
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  const TextureLibrary textures({}, Transform(), diagnostics);
  LightBuildContext build;
  const Transform placement = Transform::Rotate(30, {1, 2, 3}) * Transform::Translate({1, 0, 2});
  build.transform = {placement.ToAffine(), placement.Inverse().ToAffine()};
  build.textures = &textures;
  const SceneDescription scene = ParseScene("WorldBegin\nLightSource \"" + type + "\" " + parameters + "\n",
                                            folder.Path() / "bench.pbrt", diagnostics);
  const auto light = MakeLight(*FindLightType(type, false), scene.lights.at(0).light.parameters, build);
  LightContext context;
  context.transform = &build.transform;
  Rng rng(3, 1);
  std::vector<Point2> numbers(kCount);
  std::vector<Point3> receivers(kCount);
  // Receivers that are lit: where photons go.
  for (size_t i = 0; i < kCount; ++i) {
    std::optional<EmissionSample> photon;
    do {
      context.u = numbers[i] = rng.NextPoint2();
      photon = light->GenerateEmission(context);
    } while (!photon);
    receivers[i] = photon->position + 2.0f * photon->direction;
  }
  for (auto _ : state) {
    for (size_t i = 0; i < kCount; ++i) {
      if (emission) {
        context.u = numbers[i];
        benchmark::DoNotOptimize(light->GenerateEmission(context));
      } else {
        benchmark::DoNotOptimize(light->GenerateSamples(context, receivers[i]));
      }
    }
  }
  state.SetItemsProcessed(state.iterations() * static_cast<int64_t>(kCount));
}

const bool kRegistered = [] {
  const std::string image = "\"string filename\" \"noise.exr\" ", ies = "\"string shaping:ies:file\" \"lamp.ies\" ";
  const std::pair<std::string, std::string> lights[] = {
      {"point", ""},  {"spot", ""},  {"goniometric", image},       {"projection", image},
      {"point", ies}, {"spot", ies}, {"goniometric", image + ies}, {"projection", image + ies}};
  for (const auto& [type, parameters] : lights) {
    for (const bool emission : {false, true}) {
      const bool shaped = parameters.find("ies") != std::string::npos;
      benchmark::RegisterBenchmark(
          ("pointLight/" + type + (shaped ? "+ies" : "") + (emission ? "/emission" : "/sample")).c_str(),
          [t = type, p = parameters, emission](benchmark::State& s) { PointLightCalls(s, t, p, emission); });
    }
  }
  return true;
}();

}  // namespace
}  // namespace lampyr::test
