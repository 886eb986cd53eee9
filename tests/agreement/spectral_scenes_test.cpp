// A prism, a diamond and a lens: integrators agree channel by channel where each of them finds the light.
//
// All pixels of a pass have its wavelengths in common, so that their errors are correlated: the error of a block is
// taken from independent pictures, never from its pixels. A lamp that is small, or a point, is found through glass that
// the camera sees by merging alone: `bdpt` and `light` are compared beside the glass. The blur of `sppm` is as wide as
// these small pictures' details: its means are compared. `path` finds such lamps by chance: all integrators are
// compared once more in the same scenes under lights that each of them finds.
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <map>
#include <string>

#include "support/replicas.h"

namespace lampyr::test {
namespace {

struct Compared {
  const char* scene;
  const char* integrator;
  const char* crop;  // x0,x1,y0,y1
  int samples;
  int blockSize;
  double notices;  // a factor that must be noticed
};

void PrintTo(const Compared& compared, std::ostream* out) {
  *out << compared.scene << " by " << compared.integrator;
}

constexpr int kReplicas = 16;

void ExpectAgreement(const Replicas& other, const Replicas& reference, const Compared& compared) {
  constexpr double kRate = 1e-4;
  EXPECT_EQ(reference.faults + other.faults, 0u);
  const Agreement result = CompareReplicas(other, reference, compared.blockSize, kRate);
  EXPECT_TRUE(result.Agrees()) << "largest |z| " << result.largestZ << " (" << result.thresholdZ << "), chi squared "
                               << result.chiSquared << " (" << result.chiSquaredThreshold << "), mean "
                               << result.bias * 100 << " % +- " << result.biasError * 100 << " %";
  EXPECT_FALSE(CompareReplicas(other, reference, compared.blockSize, kRate, compared.notices).Agrees())
      << "too noisy: the mean is known to " << result.biasError * 100 << " %";
}

class SpectralScenes : public testing::TestWithParam<Compared> {};

TEST_P(SpectralScenes, AgreePerChannel) {
  const Compared& compared = GetParam();
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  const SceneDescription scene =
      ReadScene(std::string(LAMPYR_SOURCE_DIR) + "/scenes/" + compared.scene + ".pbrt", diagnostics);
  RenderOverrides overrides;
  overrides.width = 64;
  overrides.height = 36;
  overrides.crop = compared.crop;
  overrides.values["guide-paths"] = false;
  const Replicas vcm = RenderReplicas(scene, "vcm", kReplicas, 64, overrides);
  overrides.seed = 1000;
  if (std::string(compared.integrator) == "light") overrides.values.clear();
  const Replicas other = RenderReplicas(scene, compared.integrator, kReplicas, compared.samples, overrides);
  ExpectAgreement(other, vcm, compared);
}

constexpr int kWhole = 64;  // a block that is the whole picture

INSTANTIATE_TEST_SUITE_P(Of, SpectralScenes,
                         testing::Values(Compared{"prism", "bdpt", "0.625,1,0,1", 64, 8, 1.05},
                                         Compared{"prism", "light", "0.75,0.97,0.2,0.5", 256, 8, 1.1},
                                         Compared{"prism", "sppm", "0,1,0,1", 128, kWhole, 1.05},
                                         Compared{"diamond", "bdpt", "0,1,0.7,1", 64, 8, 1.05},
                                         Compared{"diamond", "light", "0,1,0.83,1", 512, 8, 1.1},
                                         Compared{"diamond", "sppm", "0,1,0.6,1", 128, kWhole, 1.1},
                                         Compared{"magnifier", "bdpt", "0,1,0,1", 64, 8, 1.05},
                                         Compared{"magnifier", "light", "0.66,1,0.2,1", 512, 8, 1.1},
                                         Compared{"magnifier", "sppm", "0,1,0,1", 128, kWhole, 1.05}),
                         [](const auto& info) { return std::string(info.param.scene) + "_" + info.param.integrator; });

// The scene by other lights: a sky, and a sun as wide as a hand at arm's length.
SceneDescription UnderWideLights(const std::string& name) {
  const std::string path = std::string(LAMPYR_SOURCE_DIR) + "/scenes/" + name + ".pbrt";
  std::ifstream file(path);
  std::string text((std::istreambuf_iterator<char>(file)), {});
  text += R"(
LightSource "infinite" "rgb L" [0.2 0.24 0.3]
LightSource "distant" "rgb L" [3 2.8 2.5] "float angle" 30 "point3 from" [-2 -1 3] "point3 to" [0 0 0]
)";
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  SceneDescription scene = ParseScene(text, path, diagnostics);
  scene.lights.erase(scene.lights.begin(), scene.lights.end() - 2);
  for (ShapeDescription& shape : scene.shapes) shape.areaLight = -1;
  return scene;
}

class SpectralScenesByWideLights : public testing::TestWithParam<Compared> {};

TEST_P(SpectralScenesByWideLights, AgreePerChannel) {
  const Compared& compared = GetParam();
  const SceneDescription scene = UnderWideLights(compared.scene);
  RenderOverrides overrides;
  overrides.width = 64;
  overrides.height = 36;
  overrides.crop = compared.crop;
  static std::map<std::string, Replicas> byPath;
  Replicas& path = byPath[std::string(compared.scene) + compared.crop];
  if (path.images.empty()) path = RenderReplicas(scene, "path", kReplicas, 256, overrides);
  overrides.seed = 1000;
  if (std::string(compared.integrator) == "sppm") overrides.values["radius"] = 0.05;  // less than a pixel
  const Replicas other = RenderReplicas(scene, compared.integrator, kReplicas, compared.samples, overrides);
  ExpectAgreement(other, path, compared);
}

// Light paths alone cannot show what the camera sees in glass: beside it. Not in the fog of the prism, where the camera
// stands in the light: what they splat from close by is too noisy.
INSTANTIATE_TEST_SUITE_P(Of, SpectralScenesByWideLights,
                         testing::Values(Compared{"prism", "bdpt", "0,1,0,1", 128, 8, 1.05},
                                         Compared{"prism", "vcm", "0,1,0,1", 64, 8, 1.05},
                                         Compared{"prism", "sppm", "0,1,0,1", 128, kWhole, 1.2},
                                         Compared{"diamond", "bdpt", "0,1,0,1", 128, 8, 1.05},
                                         Compared{"diamond", "light", "0,1,0.83,1", 512, 8, 1.1},
                                         Compared{"diamond", "vcm", "0,1,0,1", 64, 8, 1.05},
                                         Compared{"diamond", "sppm", "0,1,0,1", 128, kWhole, 1.05},
                                         Compared{"magnifier", "bdpt", "0,1,0,1", 128, 8, 1.05},
                                         Compared{"magnifier", "light", "0.66,1,0.2,1", 512, 8, 1.1},
                                         Compared{"magnifier", "vcm", "0,1,0,1", 64, 8, 1.05},
                                         Compared{"magnifier", "sppm", "0,1,0,1", 128, kWhole, 1.05}),
                         [](const auto& info) { return std::string(info.param.scene) + "_" + info.param.integrator; });

}  // namespace
}  // namespace lampyr::test
