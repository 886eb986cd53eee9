// Differences of images: exact values on small ones, statistics on noise of known variance.
#include "film/metrics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "base/error.h"
#include "film/film.h"

namespace lampyr {
namespace {

Image Constant(int width, int height, float value) {
  Image image(width, height, {"R", "G", "B"});
  std::fill(image.data.begin(), image.data.end(), value);
  return image;
}

// Gray normal noise of the given standard deviation around `mean`, with its layer (variance or stderr).
Image Noisy(int side, float mean, float deviation, unsigned seed, bool asStandardError = false) {
  const std::string layer = asStandardError ? "stderr." : "variance.";
  Image image(side, side, {"R", "G", "B", layer + "R", layer + "G", layer + "B"});
  std::mt19937 generator(seed);
  std::normal_distribution<float> normal(mean, deviation);
  for (size_t i = 0; i < image.data.size(); i += 6) {
    const float value = normal(generator);
    for (size_t c = 0; c < 3; ++c) image.data[i + c] = value;
    for (size_t c = 3; c < 6; ++c) image.data[i + c] = asStandardError ? deviation : deviation * deviation;
  }
  return image;
}

TEST(Metrics, ExactValues) {
  Image a = Constant(2, 1, 1), b = Constant(2, 1, 1);
  a.At(0, 0, 0) = 3;  // one of six values is off by 2
  const ImageDifference difference = CompareImages(a, b);
  EXPECT_NEAR(difference.mse, 4.0 / 6, 1e-12);
  EXPECT_NEAR(difference.relMse, 4.0 / 6 / 1.01, 1e-12);
  EXPECT_NEAR(difference.meanA, 8.0 / 6, 1e-12);
  EXPECT_NEAR(difference.meanB, 1, 1e-12);
  EXPECT_NEAR(difference.bias, 2.0 / 6, 1e-12);
  EXPECT_FALSE(difference.hasBlockTest);
  // Gray differences 2/3 and 0: sample deviation √2/3, of the mean 1/3.
  EXPECT_NEAR(difference.biasInterval, 1.959964 / 3, 1e-6);
}

TEST(Metrics, IdenticalAndBlackImages) {
  const ImageDifference same = CompareImages(Noisy(16, 1, 0.1f, 1), Noisy(16, 1, 0.1f, 1));
  EXPECT_EQ(same.mse, 0);
  EXPECT_EQ(same.relMse, 0);
  EXPECT_EQ(same.flip, 0);
  EXPECT_EQ(same.bias, 0);
  EXPECT_TRUE(same.blockTest.Agrees());
  const ImageDifference black = CompareImages(Constant(4, 4, 0), Constant(4, 4, 0));
  EXPECT_EQ(black.relMse, 0);
  EXPECT_EQ(black.bias, 0);
  EXPECT_TRUE(std::isinf(CompareImages(Constant(4, 4, 1), Constant(4, 4, 0)).relMse));
}

TEST(Metrics, RefusesWhatCannotBeCompared) {
  EXPECT_THROW(CompareImages(Constant(2, 2, 0), Constant(2, 3, 0)), Error);
  EXPECT_THROW(CompareImages(Constant(2, 2, 0), Image(2, 2, {"variance.R", "variance.G"})), Error);
  Image broken = Constant(2, 2, 0);
  broken.At(1, 1, 2) = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(CompareImages(broken, Constant(2, 2, 0)), Error);
  Image crop = Constant(2, 2, 0);
  crop.offsetX = 1;
  EXPECT_THROW(CompareImages(crop, Constant(2, 2, 0)), Error);
  Image negative = Noisy(2, 1, 0.1f, 1);
  negative.At(0, 0, 3) = -1;
  EXPECT_THROW(CompareImages(negative, Noisy(2, 1, 0.1f, 1)), Error);
  EXPECT_THROW(CompareImages(Constant(2, 2, 0), Constant(2, 2, 0), 0), Error);
}

TEST(Metrics, BiasIntervalCoversTheTruth) {
  int covered = 0, coveredByPixels = 0;
  constexpr int trials = 400;
  for (unsigned trial = 0; trial < trials; ++trial) {
    Image a = Noisy(16, 1, 0.2f, 2 * trial + 1), b = Noisy(16, 1, 0.1f, 2 * trial + 2);
    const ImageDifference byLayers = CompareImages(a, b);
    if (std::abs(byLayers.bias * byLayers.meanB) <= byLayers.biasInterval * byLayers.meanB) ++covered;
    a.channels[3] = "other.R";
    const ImageDifference byPixels = CompareImages(a, b);
    if (std::abs(byPixels.bias) <= byPixels.biasInterval) ++coveredByPixels;
  }
  // Binomial of 400 at 0.95: 380 ± 4.4, four deviations either way.
  EXPECT_NEAR(covered, 380, 17.5);
  EXPECT_NEAR(coveredByPixels, 380, 17.5);
}

// The noise of splats is that of several pixels at once.
TEST(Metrics, SplatsHaveMoreNoiseInSumsThanInPixels) {
  Image a = Noisy(16, 1, 0.2f, 1), b = Noisy(16, 1, 0.2f, 2);
  const ImageDifference alone = CompareImages(a, b);
  for (Image* image : {&a, &b}) {
    Image share(16, 16, {kSplatShareChannel});
    std::fill(share.data.begin(), share.data.end(), 1.0f);
    AppendChannels(*image, share);
    image->metadata[kSplatCountMetadata] = "4";
  }
  const ImageDifference shared = CompareImages(a, b);
  EXPECT_NEAR(shared.biasInterval / alone.biasInterval, 2, 1e-6);
  EXPECT_NEAR(alone.blockTest.chiSquared / shared.blockTest.chiSquared, 4, 1e-4);
}

TEST(Metrics, OfDenoisedImagesNothingIsTested) {
  const Image a = Noisy(16, 1, 0.2f, 1);
  Image b = Noisy(16, 1, 0.2f, 2);
  AppendChannels(b, Image(16, 16, {"noisy.R", "noisy.G", "noisy.B"}));
  const ImageDifference difference = CompareImages(a, b);
  EXPECT_EQ(difference.verdict, Verdict::CannotSay);
  EXPECT_NE(difference.reason.find("denoised"), std::string::npos);
}

TEST(BlockTest, HoldsItsFamilyWiseRate) {
  // At a rate of 0.1 over 600 pairs of equal means: at most 60 ± 7.3 rejections. Gray channels are one test, counted as
  // three, so the rate is lower, but not by more than three.
  int rejected = 0;
  constexpr int trials = 600;
  for (unsigned trial = 0; trial < trials; ++trial) {
    const Image a = Noisy(32, 1, 0.2f, 5000 + 2 * trial), b = Noisy(32, 1, 0.1f, 5001 + 2 * trial, trial % 2 == 0);
    const ImageDifference difference = CompareImages(a, b, 8, 0.1);
    ASSERT_TRUE(difference.hasBlockTest);
    ASSERT_EQ(difference.blockTest.blocks, 16);
    if (!difference.blockTest.Agrees()) ++rejected;
  }
  EXPECT_LE(rejected, 60 + 4 * 7.3);
  EXPECT_GE(rejected, 8);
}

TEST(BlockTest, CatchesOneShiftedBlock) {
  const float deviation = 0.2f;
  const float blockError = deviation * std::sqrt(2.0f) / 8;  // of the difference of two means of 64 pixels
  int caught = 0, falselyCaught = 0;
  for (unsigned trial = 0; trial < 50; ++trial) {
    Image a = Noisy(64, 1, deviation, 100 + 2 * trial);
    const Image b = Noisy(64, 1, deviation, 101 + 2 * trial);
    if (!CompareImages(a, b).blockTest.Agrees()) ++falselyCaught;
    for (int y = 16; y < 24; ++y) {
      for (int x = 40; x < 48; ++x) a.At(x, y, 1) += 8 * blockError;  // green only
    }
    if (!CompareImages(a, b).blockTest.Agrees()) ++caught;
  }
  EXPECT_EQ(falselyCaught, 0);
  EXPECT_GE(caught, 49);
}

TEST(BlockTest, CatchesASmallShiftEverywhere) {
  // One standard error per block: no block stands out, their sum of squares does (64 blocks: 128 against 104).
  const float deviation = 0.2f, blockError = deviation * std::sqrt(2.0f) / 8;
  int caught = 0, caughtByLargest = 0;
  for (unsigned trial = 0; trial < 50; ++trial) {
    Image a = Noisy(64, 1 + 1.5f * blockError, deviation, 300 + 2 * trial);
    const BlockTest test = CompareImages(a, Noisy(64, 1, deviation, 301 + 2 * trial)).blockTest;
    if (!test.Agrees()) ++caught;
    if (test.largestZ > test.threshold) ++caughtByLargest;
  }
  EXPECT_GE(caught, 48);
  EXPECT_LT(caughtByLargest, 40);
}

TEST(BlockTest, PixelsWithoutVarianceMustBeEqualUpToRounding) {
  Image a = Noisy(16, 1, 0, 1), b = Noisy(16, 1, 0, 2);
  EXPECT_EQ(CompareImages(a, b).blockTest.blocks, 0);
  EXPECT_TRUE(CompareImages(a, b).blockTest.Agrees());
  for (size_t i = 0; i < a.data.size(); i += 6) a.data[i] = std::nextafter(1.0f, 2.0f);
  EXPECT_TRUE(CompareImages(a, b).blockTest.Agrees());
  for (size_t i = 0; i < a.data.size(); i += 6) a.data[i] = 1.01f;
  EXPECT_FALSE(CompareImages(a, b).blockTest.Agrees());
}

// A block that is black in one image agrees with dim light in the other, which its samples are likely to miss, and not
// with bright light.
TEST(BlockTest, WhereNothingWasFoundRareLightMayBe) {
  const auto agrees = [](float found) {
    Image a = Noisy(16, 1, 0.01f, 1), b = Noisy(16, 1, 0.01f, 2);
    a.metadata["lampyr.samplesPerPixel"] = b.metadata["lampyr.samplesPerPixel"] = "100";
    for (size_t y = 0; y < 8; ++y) {
      for (size_t x = 0; x < 8 * 6; ++x) {
        a.data[y * 16 * 6 + x] = 0;
        b.data[y * 16 * 6 + x] = x % 6 < 3 ? found : 1e-3f * found * found;
      }
    }
    return CompareImages(a, b).blockTest.Agrees();
  };
  EXPECT_TRUE(agrees(1e-4f));  // 0.64 such samples are expected in the block
  EXPECT_FALSE(agrees(1e-2f));
}

TEST(ImageVerdict, DifferencesOfRoundingAreNone) {
  Image a = Noisy(64, 1, 0, 1), b = a;
  for (size_t i = 0; i < a.data.size(); ++i) {
    if (i % 6 < 3) a.data[i] = 0.7f + 1e-3f * static_cast<float>(i % 7);
    if (i % 6 < 3) b.data[i] = std::nextafter(std::nextafter(a.data[i], 2.0f), 2.0f);
  }
  EXPECT_EQ(CompareImages(a, b).verdict, Verdict::Equal);
  // In one block alone something is noisy: all others have rounding, and agree.
  for (size_t i = 3; i < 6; ++i) a.data[i] = b.data[i] = 1;
  b.data[0] += 1;
  const ImageDifference difference = CompareImages(a, b);
  EXPECT_EQ(difference.verdict, Verdict::Agree) << difference.blockTest.chiSquared;
  b.data[600] += 0.1f;
  EXPECT_EQ(CompareImages(a, b).verdict, Verdict::Differ);
}

TEST(ImageVerdict, CannotSayWhatWasNotMeasured) {
  Image a = Noisy(16, 1, 0.1f, 1), b = Noisy(16, 1, 0.1f, 2);
  EXPECT_EQ(CompareImages(a, b).verdict, Verdict::Agree);
  b.metadata["lampyr.samplesPerPixel"] = "1";
  EXPECT_EQ(CompareImages(a, b).verdict, Verdict::CannotSay);
  EXPECT_EQ(CompareImages(b, b).verdict, Verdict::Equal);
  b.metadata["lampyr.integrator"] = "light";
  EXPECT_EQ(CompareImages(a, b).verdict, Verdict::Agree);
  EXPECT_EQ(CompareImages(Constant(4, 4, 0), Constant(4, 4, 0)).verdict, Verdict::CannotSay);
  EXPECT_EQ(CompareImages(Constant(4, 4, 1), Constant(4, 4, 2)).verdict, Verdict::CannotSay);
}

TEST(BlockTest, PartialBlocksAtTheBordersCount) {
  const Image a = Noisy(21, 1, 0.1f, 1), b = Noisy(21, 1, 0.1f, 2);
  EXPECT_EQ(CompareImages(a, b).blockTest.blocks, 9);
  EXPECT_EQ(CompareImages(a, b, 100).blockTest.blocks, 1);
}

}  // namespace
}  // namespace lampyr
