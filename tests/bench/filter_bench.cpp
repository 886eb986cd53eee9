// Cost of light filters: nanoseconds per sample in batches of 4096, and one by one as in integrators.
#include <benchmark/benchmark.h>

#include <vector>

#include "lights/filters/filter_type.h"
#include "sampling/rng.h"
#include "scene/scene_description.h"
#include "textures/texture_library.h"

namespace lampyr::test {
namespace {

class Bench {
 public:
  explicit Bench(const std::string& statements) {
    const SceneDescription scene =
        ParseScene("WorldBegin\n" + statements, LAMPYR_SOURCE_DIR "/scenes/bench.pbrt", diagnostics_);
    FilterBuildContext build;
    build.textures = &textures_;
    build.find = [&](const std::string& name, const FileLocation& where) {
      for (const FilterInstance& filter : filters_) {
        if (filter.name == name) return filter;
      }
      throw Error(where, "no " + name);
    };
    for (const LightFilterDescription& description : scene.lightFilters) {
      const StatementDescription& statement = description.filter;
      filters_.push_back({MakeFilter(*FindFilterType(statement.type), statement.parameters, build),
                          statement.parameters.GetString("name", "")});
    }
    Rng rng(7);
    for (int i = 0; i < kCount; ++i) {
      receivers_.emplace_back(2 * rng.NextFloat() - 1, 2 * rng.NextFloat() - 1, -2.0f);
      const Vector3 way = Point3(0.1f * rng.NextFloat(), 0.1f * rng.NextFloat(), 0) - receivers_.back();
      distances_.push_back(glm::length(way));
      directions_.push_back(way / distances_.back());
    }
  }

  void Run(benchmark::State& state, int batch) {
    const LightFilter& filter = *filters_.back().filter;
    for (auto _ : state) {
      std::fill(diffuse_.begin(), diffuse_.end(), Color(1.0f));
      std::fill(specular_.begin(), specular_.end(), Color(1.0f));
      for (int i = 0; i < kCount; i += batch) {
        filter.Filter({},
                      {batch, &receivers_[i], &directions_[i], &distances_[i], &pdfs_[i], &diffuse_[i], &specular_[i]});
      }
      benchmark::DoNotOptimize(diffuse_.data());
      benchmark::ClobberMemory();
    }
    const double samples = static_cast<double>(state.iterations()) * kCount;
    state.counters["nsPerSample"] =
        benchmark::Counter(samples * 1e-9, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
  }

 private:
  static constexpr int kCount = 4096;
  Diagnostics diagnostics_{Diagnostics::Mode::Collect};
  TextureLibrary textures_{{}, Transform(), diagnostics_};
  std::vector<FilterInstance> filters_;
  std::vector<Point3> receivers_;
  std::vector<Vector3> directions_;
  std::vector<float> distances_;
  std::vector<PdfSolidAngle> pdfs_ = std::vector<PdfSolidAngle>(kCount, PdfSolidAngle(1));
  std::vector<Color> diffuse_ = std::vector<Color>(kCount, Color(1.0f)), specular_ = diffuse_;
};

const std::string kGobo =
    "LightFilter \"gobo\" \"string name\" \"gobo\" \"string filename\" \"data/wood.png\" \"rgb tint\" [1 1 1]\n";
const std::string kThree = kGobo +
                           "LightFilter \"barn\" \"string name\" \"barn\" \"float edge\" 0.2\n"
                           "LightFilter \"rod\" \"string name\" \"rod\" \"float edge\" 0.5 \"rgb color\" [1 1 1]\n"
                           "LightFilter \"combiner\" \"string filters\" \"gobo,barn,rod\" ";

[[maybe_unused]] const bool kRegistered = [] {
  const std::pair<std::string, std::string> filters[] = {{"gobo", kGobo},
                                                         {"combinerOfThree/multiply", kThree},
                                                         {"combinerOfThree/max", kThree + "\"string mode\" \"max\""}};
  for (const auto& [name, text] : filters) {
    for (const int batch : {4096, 1}) {
      const std::string full = "filters/" + name + "/batchOf" + std::to_string(batch);
      benchmark::RegisterBenchmark(full.c_str(),
                                   [text = text, batch](benchmark::State& state) { Bench(text).Run(state, batch); });
    }
  }
  return true;
}();

}  // namespace
}  // namespace lampyr::test
