#include <cmath>

#include "detection/baseline_render.h"
#include "suite/statistics.h"

namespace lampyr::test {

namespace {

MeanRadiance MeanOfReplicas(BuiltScene& built, int samplesPerPixel, uint64_t seed) {
  RunningMean means;
  MeanRadiance result;
  for (int i = 0; i < kReplicas; ++i) {
    const Rendered rendered = RenderCounted(built, samplesPerPixel, seed + static_cast<uint64_t>(i));
    double sum = 0;
    for (int y = 0; y < rendered.image.height; ++y) {
      for (int x = 0; x < rendered.image.width; ++x) sum += static_cast<double>(rendered.image.RgbAt(x, y).Average());
    }
    means.Add(sum / (static_cast<double>(rendered.image.width) * rendered.image.height));
    result.dropped += rendered.outcome.counts.droppedSamples;
  }
  result.mean = means.Mean();
  result.error = means.StandardError();
  return result;
}

}  // namespace

BaselineScene SceneOf(const std::string& text, const std::filesystem::path& folder, const LightType& light) {
  BaselineScene scene{text, folder, {}};
  scene.types.Add({"planted", {light}, {}});
  return scene;
}

BaselineScene SceneOf(const std::string& text, const std::filesystem::path& folder, const FilterType& filter) {
  BaselineScene scene{text, folder, {}};
  scene.types.Add({"planted", {}, {filter}});
  return scene;
}

MeanRadiance RenderMean(const BaselineScene& scene, const std::string& integrator, int samplesPerPixel, uint64_t seed) {
  BuiltScene built = BuildFor(scene, integrator);
  return MeanOfReplicas(built, samplesPerPixel, seed);
}

Finding FindByFurnace(const BaselineScene& scene, const std::vector<std::string>& integrators, double truth,
                      double seconds, const Counter& counter) {
  constexpr double kTolerance = 0.025;
  constexpr int kMostLooks = 12;
  Finding finding;
  const double start = CpuSeconds();
  std::vector<BuiltScene> built;
  for (const std::string& integrator : integrators) built.push_back(BuildFor(scene, integrator));
  const double level = SidakLevel(kFamilyWise, kMostLooks * static_cast<int>(integrators.size()));
  for (int look = 0; look < kMostLooks && !finding.found && finding.seconds < seconds; ++look) {
    const uint64_t before = counter();
    for (size_t i = 0; i < built.size(); ++i) {
      const MeanRadiance seen = MeanOfReplicas(built[i], 1 << look, 1000 * static_cast<uint64_t>(look + 1));
      const double excess = std::abs(seen.mean - truth) - kTolerance * truth;
      const bool isOff = excess > 0 && NormalTail(NormalDeviate(excess / seen.error, kReplicas - 1)) < level;
      if (!isOff && seen.dropped == 0) continue;
      finding.found = true;
      finding.property = integrators[i];
    }
    finding.samples = counter() - before;
    finding.seconds = CpuSeconds() - start;
  }
  return finding;
}

}  // namespace lampyr::test
