// Blur is told from noise, and not found where there is none, whatever the noise.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "app/compare/blur.h"
#include "app/compare/mean_of_images.h"
#include "app/compare/neighbourhood.h"
#include "base/error.h"
#include "integrators/photon/photon_pass.h"

namespace lampyr {
namespace {

constexpr int kSide = 32;

// A picture that is dark on the left and bright on the right. `offset`: relative error of every second pixel.
Image Picture(uint32_t seed, double offset, double rareness) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  Image image(kSide, kSide, {"R", "G", "B"});
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      // Light that few samples find: 0 in most pixels, and far too bright in some.
      const double found = uniform(generator) < rareness ? 1 / rareness : 0.0;
      const double value = (x < kSide / 2 ? 0.1 : 2.0) * (found + ((x + y) % 2 == 0 ? offset : -offset));
      for (size_t c = 0; c < 3; ++c) image.At(x, y, c) = static_cast<float>(value);
    }
  }
  return image;
}

Blur Difference(uint32_t seed, double offset, double rarenessOfWide, double rarenessOfNarrow) {
  std::vector<Image> wide, narrow;
  std::vector<const Image*> first, second;
  for (uint32_t k = 0; k < 4; ++k) {
    wide.push_back(Picture(8 * seed + k, offset, rarenessOfWide));
    narrow.push_back(Picture(8 * seed + 4 + k, 0, rarenessOfNarrow));
  }
  for (size_t k = 0; k < 4; ++k) {
    first.push_back(&wide[k]);
    second.push_back(&narrow[k]);
  }
  return DifferenceOfRadii(first, second);
}

// Narrow radii find light rarely: most of their pixels are black, and no pixel is wrong in the mean.
TEST(Blur, IsNotFoundWhereThereIsNone) {
  constexpr int trials = 200;
  int found = 0;
  double sum = 0, limits = 0;
  for (uint32_t trial = 0; trial < trials; ++trial) {
    const Blur blur = Difference(trial, 0, 0.2, 0.02);
    found += blur.isFromZero;
    sum += blur.relMse / trials;
    limits += blur.relMseLimit / trials;
    EXPECT_GE(blur.relMseLimit, blur.relMse);
  }
  // By chance in 1 of 100, of which half is below 0; to four standard deviations. Three degrees of freedom, and
  // products of skewed values, do not keep that exactly.
  EXPECT_LE(found, 2 + 8);
  // The squared noise of four pictures is some (4 + 49) / 4 of the pixel's own.
  EXPECT_LT(sum, 1);
  EXPECT_GT(limits, sum);
}

TEST(Blur, IsFoundAsLargeAsItIs) {
  // A relative error of 0.3 of the pixel, and so another one of its neighbourhood.
  const Image truth = Picture(0, 0, 1);
  const std::vector<std::array<double, 3>> squares = NeighbourhoodSquares(truth);
  double expected = 0, expectedMse = 0;
  for (size_t i = 0; i < truth.data.size(); ++i) {
    const double square = std::pow(0.3 * static_cast<double>(truth.data[i]), 2);
    expected += square / squares[i / 3][i % 3] / static_cast<double>(truth.data.size());
    expectedMse += square / static_cast<double>(truth.data.size());
  }
  EXPECT_NEAR(expected, 0.06, 0.01);  // 0.09 where it is bright; where it is dark the floor counts
  constexpr int trials = 50;
  int covered = 0;
  double sum = 0;
  for (uint32_t trial = 0; trial < trials; ++trial) {
    const Blur blur = Difference(trial, 0.3, 0.95, 0.95);
    EXPECT_TRUE(blur.isFromZero);
    EXPECT_NEAR(blur.RelativeError() / std::sqrt(expected), 1, 0.1);
    EXPECT_GT(blur.mseLimit, 0.9 * expectedMse);
    EXPECT_LT(blur.meanLimit, 0.1);
    covered += blur.relMseLimit > expected;
    sum += blur.relMse / trials;
  }
  EXPECT_NEAR(sum / expected, 1, 0.03);
  EXPECT_GT(covered, 0.85 * trials);
}

TEST(Blur, OfMeansIsTheSumOfErrors) {
  Blur sum;
  sum.Add({.relMse = 0.04, .relMseLimit = 0.09, .mseLimit = 1, .meanLimit = 0.1, .isFromZero = true}, 0.5);
  sum.Add({.relMse = 0.16, .relMseLimit = 0.25, .mseLimit = 1, .meanLimit = 0.3, .isFromZero = false}, 0.5);
  EXPECT_NEAR(sum.relMse, 0.09, 1e-12);  // 0.5 · 0.2 + 0.5 · 0.4
  EXPECT_NEAR(sum.relMseLimit, 0.16, 1e-12);
  EXPECT_NEAR(sum.mseLimit, 1, 1e-12);
  EXPECT_NEAR(sum.meanLimit, 0.2, 1e-12);
  EXPECT_NEAR(sum.RelativeError(), 0.3, 1e-12);
  sum.isFromZero = false;
  EXPECT_NEAR(sum.RelativeError(), 0.4, 1e-12);
  EXPECT_NEAR(sum.Times(2).relMse, 0.36, 1e-12);
}

TEST(Blur, ItTakesFourPictures) {
  const Image image = Picture(1, 0, 0.5);
  const Image* images[] = {&image, &image, &image};
  EXPECT_THROW(DifferenceOfRadii(images, images), Error);
}

TEST(Blur, RadiiAreThoseOfTheSamples) {
  for (const auto& [first, samples] : {std::pair(0u, 16), std::pair(64u, 100), std::pair(4096u, 8)}) {
    double sum = 0;
    for (int i = 0; i < samples; ++i) sum += RadiusScale(first + static_cast<uint32_t>(i), 2. / 3) / samples;
    EXPECT_NEAR(RadiusOfSamples(first, samples) / sum, 1, first == 0 ? 1e-2 : 1e-5);
  }
  EXPECT_NEAR(RadiusOfSamples(kSamplesToHalfRadius << 12, 1) / RadiusOfSamples(1 << 12, 1), 0.5, 1e-4);
}

TEST(MeanOfImages, WeightsAndErrors) {
  MeanOfImages few, many;
  for (uint32_t k = 0; k < 2; ++k) few.Add(Picture(k, 0, 0.5));
  for (uint32_t k = 2; k < 8; ++k) many.Add(Picture(k, 0, 0.5));
  MeanOfImages all;
  for (uint32_t k = 0; k < 8; ++k) all.Add(Picture(k, 0, 0.5));
  const Image means[] = {few.Mean(), many.Mean()};
  const double weights[] = {0.25, 0.75};
  const Image sum = WeightedSum(means, weights), mean = all.Mean();
  double squares = 0, expected = 0;
  for (size_t i = 0; i < sum.data.size(); ++i) {
    if (i % 6 < 3) {
      EXPECT_NEAR(sum.data[i], mean.data[i], 1e-5f);
      continue;
    }
    squares += std::pow(static_cast<double>(sum.data[i]), 2);
    expected += std::pow(static_cast<double>(mean.data[i]), 2);
  }
  EXPECT_NEAR(squares / expected, 1, 0.15);
}

}  // namespace
}  // namespace lampyr
