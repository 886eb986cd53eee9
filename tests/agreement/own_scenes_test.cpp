// The scenes of scenes/, each by all integrators that can sample what is seen of it. What only one of them finds (the
// caustics of point lights by path tracing, anything behind smooth glass by light tracing) is out of the crop or too
// long.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "support/replicas.h"

namespace lampyr::test {
namespace {

namespace fs = std::filesystem;
const fs::path kScenes = fs::path(LAMPYR_SOURCE_DIR) / "scenes";

struct OwnScene {
  const char* name;
  const char* first;
  int firstSamples;  // per pixel of each replica
  const char* second;
  int secondSamples;
  const char* crop = nullptr;
  int maxDepth = -1;  // the scene's own
  int replicas = 16;
  int blockSize = 9;
  double noticed = 1.03;  // a picture that is wrong by this factor, which the test finds
  double radius = 0;      // of photons, so small that their blur is not noticed
};

void PrintTo(const OwnScene& scene, std::ostream* stream) {
  *stream << scene.name << ", " << scene.first << " and " << scene.second;
}

const OwnScene kOwnScenes[] = {
    {"glass-sphere", "bdpt", 8, "path", 64},
    {"pool", "bdpt", 16, "path", 32},
    {"ring", "bdpt", 8, "path", 32},
    // In two events no path gets through the lens, which path tracing could not find.
    {"spot-lens", "bdpt", 8, "path", 16, nullptr, 2},
    {"spot-lens", "bdpt", 8, "light", 32, "0.58,1,0,1"},
    {"still-life", "bdpt", 8, "path", 32},
    {"lamp", "bdpt", 8, "path", 32},
    {"lamp", "bdpt", 8, "light", 16},
    {"sky", "bdpt", 8, "path", 16},
    {"lights-1000", "bdpt", 8, "path", 32},
    {"lights-1000", "bdpt", 16, "light", 64, "0,1,0.55,1", -1, 16, 9, 1.05},
    {"gallery", "bdpt", 8, "path", 16},
    {"caustics", "bdpt", 8, "light", 16},
    // Light that only photons find: with and without connections, all directions or wide ones.
    {"diver", "vcm", 16, "sppm", 32, nullptr, -1, 16, 18, 1.05, 0.015},
    {"mirror", "vcm", 16, "sppm", 32, nullptr, -1, 16, 18, 1.05, 0.02},
    {"lamp", "sppm", 32, "bdpt", 8, nullptr, -1, 16, 9, 1.03, 0.008},
};

class OwnScenes : public testing::TestWithParam<OwnScene> {};

std::string ReadText(const fs::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

TEST_P(OwnScenes, LookAlikeToAllIntegrators) {
  const OwnScene& scene = GetParam();
  const std::string text = ReadText(kScenes / (std::string(scene.name) + ".pbrt"));
  RenderOverrides overrides;
  overrides.width = 96;
  overrides.height = 54;
  if (scene.crop) overrides.crop = scene.crop;
  if (scene.maxDepth >= 0) overrides.values["max-depth"] = scene.maxDepth;
  if (scene.radius > 0) overrides.values["radius"] = scene.radius;
  const Replicas first = RenderReplicas(text, scene.first, scene.replicas, scene.firstSamples, overrides);
  overrides.seed = 1000;
  const Replicas second = RenderReplicas(text, scene.second, scene.replicas, scene.secondSamples, overrides);
  const double rate = SidakRate(1e-3, static_cast<int>(std::size(kOwnScenes)));
  const Agreement result = CompareReplicas(first, second, scene.blockSize, rate);
  std::printf(
      "%s, %s and %s: %3d blocks, largest |z| %.2f (threshold %.2f), chi2 %.1f (%.1f), bias %+.3f %% +- %.3f %%\n",
      scene.name, scene.first, scene.second, result.blocks, result.largestZ, result.thresholdZ, result.chiSquared,
      result.chiSquaredThreshold, 100 * result.bias, 196 * result.biasError);
  EXPECT_LE(result.largestZ, result.thresholdZ);
  EXPECT_LE(result.chiSquared, result.chiSquaredThreshold);
  EXPECT_LE(std::abs(result.meanZ), result.meanThreshold);
  EXPECT_EQ(first.faults + second.faults, 0u);
  EXPECT_FALSE(CompareReplicas(first, second, scene.blockSize, rate, scene.noticed).Agrees()) << "too noisy";
  EXPECT_FALSE(CompareReplicas(first, second, scene.blockSize, rate, 1 / scene.noticed).Agrees()) << "too noisy";
}

INSTANTIATE_TEST_SUITE_P(Scenes, OwnScenes, testing::ValuesIn(kOwnScenes), [](const auto& info) {
  std::string name = std::string(info.param.name) + "_" + info.param.first + "_" + info.param.second;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

}  // namespace
}  // namespace lampyr::test
