// The sampler: elementary intervals of Owen-scrambled Sobol pairs, independence of pixels and dimensions, and error.
#include "sampling/sampler.h"

#include <gtest/gtest.h>

#include <set>

#include "histogram_test.h"

namespace lampyr {
namespace {

double Double(float v) {
  return static_cast<double>(v);
}

// Every elementary interval of area 2^-k holds exactly one of 2^k points.
void ExpectStratified(const std::vector<Point2>& points, int k) {
  for (int bitsX = 0; bitsX <= k; ++bitsX) {
    std::vector<int> counts(size_t{1} << k);
    for (const Point2& p : points) {
      const size_t x = static_cast<size_t>(Double(p.x) * (1 << bitsX));
      const size_t y = static_cast<size_t>(Double(p.y) * (1 << (k - bitsX)));
      ++counts[(x << (k - bitsX)) | y];
    }
    for (const int count : counts) ASSERT_EQ(count, 1) << "2^" << bitsX << " columns of 2^" << k << " points";
  }
}

TEST(Sampler, AlignedBlocksAreStratifiedInAllElementaryIntervals) {
  Sampler sampler(SamplerKind::Sobol, 5);
  for (const uint32_t dimension : {0u, 1u, 7u, 8u, 100u, 1000000u}) {
    for (int k = 0; k <= 10; ++k) {
      for (const uint32_t block :
           {0u, 1u, 6u, (1u << (31 - k)) + 3, static_cast<uint32_t>((uint64_t{1} << (32 - k)) - 1)}) {
        std::vector<Point2> points;
        for (uint32_t i = 0; i < (1u << k); ++i) {
          sampler.StartPixelSample(3, 70, (block << k) + i);
          sampler.SetDimension(dimension);
          points.push_back(sampler.Get2D());
        }
        ExpectStratified(points, k);
      }
    }
  }
}

TEST(Sampler, OneDimensionalSamplesAreStratified) {
  Sampler sampler(SamplerKind::Sobol, 1);
  for (int k = 0; k <= 12; ++k) {
    std::set<int> strata;
    for (uint32_t i = 0; i < (1u << k); ++i) {
      sampler.StartPixelSample(-4, 9, (3u << k) + i);
      sampler.SetDimension(11);
      strata.insert(static_cast<int>(Double(sampler.Get1D()) * (1 << k)));
    }
    EXPECT_EQ(strata.size(), size_t{1} << k);
  }
}

TEST(Sampler, IsAFunctionOfPixelIndexDimensionAndSeed) {
  for (const SamplerKind kind : {SamplerKind::Sobol, SamplerKind::Independent}) {
    Sampler a(kind, 42), b(kind, 42), c(kind, 43);
    int equalSeeds = 0;
    for (uint32_t i = 0; i < 1000; ++i) {
      a.StartPixelSample(static_cast<int>(i), 5, i);
      for (int d = 0; d < 10; ++d) a.Get2D();
      const Point2 sequential = a.Get2D();
      b.StartPixelSample(static_cast<int>(i), 5, i);
      b.SetDimension(50);
      b.Get1D();
      b.SetDimension(10);
      ASSERT_EQ(sequential, b.Get2D());
      c.StartPixelSample(static_cast<int>(i), 5, i);
      c.SetDimension(10);
      equalSeeds += c.Get2D() == sequential;
    }
    EXPECT_LT(equalSeeds, 3);
  }
}

// Marginals over many pixels at one sample index, and of one pixel over many indices: uniform on a 16 × 16 grid.
TEST(Sampler, IsUniformOverPixelsAndOverSamples) {
  constexpr int kSide = 256;
  for (const SamplerKind kind : {SamplerKind::Sobol, SamplerKind::Independent}) {
    Sampler sampler(kind, 0);
    for (const uint32_t dimension : {0u, 3u}) {
      std::vector<double> overPixels(256), overSamples(256);
      const auto add = [&](std::vector<double>& counts) {
        sampler.SetDimension(dimension);
        const Point2 p = sampler.Get2D();
        counts[static_cast<size_t>(static_cast<int>(p.x * 16) * 16 + static_cast<int>(p.y * 16))] += 1;
      };
      for (int i = 0; i < kSide * kSide; ++i) {
        sampler.StartPixelSample(i % kSide, i / kSide, 2);
        add(overPixels);
        sampler.StartPixelSample(0, 0, static_cast<uint32_t>(i));
        add(overSamples);
      }
      const std::vector<double> expected(256, kSide * kSide / 256.0);
      EXPECT_GT(test::HistogramPValue(overPixels, expected), test::kSignificance);
      EXPECT_GT(test::HistogramPValue(overSamples, expected), test::kSignificance);
    }
  }
}

// Pairs of numbers that must be independent: two dimensions at one sample over pixels, neighbouring pixels, and two
// dimensions of one pixel over its samples. Joint 8 × 8 histograms.
TEST(Sampler, DimensionsAndPixelsAreIndependent) {
  constexpr int kSide = 200;
  const std::vector<double> expected(64, kSide * kSide / 64.0);
  const auto cell = [](float a, float b) {
    return static_cast<size_t>(static_cast<int>(a * 8) * 8 + static_cast<int>(b * 8));
  };
  for (const SamplerKind kind : {SamplerKind::Sobol, SamplerKind::Independent}) {
    Sampler sampler(kind, 77), other(kind, 77);
    for (const uint32_t dimension : {1u, 2u, 8u, 31u}) {
      std::vector<double> xx(64), xy(64), neighbour(64), overSamples(64);
      for (int i = 0; i < kSide * kSide; ++i) {
        sampler.StartPixelSample(i % kSide, i / kSide, 1);
        const Point2 a = sampler.Get2D();
        sampler.SetDimension(dimension);
        const Point2 b = sampler.Get2D();
        ++xx[cell(a.x, b.x)];
        ++xy[cell(a.x, b.y)];
        other.StartPixelSample(i % kSide + 1, i / kSide, 1);
        other.SetDimension(dimension);
        ++neighbour[cell(b.x, other.Get2D().x)];
        sampler.StartPixelSample(9, 9, static_cast<uint32_t>(i));
        const Point2 c = sampler.Get2D();
        sampler.SetDimension(dimension);
        ++overSamples[cell(c.x, sampler.Get2D().x)];
      }
      for (const auto* counts : {&xx, &xy, &neighbour}) {
        EXPECT_GT(test::HistogramPValue(*counts, expected), test::kSignificance) << dimension;
      }
      // Stratified in each coordinate, so only correlation can show: each joint cell within 6 standard deviations.
      for (const double count : overSamples) EXPECT_NEAR(count, expected[0], 6 * std::sqrt(expected[0])) << dimension;
    }
  }
}

// Pairs are shuffled against each other. In any coordinate two consecutive samples (2m, 2m + 1) are in opposite halves,
// so among four samples two pairs of coordinates agree everywhere or nowhere with probability 1/2; without the shuffle
// always.
TEST(Sampler, LeadingDigitsOfDifferentPairsAreUncorrelated) {
  Sampler sampler(SamplerKind::Sobol, 3);
  int agreeing = 0, total = 0;
  for (int pixel = 0; pixel < 20000; ++pixel) {
    int sum = 0;
    for (uint32_t i = 0; i < 4; ++i) {
      sampler.StartPixelSample(pixel, 0, i);
      const bool a = sampler.Get2D().x < 0.5f, b = sampler.Get2D().x < 0.5f;
      sum += a == b;
    }
    agreeing += sum == 0 || sum == 4;
    ++total;
  }
  EXPECT_NEAR(agreeing / static_cast<double>(total), 0.5, 5 * std::sqrt(0.25 / total));
}

double MeanSquaredError(SamplerKind kind, uint32_t samples, uint32_t dimension) {
  constexpr int kPixels = 4000;
  const double truth = (std::exp(1.0) - 1) * std::sin(1.0);
  double squared = 0, bias = 0;
  Sampler sampler(kind, 1);
  for (int pixel = 0; pixel < kPixels; ++pixel) {
    double sum = 0;
    for (uint32_t i = 0; i < samples; ++i) {
      sampler.StartPixelSample(pixel % 50, pixel / 50, i);
      sampler.SetDimension(dimension);
      const Point2 p = sampler.Get2D();
      sum += std::exp(Double(p.x)) * std::cos(Double(p.y));
    }
    const double error = sum / samples - truth;
    squared += error * error / kPixels;
    bias += error / kPixels;
  }
  EXPECT_LT(std::abs(bias), 5 * std::sqrt(squared / kPixels));
  return squared;
}

TEST(Sampler, ErrorOnASmoothIntegrandIsFarBelowIndependent) {
  for (const uint32_t dimension : {0u, 5u}) {
    EXPECT_GT(MeanSquaredError(SamplerKind::Independent, 16, dimension),
              5 * MeanSquaredError(SamplerKind::Sobol, 16, dimension));
    EXPECT_GT(MeanSquaredError(SamplerKind::Independent, 64, dimension),
              50 * MeanSquaredError(SamplerKind::Sobol, 64, dimension));
    // Between powers of two, too.
    EXPECT_GT(MeanSquaredError(SamplerKind::Independent, 24, dimension),
              5 * MeanSquaredError(SamplerKind::Sobol, 24, dimension));
  }
}

// Integrands of two pairs: the squared error of the mean of 16 samples of ab + mainEffects·(a + b),
// a and b centred on 0. mainEffects = 0 leaves the pure interaction, which padding cannot stratify.
double InteractionError(SamplerKind kind, double mainEffects) {
  constexpr int kPixels = 8000;
  double squared = 0;
  Sampler sampler(kind, 1);
  for (int pixel = 0; pixel < kPixels; ++pixel) {
    double sum = 0;
    for (uint32_t i = 0; i < 16; ++i) {
      sampler.StartPixelSample(pixel, 1, i);
      const double a = Double(sampler.Get2D().x) - 0.5, b = Double(sampler.Get2D().x) - 0.5;
      sum += a * b + mainEffects * (a + b);
    }
    squared += (sum / 16) * (sum / 16) / kPixels;
  }
  return squared;
}

TEST(Sampler, PaddedPairsHelpWithProductsAndHurtNoInteraction) {
  EXPECT_LT(InteractionError(SamplerKind::Sobol, 1), 0.2 * InteractionError(SamplerKind::Independent, 1));
  // Consecutive samples are antithetic in all coordinates at once: up to twice the variance of a pure interaction.
  EXPECT_LT(InteractionError(SamplerKind::Sobol, 0), 2 * InteractionError(SamplerKind::Independent, 0));
}

}  // namespace
}  // namespace lampyr
