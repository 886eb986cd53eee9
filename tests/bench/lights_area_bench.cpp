// The lights with a surface: nanoseconds per sample, seen from near and from far, even and textured.
#include <benchmark/benchmark.h>

#include <filesystem>

#include "film/image.h"
#include "lights/light_type.h"
#include "sampling/rng.h"
#include "scene/scene_description.h"
#include "textures/texture_library.h"

namespace lampyr::test {
namespace {

constexpr size_t kCount = 1024;

std::vector<Point2> RandomPoints() {
  Rng rng(3, 1);
  std::vector<Point2> points(kCount);
  for (Point2& p : points) p = rng.NextPoint2();
  return points;
}

// Noise, written once.
const std::filesystem::path& TextureFile() {
  static const std::filesystem::path path = [] {
    const auto file = std::filesystem::temp_directory_path() / "lampyr-bench-texture.exr";
    Image image(512, 256, {"R", "G", "B"});
    Rng rng(9, 1);
    for (float& v : image.data) v = rng.NextFloat();
    WriteExr(file, image, ExrPrecision::Half);
    return file;
  }();
  return path;
}

void Samples(benchmark::State& state, const std::string& type, const std::string& text, const Point3& P,
             bool bidirectional) {
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  const TextureLibrary textures{{}, Transform(), diagnostics};
  const SceneDescription scene = ParseScene("WorldBegin\nLightSource \"" + type + "\" " + text + "\n",
                                            TextureFile().parent_path() / "bench.pbrt", diagnostics);
  const Transform placement = Transform::Rotate(30, {1, 2, 3});
  LightBuildContext build;
  build.placement = placement;
  build.transform = {placement.ToAffine(), placement.Inverse().ToAffine()};
  build.textures = &textures;
  build.diagnostics = &diagnostics;
  const auto light = MakeLight(*FindLightType(type, false), scene.lights.at(0).light.parameters, build);
  const auto points = RandomPoints();
  const Point3 receiver = build.transform.toRender.Point(P);
  LightContext context;
  context.transform = &build.transform;
  context.scene = {Point3(0.0f), 10};
  context.bidirectional = bidirectional;
  for (auto _ : state) {
    for (const Point2& u : points) {
      context.u = u;
      benchmark::DoNotOptimize(light->GenerateSamples(context, receiver));
    }
  }
  state.SetItemsProcessed(state.iterations() * kCount);
}

const bool kRegistered = [] {
  const std::pair<const char*, std::string> variants[] = {
      {"even", ""},
      {"cone", "\"float shaping:cone:angle\" 60"},
      {"textured", "\"string texture:file\" \"lampyr-bench-texture.exr\""},
  };
  const std::pair<const char*, Point3> receivers[] = {{"near", {0.2f, 0.6f, -0.3f}}, {"far", {4, 10, -30}}};
  for (const char* type : {"rect", "disk", "sphere", "cylinder"}) {
    for (const auto& [variant, text] : variants) {
      for (const auto& [where, P] : receivers) {
        for (const bool bidirectional : {false, true}) {
          const std::string name =
              std::string("light/") + type + "/" + variant + "/" + where + (bidirectional ? "/bidirectional" : "");
          benchmark::RegisterBenchmark(name.c_str(), [=, type = std::string(type), text = text, P = P](auto& state) {
            Samples(state, type, text, P, bidirectional);
          });
        }
      }
    }
  }
  return true;
}();

}  // namespace
}  // namespace lampyr::test
