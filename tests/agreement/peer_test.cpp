// Agreement with an independent renderer, by z-test on block means, on scenes that are not part of this project.
#include <gtest/gtest.h>

#include <filesystem>

#include "film/metrics.h"
#include "support/render_scene.h"

namespace lampyr::test {
namespace {

namespace fs = std::filesystem;
const fs::path kPeer = fs::path(LAMPYR_SHARED_DATA) / "peer";

struct PeerScene {
  const char* name;
  int samplesPerPixel;
};

class Peer : public testing::TestWithParam<PeerScene> {};

// Relative difference of the images' means, and its standard error.
struct Bias {
  double relative, standardError;
};
Bias BiasOf(const ImageDifference& difference) { return {difference.bias, difference.biasInterval / 1.96}; }

void SkipWithoutData(const fs::path& file) {
  if (!fs::exists(file)) GTEST_SKIP() << "the reference data is not here: " << file;
}

TEST_P(Peer, BlockMeansAgree) {
  const fs::path scene = kPeer / (std::string(GetParam().name) + ".pbrt");
  SkipWithoutData(scene);
  if (IsSkipped()) return;
  const Rendered rendered = RenderFile(scene, GetParam().samplesPerPixel);
  const Image reference = ReadImage(kPeer / (std::string(GetParam().name) + ".exr"));
  const ImageDifference difference = CompareImages(rendered.image, reference);
  ASSERT_TRUE(difference.hasBlockTest);
  const BlockTest& test = difference.blockTest;
  std::printf("%s: %d blocks, largest |z| %.2f (threshold %.2f), chi2 %.1f (threshold %.1f), bias %+.3f %% +- %.3f %%\n",
              GetParam().name, test.blocks, test.largestZ, test.threshold, test.chiSquared, test.chiSquaredThreshold,
              100 * difference.bias, 100 * difference.biasInterval);
  EXPECT_GE(test.blocks, 60);
  EXPECT_LE(test.largestZ, test.threshold);
  EXPECT_LE(test.chiSquared, test.chiSquaredThreshold);
  const Bias bias = BiasOf(difference);
  EXPECT_LT(std::abs(bias.relative), std::max(0.005, 3 * bias.standardError));
  EXPECT_LT(bias.standardError, 0.005) << "too noisy to say anything";
  EXPECT_EQ(rendered.outcome.counts.droppedSamples, 0u);
  EXPECT_EQ(rendered.rejectedRays, 0u);
}

INSTANTIATE_TEST_SUITE_P(Scenes, Peer,
                         testing::Values(PeerScene{"area-box", 512}, PeerScene{"mixed-lights", 512},
                                         PeerScene{"sky-spheres", 512}, PeerScene{"lights600", 512},
                                         PeerScene{"glass-caustic", 1024}),
                         [](const auto& info) {
                           std::string name = info.param.name;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

// No camera path can find a delta light through glass: what `path` renders is a part of the reference and never more.
class PeerLowerBound : public testing::TestWithParam<const char*> {};

TEST_P(PeerLowerBound, PathIsPartOfTheReference) {
  const std::string name = GetParam();
  const fs::path scene = kPeer / (name + ".pbrt");
  SkipWithoutData(scene);
  if (IsSkipped()) return;
  const Rendered rendered = RenderFile(scene, 256);
  const Image reference = ReadImage(kPeer / (name + "-sppm.exr"));
  const ImageDifference difference = CompareImages(rendered.image, reference, 16);
  EXPECT_LT(difference.bias, 3 * BiasOf(difference).standardError);
  EXPECT_GT(difference.bias, -0.9) << "nearly everything is missing";
}

INSTANTIATE_TEST_SUITE_P(Scenes, PeerLowerBound, testing::Values("spot-lens", "pool"), [](const auto& info) {
  return std::string(info.param) == "pool" ? "pool" : "spot_lens";
});

TEST(Killeroo, BlockMeansAgree) {
  const fs::path folder = fs::path(LAMPYR_SHARED_DATA) / "killeroo";
  SkipWithoutData(folder / "killeroo-simple.pbrt");
  if (testing::Test::IsSkipped()) return;
  RenderOverrides overrides;
  overrides.width = overrides.height = 175;
  const Rendered rendered = RenderFile(folder / "killeroo-simple.pbrt", 64, overrides);
  const Image reference = ReadImage(folder / "killeroo-simple-175.exr");
  const ImageDifference difference = CompareImages(rendered.image, reference, 25);
  std::printf("killeroo: bias %+.3f %% +- %.3f %%, largest |z| %.2f\n", 100 * difference.bias, 100 * difference.biasInterval,
              difference.blockTest.largestZ);
  EXPECT_LT(std::abs(difference.bias), 0.02);
  // Means of blocks of 25×25 pixels within 2 %, where there is light to compare.
  double largest = 0;
  for (int by = 0; by < 7; ++by) {
    for (int bx = 0; bx < 7; ++bx) {
      double a = 0, b = 0, variance = 0;
      for (int y = by * 25; y < by * 25 + 25; ++y) {
        for (int x = bx * 25; x < bx * 25 + 25; ++x) {
          const Color own = rendered.image.RgbAt(x, y), other = reference.RgbAt(x, y);
          a += static_cast<double>(own.Average());
          b += static_cast<double>(other.Average());
          variance += static_cast<double>(rendered.image.At(x, y, static_cast<size_t>(rendered.image.ChannelIndex("variance.G"))));
        }
      }
      const double noise = 3 * std::sqrt(variance);
      if (b <= 0) continue;
      EXPECT_LT(std::abs(a - b), 0.02 * b + noise) << "block " << bx << " " << by << ": " << a / b - 1;
      largest = std::max(largest, std::abs(a / b - 1));
    }
  }
  std::printf("killeroo: largest relative difference of a block mean %.2f %%\n", 100 * largest);
}

}  // namespace
}  // namespace lampyr::test
