// Russian roulette that is learned: what it makes of known paths, and what it is worth.
#include <gtest/gtest.h>

#include <cmath>

#include "base/byte_stream.h"
#include "base/error.h"
#include "integrators/guide/path_roulette.h"
#include "sampling/rng.h"
#include "support/render_scene.h"

namespace lampyr::test {
namespace {

constexpr uint8_t kUp = 4;
constexpr int kPixelsAcross = 32;

// Paths with two events each. The first is on the side `kUp`, at x below 0 or above, with a throughput of 1; the second
// one has no region of its own. Beyond the first event a path finds `left` or `right` times an exponential random
// number, whose second moment is 2, with 3 rays in the mean.
PathRecords PathsThatFind(float left, float right, float survival) {
  PathRecords records;
  Rng rng(7);
  for (uint32_t i = 0; i < 20000; ++i) {
    const float x = 2 * rng.NextFloat() - 1;
    const float found = -std::log(1 - rng.NextFloat()) * (x < 0 ? left : right);
    records.StartPath(i % (kPixelsAcross * kPixelsAcross), i / (kPixelsAcross * kPixelsAcross));
    RecordedEvent event;
    event.position = Point3(x, rng.NextFloat(), 0);
    event.side = kUp;
    event.throughput = 1;
    event.survival = survival;
    event.raysBefore = 1;
    event.foundBefore = 0.5f;
    records.Add(event);
    records.EndPath(0.5f + found / survival, 4);
  }
  return records;
}

std::shared_ptr<const PathRoulette> RouletteOf(const PathRecords& records, double scale) {
  const BlockLayout layout(kPixelsAcross, kPixelsAcross);
  RouletteLearning learning(layout);
  learning.Learn(records, std::vector<double>(layout.Count(), scale));
  return learning.Roulette();
}

float SurvivalAt(const PathRoulette& roulette, float x, float throughput) {
  return roulette.Survival(Point3(x, 0.5f, 0), kUp, throughput, roulette.PerNoise(5));
}

TEST(PathRoulette, GoesOnByTheSecondMomentOverTheCost) {
  const auto roulette = RouletteOf(PathsThatFind(1, 4, 1), 1);
  ASSERT_TRUE(roulette);
  EXPECT_GT(roulette->Regions(), 20u);
  // V = E[x²] - E[x]² = (2 + 32)/2 - (2.5)², of which outliers are limited; C_I = 4 + 2 rays; M = 32; C = 3.
  const double expected = 0.7 * std::sqrt(32.0 / 3) / std::sqrt((17 - 6.25) / 6);
  double ofRight = 0, ofLeft = 0;
  for (int i = 0; i < 20; ++i) {
    const float x = 0.1f + 0.04f * static_cast<float>(i);
    ofRight += static_cast<double>(SurvivalAt(*roulette, x, 0.3f)) / 20;
    ofLeft += static_cast<double>(SurvivalAt(*roulette, -x, 0.8f)) / 20;
  }
  EXPECT_NEAR(ofRight, 0.3 * expected, 0.1 * 0.3 * expected);
  EXPECT_NEAR(ofLeft, 0.8 * expected / 4, 0.1 * 0.8 * expected / 4);
  // Bounded, and none where nothing is known.
  EXPECT_FLOAT_EQ(SurvivalAt(*roulette, -0.5f, 1e-6f), 0.2f);
  EXPECT_FLOAT_EQ(SurvivalAt(*roulette, 0.5f, 1), 1);
  EXPECT_FLOAT_EQ(roulette->Survival(Point3(0.5f, 0.5f, 0), kUp + 1, 1, roulette->PerNoise(5)), 0);
}

// Found with a roulette, light teaches the same as without it: a survivor has found 1 / survival times as much.
TEST(PathRoulette, LearnsTheSameWhateverTheRouletteBefore) {
  const auto before = RouletteOf(PathsThatFind(1, 4, 1), 1), after = RouletteOf(PathsThatFind(1, 4, 0.5f), 1);
  ASSERT_TRUE(before && after);
  const auto perPath = [](const PathRoulette& roulette) {
    return static_cast<double>(SurvivalAt(roulette, 0.5f, 0.25f)) / roulette.PerNoise(5);
  };
  EXPECT_NEAR(perPath(*after), perPath(*before), 0.02 * perPath(*before));
}

TEST(PathRoulette, DependsOnNoUnits) {
  const auto plain = RouletteOf(PathsThatFind(1, 4, 1), 1), bright = RouletteOf(PathsThatFind(1e15f, 4e15f, 1), 1e-15);
  ASSERT_TRUE(plain && bright);
  for (const float x : {-0.7f, -0.2f, 0.3f, 0.9f})
    EXPECT_NEAR(SurvivalAt(*bright, x, 0.2f), SurvivalAt(*plain, x, 0.2f), 1e-4f);
}

TEST(PathRoulette, NothingFoundTeachesNothing) {
  EXPECT_FALSE(RouletteOf(PathsThatFind(0, 0, 1), 1));
  EXPECT_FALSE(RouletteOf(PathRecords(), 1));
}

std::vector<std::byte> BytesOf(const RouletteLearning& learning) {
  std::vector<std::byte> bytes;
  ByteWriter writer([&](const void* from, size_t count) {
    const auto* first = static_cast<const std::byte*>(from);
    bytes.insert(bytes.end(), first, first + count);
  });
  learning.Save(writer);
  return bytes;
}

// Whatever the bytes are, a roulette is refused or sound.
TEST(PathRoulette, IsSavedAndDamagedOnesAreRefused) {
  const BlockLayout layout(kPixelsAcross, kPixelsAcross);
  RouletteLearning learning(layout);
  learning.Learn(PathsThatFind(1, 4, 1), std::vector<double>(layout.Count(), 1));
  const std::vector<std::byte> bytes = BytesOf(learning);
  RouletteLearning loaded(layout);
  ByteReader reader(bytes);
  loaded.Load(reader);
  EXPECT_EQ(BytesOf(loaded), bytes);
  Rng rng(3);
  int refused = 0;
  for (int i = 0; i < 400; ++i) {
    std::vector<std::byte> damaged = bytes;
    const size_t within = i % 2 == 0 ? 4000 : bytes.size();
    const auto at = static_cast<size_t>(rng.NextFloat() * static_cast<float>(within)) % damaged.size();
    damaged[at] = static_cast<std::byte>(rng.NextFloat() * 256);
    if (i % 5 == 0) damaged.resize(at);
    RouletteLearning other(layout);
    ByteReader damagedReader(damaged);
    try {
      other.Load(damagedReader);
    } catch (const Error&) {
      ++refused;
      continue;
    }
    if (!other.Roulette()) continue;
    for (int k = 0; k < 20; ++k) {
      const float survival =
          other.Roulette()->Survival(Point3(4 * rng.NextFloat() - 2, rng.NextFloat(), rng.NextFloat()),
                                     static_cast<uint8_t>(k % kGuideSides), 0.5f, other.Roulette()->PerNoise(3));
      EXPECT_TRUE(survival >= 0 && survival <= 1) << survival;
    }
  }
  EXPECT_GT(refused, 80);
}

// A closed box of gray walls with a lamp at its ceiling and a mirror in it: most of the noise is that of long paths.
std::string ClosedBox() {
  const std::string wall = "Shape \"bilinearmesh\" \"point3 P\" ";
  return "Film \"rgb\" \"integer xresolution\" 48 \"integer yresolution\" 32\nPixelFilter \"box\"\n"
         "Integrator \"path\" \"integer maxdepth\" 20\nLookAt 0 0 0.9  0 0 -1  0 1 0\nCamera \"perspective\" \"float "
         "fov\" 60\nWorldBegin\nMaterial \"diffuse\" \"rgb reflectance\" [0.8 0.8 0.8]\n" +
         wall + "[-1 -1 -1  1 -1 -1  -1 1 -1  1 1 -1]\n" + wall + "[-1 -1 1  1 -1 1  -1 1 1  1 1 1]\n" + wall +
         "[-1 -1 -1  -1 -1 1  -1 1 -1  -1 1 1]\n" + wall + "[1 -1 -1  1 -1 1  1 1 -1  1 1 1]\n" + wall +
         "[-1 -1 -1  1 -1 -1  -1 -1 1  1 -1 1]\n" + wall +
         "[-1 1 -1  1 1 -1  -1 1 1  1 1 1]\n"
         "AttributeBegin Translate 0.3 -0.6 -0.3 Material \"conductor\" \"float roughness\" 0 Shape \"sphere\" \"float "
         "radius\" 0.3 AttributeEnd\n"
         "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [9 8 7] Shape \"bilinearmesh\" \"point3 P\" [-0.3 0.98 "
         "-0.3  0.3 0.98 -0.3  -0.3 0.98 0.3  0.3 0.98 0.3] AttributeEnd\n";
}

// The mean stays, and the error falls by more than the number of rays grows.
TEST(PathRoulette, LowersTheErrorByMoreThanItCosts) {
  double learnedMean = 0, plainMean = 0, learnedVariance = 0, plainVariance = 0, learnedRays = 0, plainRays = 0;
  for (uint64_t seed = 1; seed <= 6; ++seed) {
    const auto add = [seed](bool learns, double& mean, double& variance, double& rays) {
      RenderOverrides overrides;
      overrides.values["guide-paths"] = learns;
      overrides.seed = seed;
      const Rendered render = RenderText(ClosedBox(), 128, overrides, 2);
      const MeanValue value = MeanOf(render.image);
      mean += value.mean;
      variance += value.standardError * value.standardError;
      rays += static_cast<double>(render.outcome.counts.Rays());
    };
    add(true, learnedMean, learnedVariance, learnedRays);
    add(false, plainMean, plainVariance, plainRays);
  }
  EXPECT_NEAR(learnedMean, plainMean, 3.5 * std::sqrt(learnedVariance + plainVariance));
  EXPECT_LT(learnedVariance * learnedRays, 0.85 * plainVariance * plainRays)
      << learnedVariance / plainVariance << " " << learnedRays / plainRays;
}

// Rays of a box with a black panel before the camera, in the left or the right upper corner of the picture.
double RaysWithPanel(const char* integrator, double left) {
  const auto x = [left](double at) { return std::to_string(left * at) + " "; };
  std::string text = ClosedBox();
  text.resize(text.find("AttributeBegin"));
  text +=
      "LightSource \"point\" \"point3 from\" [0 0.7 0]\nMaterial \"diffuse\" \"rgb reflectance\" [0 0 0]\n"
      "Shape \"bilinearmesh\" \"point3 P\" [" +
      x(-0.4) + "0.15 0.5  " + x(-0.15) + "0.15 0.5  " + x(-0.4) + "0.25 0.5  " + x(-0.15) + "0.25 0.5]\n";
  RenderOverrides overrides;
  overrides.integrator = integrator;
  return static_cast<double>(RenderText(text, 96, overrides, 2).outcome.counts.Rays());
}

// The roulette is that of the pixel, also when nothing is recorded any more: one of another pixel would be that of the
// panel for all the picture, or not.
TEST(PathRoulette, IsThatOfThePixel) {
  for (const char* integrator : {"path", "bdpt", "vcm"}) {
    const double left = RaysWithPanel(integrator, 1), right = RaysWithPanel(integrator, -1);
    EXPECT_NEAR(left / right, 1, 0.03) << integrator;
  }
}

// A path that has become black ends there.
TEST(PathRoulette, BlackPathsEnd) {
  const std::string wall = "Shape \"bilinearmesh\" \"point3 P\" ";
  const std::string text =
      "Film \"rgb\" \"integer xresolution\" 32 \"integer yresolution\" 32\nPixelFilter \"box\"\n"
      "Integrator \"path\" \"integer maxdepth\" 20\nLookAt 0 0 0.9  0 0 -1  0 1 0\nCamera \"perspective\" \"float "
      "fov\" 60\nWorldBegin\nMaterial \"diffuse\" \"rgb reflectance\" [0 0.8 0]\n" +
      wall + "[-1 -1 1  1 -1 1  -1 1 1  1 1 1]\n" + wall + "[-1 -1 -1  -1 -1 1  -1 1 -1  -1 1 1]\n" + wall +
      "[1 -1 -1  1 -1 1  1 1 -1  1 1 1]\nMaterial \"diffuse\" \"rgb reflectance\" [0.8 0 0]\n" + wall +
      "[-1 -1 -1  1 -1 -1  -1 1 -1  1 1 -1]\n" + wall + "[-1 -1 -1  1 -1 -1  -1 -1 1  1 -1 1]\n" + wall +
      "[-1 1 -1  1 1 -1  -1 1 1  1 1 1]\n"
      "LightSource \"point\" \"point3 from\" [0.2 0.6 0.1]\n";
  // Shadow rays are traced where any light is left.
  const RenderCounts counts = RenderText(text, 64, {}, 2).outcome.counts;
  EXPECT_LT(counts.indirectRays, counts.shadowRays);
}

}  // namespace
}  // namespace lampyr::test
