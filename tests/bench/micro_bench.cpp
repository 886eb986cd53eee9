// The small things that a path is made of: random numbers, warps, BSDFs, lights, surface points. Nanoseconds each.
#include <benchmark/benchmark.h>

#include "lights/light_type.h"
#include "materials/material.h"
#include "sampling/rng.h"
#include "sampling/sampler.h"
#include "sampling/tables.h"
#include "sampling/warp.h"
#include "support/render_scene.h"
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

void SobolPairs(benchmark::State& state) {
  Sampler sampler(static_cast<SamplerKind>(state.range(0)), 1);
  uint32_t i = 0;
  for (auto _ : state) {
    sampler.StartPixelSample(3, 5, i++);
    for (int d = 0; d < 16; ++d) benchmark::DoNotOptimize(sampler.Get2D());
  }
  state.SetItemsProcessed(state.iterations() * 16);
}
BENCHMARK(SobolPairs)->Name("sampler/Get2D")->Arg(int(SamplerKind::Sobol))->Arg(int(SamplerKind::Independent));

void CosineHemisphere(benchmark::State& state) {
  const auto points = RandomPoints();
  for (auto _ : state) {
    for (const Point2& u : points) benchmark::DoNotOptimize(SampleCosineHemisphere(u));
  }
  state.SetItemsProcessed(state.iterations() * kCount);
}
BENCHMARK(CosineHemisphere)->Name("warp/cosineHemisphere");

void Table2D(benchmark::State& state) {
  const int width = int(state.range(0)), height = width / 2;
  Rng rng(5, 1);
  std::vector<float> values(size_t(width) * height);
  for (float& v : values) v = rng.NextFloat();
  const Distribution2D table(values, width, height);
  const auto points = RandomPoints();
  for (auto _ : state) {
    for (const Point2& u : points) benchmark::DoNotOptimize(table.Sample(u));
  }
  state.SetItemsProcessed(state.iterations() * kCount);
}
BENCHMARK(Table2D)->Name("table/sample2D")->Arg(128)->Arg(4096);

// A scene of one sphere of a material, and lights; the pieces are taken from there.
BuiltScene SmallScene(const std::string& material, const std::string& light) {
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  return BuildScene(ParseScene("Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 8\nWorldBegin\n" +
                                   light + "\nMaterial " + material + "\nShape \"sphere\"\n",
                               "bench.pbrt", diagnostics),
                    {}, true, diagnostics);
}

const std::string kPointLight = "LightSource \"point\"";

void BsdfSampleAndEvaluate(benchmark::State& state, const std::string& material) {
  const BuiltScene built = SmallScene(material, kPointLight);
  const auto points = RandomPoints();
  SurfacePoint point;
  const Vector3 wo = glm::normalize(Vector3(0.5f, 0.3f, 0.8f)), wi = glm::normalize(Vector3(-0.4f, 0.2f, 0.7f));
  for (auto _ : state) {
    for (const Point2& u : points) {
      const Bsdf bsdf = built.scene.materials[0]->GetBsdf(point, wo);
      benchmark::DoNotOptimize(bsdf.Sample(wo, u.x, u, TransportMode::Radiance));
      benchmark::DoNotOptimize(bsdf.Evaluate(wo, wi, TransportMode::Radiance));
    }
  }
  state.SetItemsProcessed(state.iterations() * kCount);
}

void LightSamples(benchmark::State& state, const std::string& light, bool bidirectional) {
  const BuiltScene built = SmallScene("\"diffuse\"", light);
  const auto points = RandomPoints();
  const Receiver receiver{Point3(0.3f, 1.4f, 0.2f), Normal3(0, 1, 0), false};
  for (auto _ : state) {
    for (const Point2& u : points) {
      benchmark::DoNotOptimize(SampleOneLight(*built.scene.lighting, receiver, u.x, u, 0, bidirectional));
    }
  }
  state.SetItemsProcessed(state.iterations() * kCount);
}

const bool kRegistered = [] {
  const std::pair<const char*, const char*> materials[] = {
      {"diffuse", "\"diffuse\""},
      {"roughConductor", "\"conductor\" \"float roughness\" 0.2"},
      {"smoothDielectric", "\"dielectric\""},
      {"roughDielectric", "\"dielectric\" \"float roughness\" 0.2"},
      {"coatedDiffuse", "\"coateddiffuse\" \"float roughness\" 0.1"},
      {"coatedConductor", "\"coatedconductor\""}};
  for (const auto& [name, material] : materials) {
    benchmark::RegisterBenchmark((std::string("bsdf/") + name).c_str(),
                                 [m = std::string(material)](benchmark::State& s) { BsdfSampleAndEvaluate(s, m); });
  }
  const std::string area = "AttributeBegin Translate 0 4 0 AreaLightSource \"diffuse\" ";
  const std::pair<const char*, std::string> lights[] = {
      {"point", kPointLight},
      {"spot", "LightSource \"spot\" \"point3 from\" [0 4 0] \"point3 to\" [0 0 0]"},
      {"distant", "LightSource \"distant\""},
      {"constantInfinite", "LightSource \"infinite\""},
      {"sphere", area + "Shape \"sphere\" AttributeEnd"},
      {"disk", area + "Rotate 90 1 0 0 Shape \"disk\" AttributeEnd"},
      {"mesh", area + "Shape \"trianglemesh\" \"point3 P\" [-1 0 -1 1 0 -1 1 0 1 -1 0 1] \"integer indices\" [0 1 2 0 "
                      "2 3] AttributeEnd"}};
  for (const auto& [name, light] : lights) {
    for (const bool bidirectional : {false, true}) {
      benchmark::RegisterBenchmark(
          (std::string("light/") + name + (bidirectional ? "/bidirectional" : "")).c_str(),
          [l = light, bidirectional](benchmark::State& s) { LightSamples(s, l, bidirectional); });
    }
  }
  return true;
}();

}  // namespace
}  // namespace lampyr::test
