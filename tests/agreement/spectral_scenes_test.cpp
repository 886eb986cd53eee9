// A prism, a diamond and a lens: integrators agree channel by channel where each of them finds the light.
//
// All pixels of a pass have its wavelengths in common, so that their errors are correlated: the error of a block is
// taken from independent pictures, never from its pixels. A lamp that is small, or a point, is found through glass that
// the camera sees by merging alone: `bdpt` and `light` are compared beside the glass. The blur of `sppm` is as wide as
// these small pictures' details: its means are compared.
#include <gtest/gtest.h>

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
  constexpr int kReplicas = 16;
  constexpr double kRate = 1e-4;
  const Replicas vcm = RenderReplicas(scene, "vcm", kReplicas, 64, overrides);
  overrides.seed = 1000;
  if (std::string(compared.integrator) == "light") overrides.values.clear();
  const Replicas other = RenderReplicas(scene, compared.integrator, kReplicas, compared.samples, overrides);
  EXPECT_EQ(vcm.faults + other.faults, 0u);
  const Agreement result = CompareReplicas(other, vcm, compared.blockSize, kRate);
  RecordProperty("largest_z", std::to_string(result.largestZ));
  EXPECT_TRUE(result.Agrees()) << "largest |z| " << result.largestZ << " (" << result.thresholdZ << "), chi squared "
                               << result.chiSquared << " (" << result.chiSquaredThreshold << "), mean "
                               << result.bias * 100 << " % +- " << result.biasError * 100 << " %";
  EXPECT_FALSE(CompareReplicas(other, vcm, compared.blockSize, kRate, compared.notices).Agrees()) << "too noisy";
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

}  // namespace
}  // namespace lampyr::test
