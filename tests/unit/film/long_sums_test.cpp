// A million samples and more to a pixel: sums that do not drift, variances that are not below 0.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "film/film.h"

namespace lampyr {
namespace {

constexpr int kMillion = 1000000;

// One pixel of a film of one, and its variance in green.
struct Developed {
  double value, variance;
};
Developed Develop(const Film& film) {
  const Image image = film.Develop();
  return {static_cast<double>(image.RgbAt(0, 0).g),
          static_cast<double>(image.At(0, 0, static_cast<size_t>(image.ChannelIndex("variance.G"))))};
}

TEST(LongSums, AMillionSamplesKeepTheirMeanToTheLastDigitOfAFloat) {
  // Values that no binary fraction is, and weights as a filter gives them.
  for (const float value : {0.1f, 1e-30f, 1e30f, 1.0f / 3}) {
    Film film(1, 1, {0, 0, 1, 1});
    long double sum = 0, weights = 0;
    for (int i = 0; i < kMillion; ++i) {
      const float sample = value * (1 + 0.5f * static_cast<float>(i % 7)), weight = i % 3 == 0 ? 0.7f : 1.15f;
      film.Pixel(0, 0).Add(Color(sample), weight);
      sum += static_cast<long double>(sample) * static_cast<long double>(weight);
      weights += static_cast<long double>(weight);
    }
    EXPECT_EQ(static_cast<float>(Develop(film).value), static_cast<float>(sum / weights)) << value;
  }
}

// One sample of 1e12 times the others, first or last: neither is lost. (In float the small ones would be: 1e12 + 1 =
// 1e12.)
TEST(LongSums, ABrightSampleBesideAMillionDimOnes) {
  for (const int bright : {0, kMillion / 2, kMillion - 1}) {
    Film film(1, 1, {0, 0, 1, 1});
    for (int i = 0; i < kMillion; ++i) film.Pixel(0, 0).Add(Color(i == bright ? 1e12f : 1.0f), 1.0f);
    const double expected = (static_cast<double>(1e12f) + (kMillion - 1)) / kMillion;
    EXPECT_NEAR(Develop(film).value, expected, 1e-7 * expected) << bright;
  }
}

// The second half takes away what the first brought, but for a millionth: what is left has its digits.
TEST(LongSums, WeightsThatCancelLeaveTheRest) {
  Film film(1, 1, {0, 0, 1, 1});
  for (int i = 0; i < kMillion; ++i) film.Pixel(0, 0).Add(Color(0.1f), i % 2 == 0 ? 1.0f : -1.0f);
  for (int i = 0; i < kMillion; ++i) film.Pixel(0, 0).Add(Color(1e-6f), 1.0f);
  // Σw = 1e6 of 2e6 samples.
  EXPECT_NEAR(Develop(film).value, 1e-6, 1e-12);
}

TEST(LongSums, VarianceOfEqualSamplesIsNothing) {
  for (const float value : {0.1f, 1e-20f, 1e15f, 12345.678f}) {
    Film film(1, 1, {0, 0, 1, 1});
    for (int i = 0; i < kMillion; ++i) {
      film.Pixel(0, 0).Add(Color(value), 1.0f);
      if (i == 1 || i == 999 || i == kMillion - 1) {
        const double variance = Develop(film).variance, scale = static_cast<double>(value) * static_cast<double>(value);
        EXPECT_GE(variance, 0) << value << " " << i;
        EXPECT_LE(variance, 1e-13 * scale) << value << " " << i;
      }
    }
  }
}

// A spread of a thousandth of the mean is still measured: σ²/n to a part in a hundred, never below 0 on the way.
TEST(LongSums, VarianceOfNearlyEqualSamplesIsMeasured) {
  for (const float mean : {1.0f, 3000.0f, 1e-9f}) {
    Film film(1, 1, {0, 0, 1, 1});
    const float step = 1e-3f * mean;
    for (int i = 0; i < kMillion; ++i) {
      film.Pixel(0, 0).Add(Color(i % 2 == 0 ? mean - step : mean + step), 1.0f);
      if (i % 99991 == 0) {
        EXPECT_GE(Develop(film).variance, 0);
      }
    }
    const double half = 0.5 * (static_cast<double>(mean + step) - static_cast<double>(mean - step));
    EXPECT_NEAR(Develop(film).variance / (half * half / kMillion), 1, 1e-2) << mean;
  }
}

// Splats: a million light paths, each of which lands twice in the pixel, in lists of many sizes.
TEST(LongSums, AMillionSplatsKeepTheirMean) {
  const PixelFilter filter(PixelFilterSettings{});
  Film film(1, 1, {0, 0, 1, 1});
  Film other(1, 1, {0, 0, 1, 1});
  long double sum = 0;
  int path = 0;
  for (int length = 1; path < kMillion; length = std::min(2 * length, 65536)) {
    SplatList list = film.MakeSplatList(filter, 1), single = other.MakeSplatList(filter, 1);
    for (int i = 0; i < length && path < kMillion; ++i, ++path) {
      const float value = 0.1f * (1 + 0.25f * static_cast<float>(path % 5));
      for (SplatList* splats : {&list, &single}) {
        splats->StartPath();
        splats->Add({0.5f, 0.5f}, Color(value));
        splats->Add({0.5f, 0.5f}, Color(value));
      }
      sum += 2 * static_cast<long double>(value);
    }
    film.AddSplats(filter, {&list, 1}, 1);
    other.AddSplats(filter, {&single, 1}, 3);
  }
  const double weight = static_cast<double>(filter.EvaluateX(0)) * static_cast<double>(filter.EvaluateY(0));
  const double expected = weight * static_cast<double>(sum / kMillion);
  const Developed developed = Develop(film);
  EXPECT_NEAR(developed.value, expected, 2e-7 * expected);
  EXPECT_GE(developed.variance, 0);
  EXPECT_EQ(film.Develop().data, other.Develop().data);  // whatever the threads
}

TEST(LongSums, VarianceOfEqualSplatsIsNothing) {
  const PixelFilter filter(PixelFilterSettings{});
  Film film(1, 1, {0, 0, 1, 1});
  for (int i = 0; i < kMillion / 1000; ++i) {
    SplatList list = film.MakeSplatList(filter, 1);
    for (int k = 0; k < 1000; ++k) {
      list.StartPath();
      list.Add({0.5f, 0.5f}, Color(12345.678f));
    }
    film.AddSplats(filter, {&list, 1}, 1);
    const Developed developed = Develop(film);
    ASSERT_GE(developed.variance, 0) << i;
    ASSERT_LE(developed.variance, 1e-12 * developed.value * developed.value) << i;
  }
}

}  // namespace
}  // namespace lampyr
