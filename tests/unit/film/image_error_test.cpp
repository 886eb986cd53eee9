// Errors against a reference that is noisy itself.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "base/error.h"
#include "film/metrics.h"

namespace lampyr {
namespace {

constexpr int kSide = 64;

// The truth is a ramp; pictures are it plus noise of a known deviation.
double Truth(int x, int c) {
  return 0.1 + 0.02 * x * (c + 1);
}

Image Noisy(double deviation, unsigned seed, double scale = 1) {
  Image image(kSide, kSide, {"R", "G", "B", "variance.R", "variance.G", "variance.B"});
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal(0, deviation);
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      for (int c = 0; c < 3; ++c) {
        image.At(x, y, static_cast<size_t>(c)) = static_cast<float>(scale * Truth(x, c) + normal(generator));
        image.At(x, y, static_cast<size_t>(c) + 3) = static_cast<float>(deviation * deviation);
      }
    }
  }
  return image;
}

// For n normal deviates, the mean of their squares is off by no more than this, relatively, except 4 times in 1e5.
const double kSlack = 4 * std::sqrt(2.0 / (3 * kSide * kSide));

TEST(ImageError, TheNoiseOfTheReferenceIsSubtracted) {
  const Image image = Noisy(0.02, 1), reference = Noisy(0.04, 2);
  const double own = 0.02 * 0.02, added = 0.04 * 0.04;
  EXPECT_NEAR(CompareImages(image, reference).mse, own + added, (own + added) * kSlack);
  const ImageError error = MeasureError(image, reference);
  EXPECT_NEAR(error.mse, own, (own + added) * kSlack);
  const ImageNoise noise = *NoiseOf(reference, 8);
  EXPECT_NEAR(noise.mse, added, 1e-9);
  EXPECT_NEAR(noise.relativeError, 0.04 / MeanValue(reference), 1e-6);
  // relMse in the same units: noise of a quarter of the variance has a quarter of it.
  EXPECT_NEAR(error.relMse / noise.relMse, 0.25, 0.05);
}

TEST(ImageError, WithoutNoiseItIsThatOfDiff) {
  const Image image = Noisy(0.03, 3);
  Image reference = Noisy(0, 4);
  const ImageDifference difference = CompareImages(image, reference);
  const ImageError error = MeasureError(image, reference);
  EXPECT_NEAR(error.mse, difference.mse, 1e-12);
  EXPECT_NEAR(error.relMse, difference.relMse, 1e-9);
  EXPECT_NEAR(error.bias, difference.bias, 1e-9);
  EXPECT_EQ(error.flip, difference.flip);
  reference.channels = {"R", "G", "B", "a", "b", "c"};
  EXPECT_FALSE(NoiseOf(reference, 8));
  EXPECT_NEAR(MeasureError(image, reference).mse, difference.mse, 1e-12);
}

TEST(ImageError, WhatTwoImagesHaveInCommonIsTheirBias) {
  const Image reference = Noisy(0.01, 5);
  const auto common = [&](double scale) {
    const Image images[] = {Noisy(0.05, 6, scale), Noisy(0.05, 7, scale), Noisy(0.05, 8, scale)};
    const Image* pointers[] = {&images[0], &images[1], &images[2]};
    const CommonError all = MeasureCommonError(pointers, reference);
    EXPECT_EQ(all.without.size(), 3u);
    double mean = 0;
    for (size_t k = 0; k < 3; ++k) {
      const Image* pair[] = {pointers[(k + 1) % 3], pointers[(k + 2) % 3]};
      EXPECT_NEAR(all.without[k], MeasureCommonError(pair, reference).relMse, 1e-9);
      mean += all.without[k] / 3;
    }
    EXPECT_NEAR(all.relMse, mean, 1e-9);  // of all pairs
    double measured = 0;
    for (const Image& image : images) measured += MeasureError(image, reference).relMse / 3;
    EXPECT_NEAR(all.relMse + all.varying, measured, 1e-9);
    // Relative to the reference, which is not scaled.
    const double noise = scale * scale * MeasureError(Noisy(0.05, 9, scale), Noisy(0, 9, scale)).relMse;
    EXPECT_NEAR(all.varying / noise, 1, 0.05);
    EXPECT_NEAR((all.varyingWithout[0] + all.varyingWithout[1] + all.varyingWithout[2]) / 3, all.varying, 1e-9);
    return all.relMse;
  };
  EXPECT_NEAR(common(1), 0, 2e-4);
  // A tenth too bright: (0.1 v)² / (v² + floor), a little below 0.01.
  EXPECT_GT(common(1.1), 0.0085);
  EXPECT_LT(common(1.1), 0.0101);
  EXPECT_NEAR(MeasureError(Noisy(0.05, 6, 1.1), reference).bias, 0.1, 1e-3);
}

TEST(ImageError, TheMapHoldsEachPixelsShare) {
  const Image image = Noisy(0.03, 8), reference = Noisy(0, 9);
  double sum = 0;
  for (const float error : RelativeErrorMap(image, reference)) sum += std::pow(static_cast<double>(error), 2);
  EXPECT_NEAR(sum / (kSide * kSide), MeasureError(image, reference).relMse, 1e-7);
}

// The remainder after subtraction of the noise has the mean 0, and the standard error that the noise's errors give.
TEST(ImageError, KnowsHowWellTheNoiseIsSubtracted) {
  const Image truth = Noisy(0, 10);
  double squares = 0, relSquares = 0, meanSquares = 0;
  constexpr int trials = 60;
  ImageNoise noise;
  for (int i = 0; i < trials; ++i) {
    const Image reference = Noisy(0.01, 100 + static_cast<unsigned>(i));
    noise = *NoiseOf(reference, 1 << 20);  // the layers hold the true variance
    const ImageError error = MeasureError(truth, reference);
    squares += error.mse * error.mse / trials;
    relSquares += error.relMse * error.relMse / trials;
    meanSquares += error.bias * error.bias / trials;
  }
  // Here the channels are independent: the bounds, for channels that share their paths, are √3 times as wide.
  EXPECT_NEAR(std::sqrt(3 * squares) / noise.mseError, 1, 0.3);
  EXPECT_NEAR(std::sqrt(3 * relSquares) / noise.relMseError, 1, 0.35);
  EXPECT_NEAR(std::sqrt(3 * meanSquares) / noise.meanError, 1, 0.3);
}

TEST(ImageError, HoldsAtAllIntensities) {
  for (const float scale : {1e-30f, 1e30f}) {
    Image image = Noisy(0.02, 11), reference = Noisy(0.01, 12);
    const ImageError expected = MeasureError(image, reference);
    reference.channels = {"R", "G", "B", "stderr.R", "stderr.G", "stderr.B"};
    for (size_t i = 0; i < reference.data.size(); ++i) {
      float& value = reference.data[i];
      value = i % 6 < 3 ? value * scale : std::sqrt(value) * scale;
    }
    for (size_t i = 0; i < image.data.size(); ++i) image.data[i] *= i % 6 < 3 ? scale : 0.0f;
    const auto squared = static_cast<double>(scale) * static_cast<double>(scale);
    EXPECT_NEAR(MeasureError(image, reference).mse / squared / expected.mse, 1, 1e-4);
    EXPECT_NEAR(MeasureError(image, reference).relMse / expected.relMse, 1, 1e-4);
    EXPECT_NEAR(NoiseOf(reference, 8)->mse / squared / 1e-4, 1, 1e-4);
  }
}

TEST(ImageError, SizesMustAgree) {
  const Image image(2, 2, {"R", "G", "B"}), other(2, 3, {"R", "G", "B"});
  EXPECT_THROW(MeasureError(image, other), Error);
  const Image* images[] = {&image, &image};
  EXPECT_THROW(MeasureCommonError(images, other), Error);
}

}  // namespace
}  // namespace lampyr
