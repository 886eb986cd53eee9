// Whole scenes on one thread: samples and rays per second of CPU time, beside what bare Embree does with rays of the
// same kind in the same scene and process.
#include <benchmark/benchmark.h>

#include <filesystem>

#include "base/memory.h"
#include "base/parallel.h"
#include "sampling/rng.h"
#include "sampling/warp.h"
#include "support/render_scene.h"

namespace lampyr::test {
namespace {

namespace fs = std::filesystem;

const fs::path kShared = LAMPYR_SHARED_DATA;

BuiltScene Load(const fs::path& file, int width, int height, const char* integrator = "path") {
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  RenderOverrides overrides;
  overrides.integrator = integrator;
  overrides.width = width;
  overrides.height = height;
  return BuildScene(ReadScene(file, diagnostics), overrides, true, diagnostics);
}

// Rays as a path tracer makes them once it has scattered: from points on surfaces, in cosine-distributed directions.
std::vector<Ray> IncoherentRays(const BuiltScene& built, size_t count) {
  const GeometryScene& geometry = *built.scene.geometry;
  Rng rng(1, 1);
  std::vector<Ray> rays;
  while (rays.size() < count) {
    const Point2 film = rng.NextPoint2() * Point2(float(built.settings.width), float(built.settings.height));
    Ray ray = built.scene.camera->GenerateRay(film, Point2(0.5f), 0).ray;
    for (int bounce = 0; bounce < 3; ++bounce) {
      RayHit hit;
      if (!geometry.Intersect(ray, visibility::kAll, hit)) break;
      const SurfacePoint point = geometry.GetSurfacePoint(ray, hit);
      Normal3 n = point.Ng;
      if (glm::dot(n, ray.direction) > 0) n = -n;
      ray = SpawnRay(point, Frame::FromNormal(n).ToWorld(SampleCosineHemisphere(rng.NextPoint2())), 0);
      rays.push_back(ray);
    }
  }
  // Neighbours in memory must not be neighbours in space.
  for (size_t i = rays.size() - 1; i > 0; --i) std::swap(rays[i], rays[rng.NextUint32() % (i + 1)]);
  return rays;
}

void IntersectRays(benchmark::State& state, const fs::path& file, bool occlusion) {
  if (!fs::exists(file)) return state.SkipWithError("the scene is not here");
  const BuiltScene built = Load(file, 256, 256);
  const std::vector<Ray> rays = IncoherentRays(built, 1 << 18);
  const GeometryScene& geometry = *built.scene.geometry;
  size_t hits = 0;
  for (auto _ : state) {
    for (const Ray& ray : rays) {
      RayHit hit;
      hits +=
          occlusion ? geometry.Occluded(ray, visibility::kShadow) : geometry.Intersect(ray, visibility::kIndirect, hit);
    }
  }
  benchmark::DoNotOptimize(hits);
  state.counters["rays"] =
      benchmark::Counter(double(rays.size()) * double(state.iterations()), benchmark::Counter::kIsRate);
}

// Seconds of CPU time that bare intersection takes for a ray.
struct BareRays {
  double closest = 0, occlusion = 0;
};
BareRays MeasureBareRays(const BuiltScene& built) {
  const std::vector<Ray> rays = IncoherentRays(built, 1 << 18);
  const GeometryScene& geometry = *built.scene.geometry;
  const auto secondsPerRay = [&](bool occlusion) {
    size_t hits = 0;
    double best = 1e9;
    for (int repeat = 0; repeat < 5; ++repeat) {
      const double start = CpuSeconds();
      for (const Ray& ray : rays) {
        RayHit hit;
        hits += occlusion ? geometry.Occluded(ray, visibility::kShadow)
                          : geometry.Intersect(ray, visibility::kIndirect, hit);
      }
      best = std::min(best, CpuSeconds() - start);
    }
    benchmark::DoNotOptimize(hits);
    return best / static_cast<double>(rays.size());
  };
  return {secondsPerRay(false), secondsPerRay(true)};
}

void RenderWhole(benchmark::State& state, const fs::path& file, const char* name, int size) {
  if (!fs::exists(file)) return state.SkipWithError("the scene is not here");
  const BuiltScene built = Load(file, size, size, name);
  const std::unique_ptr<Integrator> integrator = MakeIntegrator(built.scene, built.settings);
  Film film(size, size, built.settings.crop);
  ProgressiveRender render(built.scene, *integrator, built.settings, 1, film);
  constexpr int samples = 16;
  const double start = CpuSeconds();
  for (auto _ : state) render.AddSamples(samples);
  const double seconds = CpuSeconds() - start;
  const RenderCounts& counts = render.Outcome().counts;
  const double pixelSamples = double(size) * size * render.Outcome().samplesPerPixel;
  const BareRays bare = MeasureBareRays(built);
  // What the intersector alone takes for as many incoherent rays of both kinds; and rays per second against its closest
  // hits per second, all rays counted alike.
  const double ofBoth =
      double(counts.cameraRays + counts.indirectRays) * bare.closest + double(counts.shadowRays) * bare.occlusion;
  state.counters["ofBareRays"] = ofBoth / seconds;
  state.counters["ofClosestHits"] = double(counts.Rays()) * bare.closest / seconds;
  state.counters["samples"] = benchmark::Counter(pixelSamples, benchmark::Counter::kIsRate);
  state.counters["rays"] = benchmark::Counter(double(counts.Rays()), benchmark::Counter::kIsRate);
  state.counters["raysPerSample"] = double(counts.Rays()) / pixelSamples;
}

const bool kRegistered = [] {
  const fs::path killeroo = kShared / "killeroo" / "killeroo-simple.pbrt";
  benchmark::RegisterBenchmark("intersect/killeroo/closest", [=](benchmark::State& s) {
    IntersectRays(s, killeroo, false);
  })->Unit(benchmark::kMillisecond);
  benchmark::RegisterBenchmark("intersect/killeroo/occlusion", [=](benchmark::State& s) {
    IntersectRays(s, killeroo, true);
  })->Unit(benchmark::kMillisecond);
  for (const char* integrator : {"path", "bdpt"}) {
    benchmark::RegisterBenchmark((std::string(integrator) + "/killeroo").c_str(), [=](benchmark::State& s) {
      RenderWhole(s, killeroo, integrator, 256);
    })->Unit(benchmark::kMillisecond);
    for (const char* name :
         {"area-box", "mixed-lights", "glass-caustic", "spot-lens", "sky-spheres", "lights600", "pool"}) {
      const fs::path file = kShared / "peer" / (std::string(name) + ".pbrt");
      benchmark::RegisterBenchmark((std::string(integrator) + "/" + name).c_str(), [=](benchmark::State& s) {
        RenderWhole(s, file, integrator, 64);
      })->Unit(benchmark::kMillisecond);
    }
  }
  return true;
}();

}  // namespace
}  // namespace lampyr::test
