// The lights at infinity: nanoseconds per sample, milliseconds to prepare; and beside the skies from images what
// reading memory alone costs, one dependent read at a random place of a table of the same size.
#include <benchmark/benchmark.h>

#include <filesystem>

#include "film/image.h"
#include "lights/light_type.h"
#include "sampling/rng.h"
#include "scene/scene_description.h"
#include "textures/texture_library.h"

namespace lampyr::test {
namespace {

constexpr size_t kCount = 1 << 16;
constexpr int kWidth = 4096, kHeight = 2048;

std::vector<Point2> RandomPoints() {
  Rng rng(3, 1);
  std::vector<Point2> points(kCount);
  for (Point2& p : points) p = rng.NextPoint2();
  return points;
}

// A sky of noise with a sun, written once.
const std::filesystem::path& SkyFile() {
  static const std::filesystem::path path = [] {
    const auto file = std::filesystem::temp_directory_path() / "lampyr-bench-sky.exr";
    Image image(kWidth, kHeight, {"R", "G", "B"});
    Rng rng(9, 1);
    for (float& v : image.data) v = rng.NextFloat();
    for (size_t c = 0; c < 3; ++c) image.data[(600 * kWidth + 1000) * 3 + c] = 1e5f;
    WriteExr(file, image, ExrPrecision::Half);
    return file;
  }();
  return path;
}

// Lights from text; the image is read once and shared.
class Maker {
 public:
  explicit Maker(const std::string& type, const std::string& text) : type_(*FindLightType(type, false)) {
    const SceneDescription scene = ParseScene("WorldBegin\nLightSource \"" + type + "\" " + text + "\n",
                                              SkyFile().parent_path() / "bench.pbrt", diagnostics_);
    parameters_ = scene.lights.at(0).light.parameters;
    build_.textures = &textures_;
    build_.diagnostics = &diagnostics_;
  }
  std::unique_ptr<Light> Make() const { return MakeLight(type_, parameters_, build_); }
  LightContext Context() const {
    LightContext context;
    context.transform = &build_.transform;
    context.scene = {Point3(0.0f), 10};
    return context;
  }

 private:
  Diagnostics diagnostics_{Diagnostics::Mode::Collect};
  TextureLibrary textures_{{}, Transform(), diagnostics_};
  LightType type_;
  ParameterList parameters_;
  LightBuildContext build_;
};

void Samples(benchmark::State& state, const std::string& type, const std::string& text, bool bidirectional) {
  const Maker maker(type, text);
  const std::unique_ptr<Light> light = maker.Make();
  const auto points = RandomPoints();
  LightContext context = maker.Context();
  context.bidirectional = bidirectional;
  size_t i = 0;
  for (auto _ : state) {
    context.u = points[i++ % kCount];
    benchmark::DoNotOptimize(light->GenerateSamples(context, Point3(0.3f, -0.2f, -0.7f)));
  }
  state.SetItemsProcessed(state.iterations());
}

void Photons(benchmark::State& state, const std::string& type, const std::string& text) {
  const Maker maker(type, text);
  const std::unique_ptr<Light> light = maker.Make();
  const auto points = RandomPoints();
  LightContext context = maker.Context();
  size_t i = 0;
  for (auto _ : state) {
    context.u = points[i++ % kCount];
    context.uDirection = points[i % kCount];
    benchmark::DoNotOptimize(light->GenerateEmission(context));
  }
  state.SetItemsProcessed(state.iterations());
}

void Prepare(benchmark::State& state, const std::string& type, const std::string& text) {
  const Maker maker(type, text);
  maker.Make();  // reads the file
  for (auto _ : state) benchmark::DoNotOptimize(maker.Make());
}

// One read after the other, each place known only from the one before.
void RandomReads(benchmark::State& state) {
  const auto count = static_cast<size_t>(state.range(0));
  std::vector<uint32_t> table(count);
  Rng rng(4, 1);
  for (uint32_t& v : table) v = rng.NextUint32();
  uint64_t at = 0;
  for (auto _ : state) {
    at = table[(at * 6364136223846793005ull >> 20) % count] + at + 1;
    benchmark::DoNotOptimize(at);
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(RandomReads)
    ->Name("memory/randomRead")
    ->Arg(kWidth* kHeight)        // a dome's cumulative table
    ->Arg(2 * 1025 * 1025)        // a portal's sums, in double
    ->Arg(3 * kWidth * kHeight);  // the image itself

const bool kRegistered = [] {
  const std::string sky = "\"lampyr-bench-sky.exr\"";
  struct Case {
    std::string name, type, text;
    bool isImage;
  };
  const Case cases[] = {
      {"distant", "distant", "", false},
      {"distantWithAngle", "distant", "\"float angle\" 0.53", false},
      {"infiniteEven", "infinite", "", false},
      {"domeEven", "dome", "", false},
      {"portalEven", "portal", "", false},
      {"domeTextured", "dome", "\"string texture:file\" " + sky, true},
      {"portalTextured", "portal", "\"string texture:file\" " + sky, true},
  };
  for (const Case& c : cases) {
    for (const bool bidirectional : {false, true}) {
      benchmark::RegisterBenchmark(
          ("infinity/sample/" + c.name + (bidirectional ? "/bidirectional" : "")).c_str(),
          [c, bidirectional](benchmark::State& s) { Samples(s, c.type, c.text, bidirectional); });
    }
    benchmark::RegisterBenchmark(("infinity/photon/" + c.name).c_str(),
                                 [c](benchmark::State& s) { Photons(s, c.type, c.text); });
    if (!c.isImage) continue;
    benchmark::RegisterBenchmark(("infinity/prepare/" + c.name).c_str(),
                                 [c](benchmark::State& s) { Prepare(s, c.type, c.text); })
        ->Unit(benchmark::kMillisecond)
        ->UseRealTime();
  }
  return true;
}();

}  // namespace
}  // namespace lampyr::test
