// The film: weighted means, variances of means against known ones, error estimates, extremes.
#include "film/film.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "base/error.h"

namespace lampyr {
namespace {

TEST(Film, DevelopsWeightedMeanAndVarianceOfTheMean) {
  Film film(8, 6, {2, 1, 5, 4});
  PixelSums& pixel = film.Pixel(3, 2);
  for (const float value : {1.0f, 2.0f, 6.0f}) pixel.Add(Color(value, 2 * value, 0), 1.0f);
  const Image image = film.Develop();
  EXPECT_EQ(image.width, 3);
  EXPECT_EQ(image.height, 3);
  EXPECT_EQ(image.offsetX, 2);
  EXPECT_EQ(image.offsetY, 1);
  EXPECT_EQ(image.fullWidth, 8);
  EXPECT_EQ(image.fullHeight, 6);
  const int x = 3 - 2, y = 2 - 1;
  EXPECT_FLOAT_EQ(image.RgbAt(x, y).r, 3.0f);
  EXPECT_FLOAT_EQ(image.RgbAt(x, y).g, 6.0f);
  // Sample variance 7, of the mean 7/3; green is twice as large.
  EXPECT_FLOAT_EQ(image.At(x, y, static_cast<size_t>(image.ChannelIndex("variance.R"))), 7.0f / 3);
  EXPECT_FLOAT_EQ(image.At(x, y, static_cast<size_t>(image.ChannelIndex("variance.G"))), 28.0f / 3);
  EXPECT_EQ(image.RgbAt(0, 0), Color(0.0f));
}

TEST(Film, NegativeWeightsAndCancelledWeightsStayFinite) {
  Film film(1, 1, {0, 0, 1, 1});
  film.Pixel(0, 0).Add(Color(4.0f), 1.5f);
  film.Pixel(0, 0).Add(Color(2.0f), -0.5f);
  EXPECT_FLOAT_EQ(film.Develop().RgbAt(0, 0).r, 5.0f);  // (6 - 1) / 1
  Film cancelled(1, 1, {0, 0, 1, 1});
  cancelled.Pixel(0, 0).Add(Color(4.0f), 1.0f);
  cancelled.Pixel(0, 0).Add(Color(3.0f), -1.0f);
  EXPECT_FLOAT_EQ(cancelled.Develop().RgbAt(0, 0).r, 0.5f);  // by the count: (4 - 3) / 2
}

TEST(Film, AMillionSamplesDoNotDrift) {
  Film film(1, 1, {0, 0, 1, 1});
  for (int i = 0; i < 1000000; ++i) film.Pixel(0, 0).Add(Color(0.1f), 1.0f);
  EXPECT_EQ(film.Develop().RgbAt(0, 0).r, 0.1f);
  EXPECT_LT(film.RelativeError(), 1e-9);
}

TEST(Film, VarianceLayersMatchTheSpreadOfIndependentPixels) {
  // 4096 pixels of 16 exponential samples: the mean of the variance layer is 1/16, and so is the pixels' spread.
  constexpr int side = 64, samples = 16;
  Film film(side, side, {0, 0, side, side});
  std::mt19937 generator(7);
  std::exponential_distribution<float> exponential(1.0f);
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      for (int i = 0; i < samples; ++i) film.Pixel(x, y).Add(Color(exponential(generator)), 1.0f);
    }
  }
  const Image image = film.Develop();
  double estimated = 0, spread = 0;
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      estimated += static_cast<double>(image.At(x, y, 3)) / (side * side);
      const double deviation = static_cast<double>(image.At(x, y, 0)) - 1;
      spread += deviation * deviation / (side * side);
    }
  }
  // Standard errors: the sample variance of an exponential has variance near (9 - 1)/16, the spread near 2/16² · 1.2.
  EXPECT_NEAR(estimated, 1.0 / samples, 4 * std::sqrt(8.0 / samples) / samples / side);
  EXPECT_NEAR(spread, 1.0 / samples, 4 * std::sqrt(2.4) / samples / side);
  EXPECT_NEAR(film.RelativeError(), 1.96 / std::sqrt(samples), 0.02);
}

TEST(Film, RelativeErrorIsInfiniteBeforeTwoSamplesAndZeroInTheDark) {
  Film film(2, 1, {0, 0, 2, 1});
  EXPECT_TRUE(std::isinf(film.RelativeError()));
  film.Pixel(0, 0).Add(Color(1.0f), 1.0f);
  film.Pixel(0, 0).Add(Color(1.0f), 1.0f);
  EXPECT_TRUE(std::isinf(film.RelativeError()));
  Film dark(1, 1, {0, 0, 1, 1});
  for (int i = 0; i < 2; ++i) dark.Pixel(0, 0).Add(Color(0.0f), 1.0f);
  EXPECT_EQ(dark.RelativeError(), 0);
}

// One sample in a thousand makes nearly all of the variance. While few of them were met, the estimate allows for what
// that says of those to come: it is below the truth in fewer than a twentieth of films, and near it once there are
// many.
TEST(Film, RelativeErrorAllowsForRareSamples) {
  constexpr int films = 400;
  const double truth = 1.96 * std::sqrt(0.001 * 0.999) * 100 / (1 + 0.1);  // of one sample
  std::mt19937 generator(3);
  std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
  for (const int samples : {1000, 5000, 200000}) {
    int below = 0;
    double largest = 0;
    for (int f = 0; f < films; ++f) {
      Film film(1, 1, {0, 0, 1, 1});
      for (int i = 0; i < samples; ++i) film.Pixel(0, 0).Add(Color(uniform(generator) < 0.001f ? 101.0f : 1.0f), 1);
      const double unseen = film.RelativeError(101) * std::sqrt(samples) / truth;
      // The mean is not known either; it is what the error is relative to.
      const double known = unseen * static_cast<double>(film.Develop().RgbAt(0, 0).g) / 1.1;
      below += known < 1;
      largest = std::max(largest, known);
    }
    EXPECT_LE(below, films / 20 + 14) << samples;  // three standard deviations
    if (samples == 200000) {
      EXPECT_LT(largest, 1.4);
    }
  }
}

TEST(Film, ExtremeIntensitiesStayFinite) {
  for (const float value : {1e-30f, 1e30f, 3e38f}) {
    Film film(1, 1, {0, 0, 1, 1});
    for (int i = 0; i < 10; ++i) film.Pixel(0, 0).Add(Color(i % 2 == 0 ? value : 0.0f), 1.0f);
    const Image image = film.Develop();
    for (const float v : image.data) EXPECT_TRUE(std::isfinite(v)) << value;
    EXPECT_NEAR(image.RgbAt(0, 0).r / value, 0.5f, 1e-6f);
    EXPECT_TRUE(std::isfinite(film.RelativeError()));
  }
}

TEST(Film, RefusesCropsOutsideOfTheImage) {
  EXPECT_THROW(Film(4, 4, {0, 0, 5, 4}), Error);
  EXPECT_THROW(Film(4, 4, {-1, 0, 4, 4}), Error);
  EXPECT_THROW(Film(4, 4, {2, 2, 2, 4}), Error);
}

}  // namespace
}  // namespace lampyr
