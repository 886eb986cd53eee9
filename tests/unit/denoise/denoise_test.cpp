// Denoising of pictures whose truth is known.
#include "denoise/denoise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include "base/error.h"
#include "film/film.h"

namespace lampyr {
namespace {

const std::vector<std::string> kPicture = {"R", "G", "B", "variance.R", "variance.G", "variance.B"};

using Truth = std::function<float(int x, int y)>;

// A picture of `truth` with normal noise of that standard deviation (relative to 0.1 + truth), as 16 samples give it,
// with the layer of half of them.
Image MakeNoisy(int width, int height, const Truth& truth, float noise, uint32_t seed) {
  std::vector<std::string> channels = kPicture;
  for (const char* channel : {"R", "G", "B"}) channels.push_back(std::string(kHalfLayer) + "." + channel);
  Image image(width, height, channels);
  image.metadata["lampyr.samplesPerPixel"] = "16";
  std::mt19937 random(seed);
  std::normal_distribution<float> normal;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const float sigma = noise * (0.1f + truth(x, y));
      const float a = sigma * std::sqrt(2.0f) * normal(random), b = sigma * std::sqrt(2.0f) * normal(random);
      for (size_t c = 0; c < 3; ++c) {
        image.At(x, y, c) = truth(x, y) + (a + b) / 2;
        image.At(x, y, 3 + c) = sigma * sigma;
        image.At(x, y, 6 + c) = (truth(x, y) + a) / 2;
      }
    }
  }
  return image;
}

void AddFeature(Image& image, const Truth& value, float noise) {
  Image feature(image.width, image.height, {"feature.Albedo.R", "feature.variance.Albedo.R"});
  std::mt19937 random(99);
  std::normal_distribution<float> normal;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      feature.At(x, y, 0) = value(x, y) + noise * normal(random);
      feature.At(x, y, 1) = noise * noise;
    }
  }
  AppendChannels(image, feature);
}

Image Denoised(const Image& noisy, int threads = 1, DenoiseReport* report = nullptr) {
  const std::atomic<bool> interrupted{false};
  DenoiseReport own;
  return Denoise(
      noisy, threads, interrupted, [](double) {}, report ? *report : own);
}

// Error of channel G where `counts` is true, and the fraction of pixels where the stated error covers it at 95 %.
struct Quality {
  double squaredError = 0, meanError = 0, covered = 0, stated = 0;
};
Quality QualityOf(const Image& image, const Truth& truth, const std::function<bool(int, int)>& counts) {
  Quality quality;
  double pixels = 0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      if (!counts(x, y)) continue;
      const auto error = static_cast<double>(image.At(x, y, 1) - truth(x, y));
      quality.squaredError += error * error;
      quality.meanError += error;
      quality.stated += static_cast<double>(image.At(x, y, 4));
      if (std::abs(error) <= 1.96 * std::sqrt(static_cast<double>(image.At(x, y, 4)))) ++quality.covered;
      ++pixels;
    }
  }
  quality.squaredError /= pixels;
  quality.meanError /= pixels;
  quality.covered /= pixels;
  quality.stated /= pixels;
  return quality;
}
bool Everywhere(int, int) {
  return true;
}

TEST(Denoise, ConstantStaysUnbiasedAndItsErrorIsCovered) {
  const Truth truth = [](int, int) { return 0.5f; };
  double bias = 0, covered = 0, squaredError = 0;
  constexpr int seeds = 5;
  for (uint32_t seed = 0; seed < seeds; ++seed) {
    const Quality quality = QualityOf(Denoised(MakeNoisy(48, 40, truth, 0.3f, seed)), truth, Everywhere);
    bias += quality.meanError / seeds;
    covered += quality.covered / seeds;
    squaredError += quality.squaredError / seeds;
  }
  const double sigma = 0.3 * 0.6;
  EXPECT_LT(squaredError, 0.05 * sigma * sigma);
  EXPECT_NEAR(bias, 0, 4 * sigma / std::sqrt(48.0 * 40 * seeds));
  EXPECT_GT(covered, 0.93);
}

TEST(Denoise, WithoutHalvesItIsMuchTheSame) {
  const Truth truth = [](int, int) { return 0.5f; };
  const Image noisy = ChannelsOf(MakeNoisy(48, 40, truth, 0.3f, 5), kPicture);
  DenoiseReport report;
  const Quality quality = QualityOf(Denoised(noisy, 1, &report), truth, Everywhere);
  EXPECT_FALSE(report.hasHalves);
  EXPECT_FALSE(report.hasFeatures);
  EXPECT_LT(quality.squaredError, 0.05 * 0.18 * 0.18);
  EXPECT_GT(quality.covered, 0.9);
}

// On the left, as in most of the picture, the samples of one half fill the gaps of the other; on the right they do not.
TEST(Denoise, NoNoiseComesBackWhereSamplesAreLessStratified) {
  constexpr int kWidth = 112, kHeight = 64, kRight = 80;
  constexpr float kValue = 0.5f, kSigma = 0.15f, kCorrelation = -0.6f;
  Image image = MakeNoisy(
      kWidth, kHeight, [](int, int) { return kValue; }, 0, 1);
  std::mt19937 random(8);
  std::normal_distribution<float> normal;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const float correlation = x < kRight ? kCorrelation : 0;
      const float a = normal(random), b = correlation * a + std::sqrt(1 - correlation * correlation) * normal(random);
      const float scale = std::sqrt(2.0f) * kSigma;
      for (size_t c = 0; c < 3; ++c) {
        image.At(x, y, c) = kValue + scale * (a + b) / 2;
        image.At(x, y, 3 + c) = kSigma * kSigma;
        image.At(x, y, 6 + c) = (kValue + scale * a) / 2;
      }
    }
  }
  const Quality quality = QualityOf(
      Denoised(image), [](int, int) { return kValue; }, [](int x, int) { return x >= kRight + 8; });
  EXPECT_LT(quality.squaredError, 0.02 * static_cast<double>(kSigma * kSigma));
}

TEST(Denoise, AnEdgeOfAFeatureStaysSharp) {
  const Truth truth = [](int x, int) { return x < 24 ? 0.5f : 0.7f; };
  Image noisy = MakeNoisy(48, 40, truth, 0.3f, 1);
  AddFeature(noisy, truth, 0.01f);
  const Quality atEdge = QualityOf(Denoised(noisy), truth, [](int x, int) { return x == 23 || x == 24; });
  EXPECT_LT(std::sqrt(atEdge.squaredError), 0.05);
}

TEST(Denoise, TheNoiseOfAFeatureIsNotCopied) {
  const Truth truth = [](int, int) { return 0.5f; };
  const Image without = MakeNoisy(48, 40, truth, 0.3f, 2);
  Image with = without;
  AddFeature(with, truth, 0.2f);
  const double errorWithout = QualityOf(Denoised(without), truth, Everywhere).squaredError;
  const double errorWith = QualityOf(Denoised(with), truth, Everywhere).squaredError;
  EXPECT_LT(errorWith, 2 * errorWithout);
}

// A bright line that no feature knows of.
TEST(Denoise, ACausticIsNotBlurredBeyondItsStatedError) {
  const Truth truth = [](int x, int y) {
    const float distance = std::abs(static_cast<float>(y) - 20 - 6 * std::sin(static_cast<float>(x) * 0.15f));
    return 0.2f + 3 * std::exp(-distance * distance / 2);
  };
  const auto isBright = [&](int x, int y) { return truth(x, y) > 0.5f; };
  const Image noisy = MakeNoisy(64, 40, truth, 0.1f, 3);
  const Image denoised = Denoised(noisy);
  const Quality before = QualityOf(noisy, truth, isBright), after = QualityOf(denoised, truth, isBright);
  EXPECT_LT(after.squaredError, before.squaredError);
  EXPECT_LT(after.squaredError, 1.3 * after.stated);
  EXPECT_GT(after.covered, 0.86);
  EXPECT_GT(QualityOf(denoised, truth, Everywhere).covered, 0.93);
}

TEST(Denoise, NoiseSharedByNeighboursIsNotUnderstated) {
  const Truth truth = [](int, int) { return 0.5f; };
  Image noisy = MakeNoisy(64, 48, truth, 0.3f, 4);
  const Image sharp = noisy;
  for (int y = 1; y + 1 < noisy.height; ++y) {
    for (int x = 1; x + 1 < noisy.width; ++x) {
      for (const size_t c : {0, 1, 2, 6, 7, 8}) {
        float sum = 0;
        for (int j = -1; j <= 1; ++j) {
          for (int i = -1; i <= 1; ++i) sum += sharp.At(x + i, y + j, c);
        }
        const float mean = c < 3 ? 0.5f : 0.25f;
        noisy.At(x, y, c) = mean + (sum / 9 - mean) * 3;  // the variance of a pixel is as before
      }
    }
  }
  EXPECT_GT(QualityOf(Denoised(noisy), truth, Everywhere).covered, 0.85);
}

TEST(Denoise, PixelsThatAreNotFiniteStayAlone) {
  const Truth truth = [](int, int) { return 0.5f; };
  Image noisy = MakeNoisy(48, 40, truth, 0.2f, 6);
  noisy.At(20, 20, 0) = std::numeric_limits<float>::quiet_NaN();
  noisy.At(30, 10, 1) = std::numeric_limits<float>::infinity();
  noisy.At(5, 5, 4) = std::numeric_limits<float>::quiet_NaN();
  DenoiseReport report;
  const Image denoised = Denoised(noisy, 1, &report);
  EXPECT_EQ(report.invalidPixels, 3);
  for (int y = 0; y < denoised.height; ++y) {
    for (int x = 0; x < denoised.width; ++x) {
      for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(denoised.At(x, y, c), 0.5f, 0.1f) << x << ", " << y;
    }
  }
}

// Larger than the windows: filled from its border.
TEST(Denoise, ARegionThatIsNotFiniteIsFilledFromItsBorder) {
  Image noisy = MakeNoisy(
      64, 56, [](int, int) { return 0.5f; }, 0.1f, 6);
  for (int y = 10; y < 45; ++y) {
    for (int x = 12; x < 50; ++x) noisy.At(x, y, 1) = std::numeric_limits<float>::quiet_NaN();
  }
  const Image denoised = Denoised(noisy);
  EXPECT_NEAR(denoised.At(30, 28, 1), 0.5f, 0.1f);
  EXPECT_GT(denoised.At(30, 28, 4), 0);
  Image none = noisy;
  std::fill(none.data.begin(), none.data.end(), std::numeric_limits<float>::quiet_NaN());
  EXPECT_THROW(Denoised(none), Error);
}

TEST(Denoise, WhatIsFarTooBrightStaysAsItIs) {
  Image noisy = MakeNoisy(
      48, 40, [](int, int) { return 0.5f; }, 0.1f, 6);
  for (size_t c = 0; c < 3; ++c) noisy.At(20, 20, c) = 1e19f;
  DenoiseReport report;
  const Image denoised = Denoised(noisy, 1, &report);
  EXPECT_EQ(report.invalidPixels, 0);
  EXPECT_EQ(denoised.At(20, 20, 1), 1e19f);
  EXPECT_NEAR(denoised.At(22, 20, 1), 0.5f, 0.1f);
}

// A power of two scales all numbers exactly.
TEST(Denoise, DoesNotDependOnTheUnit) {
  const Truth truth = [](int x, int y) { return (x / 8 + y / 8) % 2 == 0 ? 0.5f : 5.0f; };
  const Image noisy = MakeNoisy(48, 40, truth, 0.2f, 6), denoised = Denoised(noisy);
  for (const int power : {-40, 55}) {
    const float unit = std::ldexp(1.0f, power);
    const auto scaled = [&](const Image& image) {
      Image result = image;
      for (size_t i = 0; i < result.data.size(); ++i) {
        const std::string& channel = image.channels[i % image.channels.size()];
        result.data[i] *= channel.find("variance") == std::string::npos ? unit : unit * unit;
      }
      return result;
    };
    EXPECT_EQ(Denoised(scaled(noisy)).data, scaled(denoised).data) << power;
  }
}

// A part of a picture may hold samples of one half alone: they are no two estimates.
TEST(Denoise, ShareOfTheHalfIsThatOfTheSamplesThatAreThere) {
  Image noisy = MakeNoisy(
      48, 40, [](int, int) { return 0.5f; }, 0.2f, 6);
  DenoiseReport report;
  Denoised(noisy, 1, &report);
  EXPECT_TRUE(report.hasHalves);
  noisy.metadata[kHalfShareMetadata] = "1.000000";
  report = {};
  Denoised(noisy, 1, &report);
  EXPECT_FALSE(report.hasHalves);
}

TEST(Denoise, AnOutlierIsNotSmearedButReportedAndStated) {
  const Truth truth = [](int, int) { return 0.5f; };
  Image noisy = MakeNoisy(48, 40, truth, 0.1f, 7);
  for (size_t c = 0; c < 3; ++c) {
    noisy.At(24, 20, c) = 500;
    noisy.At(24, 20, 3 + c) = 500 * 500;
    noisy.At(24, 20, 6 + c) = 500;
  }
  DenoiseReport report;
  const Image denoised = Denoised(noisy, 1, &report);
  EXPECT_EQ(report.outliers, 1);
  EXPECT_NEAR(report.removed, 500 / (500 + 0.5 * 48 * 40), 0.01);
  for (int y = 0; y < denoised.height; ++y) {
    for (int x = 0; x < denoised.width; ++x) EXPECT_NEAR(denoised.At(x, y, 1), 0.5f, 0.1f) << x << ", " << y;
  }
  // The outlier may have been light of its surroundings: 500 over a window.
  EXPECT_GT(std::sqrt(denoised.At(24, 20, 4)), 1);
}

TEST(Denoise, DoesNotDependOnThreads) {
  const Truth truth = [](int x, int y) { return 0.1f + 0.01f * static_cast<float>(x + y); };
  Image noisy = MakeNoisy(70, 55, truth, 0.3f, 8);
  AddFeature(noisy, truth, 0.02f);
  EXPECT_EQ(Denoised(noisy, 1).data, Denoised(noisy, 2).data);
}

TEST(Denoise, KeepsWhatCameIn) {
  const Truth truth = [](int, int) { return 0.5f; };
  Image noisy = MakeNoisy(20, 10, truth, 0.3f, 9);
  AddFeature(noisy, truth, 0.02f);
  const Image denoised = Denoised(noisy);
  for (const std::string& channel : noisy.channels) {
    const bool isReplaced = std::find(kPicture.begin(), kPicture.end(), channel) != kPicture.end();
    const int kept = denoised.ChannelIndex(isReplaced ? "noisy." + channel : channel);
    ASSERT_GE(kept, 0) << channel;
    const auto from = static_cast<size_t>(noisy.ChannelIndex(channel));
    EXPECT_EQ(denoised.At(7, 3, static_cast<size_t>(kept)), noisy.At(7, 3, from)) << channel;
  }
  EXPECT_THROW(Denoised(denoised), Error);
}

TEST(Denoise, RefusesWhatHasNoVariance) {
  EXPECT_THROW(Denoised(Image(8, 8, {"R", "G", "B"})), Error);
  Image single(8, 8, kPicture);
  single.metadata["lampyr.samplesPerPixel"] = "1";
  EXPECT_THROW(Denoised(single), Error);
  single.metadata["lampyr.integrator"] = "light";  // many light paths are one sample
  EXPECT_NO_THROW(Denoised(single));
}

TEST(Denoise, TinyPictures) {
  for (const auto& [width, height] : {std::pair(1, 1), std::pair(3, 1), std::pair(2, 5)}) {
    const Image denoised = Denoised(MakeNoisy(
        width, height, [](int, int) { return 0.5f; }, 0.1f, 10));
    for (const float value : denoised.data) EXPECT_TRUE(std::isfinite(value));
    EXPECT_NEAR(denoised.At(0, 0, 1), 0.5f, 0.3f) << width << "x" << height;
  }
}

// The layer of half of the samples holds what its samples bring, in any parts of the whole.
TEST(HalfLayer, HasAboutHalfOfTheSamples) {
  for (uint32_t n = 1; n < 200; ++n) {
    uint32_t count = 0;
    for (uint32_t i = 0; i < n; ++i) count += IsInHalf(i) ? 1 : 0;
    EXPECT_EQ(SamplesInHalf(n), count) << n;
    EXPECT_LE(3 * count, 2 * n + 1) << n;
    EXPECT_GE(2 * count, n) << n;
  }
}

TEST(HalfLayer, IsSummedBesidesTheOthers) {
  Film film(2, 1, {0, 0, 2, 1}, {"key", kHalfLayer});
  EXPECT_EQ(film.SplitLayers(), 1u);
  const PixelFilter filter({PixelFilterSettings::Kind::Box, 0.5f, 0.5f});
  for (uint32_t i = 0; i < 4; ++i) {
    const auto value = Color(static_cast<float>(i + 1));
    film.Pixel(0, 0).Add(value, 1);
    if (IsInHalf(i)) film.AddToHalf(0, 0, value, 1);
    SplatList splats = film.MakeSplatList(filter, 1);
    splats.StartPath();
    splats.Add({1.5f, 0.5f}, value);
    film.AddSplats(filter, {&splats, 1}, 1, i);
  }
  const Image image = film.Develop();
  const auto half = static_cast<size_t>(image.ChannelIndex("half.G"));
  EXPECT_FLOAT_EQ(image.At(0, 0, 1), 2.5f);
  EXPECT_FLOAT_EQ(image.At(0, 0, half), (1 + 3) / 4.0f);  // samples 0 and 2
  EXPECT_FLOAT_EQ(image.At(1, 0, 1), 2.5f);
  EXPECT_FLOAT_EQ(image.At(1, 0, half), (1 + 3) / 4.0f);
}

}  // namespace
}  // namespace lampyr
