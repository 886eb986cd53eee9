// Tables: sampled frequencies, densities bit for bit, zeros never sampled, inverses, and values at the extremes.
#include "sampling/tables.h"

#include <gtest/gtest.h>

#include "histogram_test.h"
#include "sampling/rng.h"

namespace lampyr {
namespace {

const float kNaN = std::numeric_limits<float>::quiet_NaN();

std::vector<float> RandomValues(size_t n, uint64_t seed) {
  Rng rng(seed);
  std::vector<float> values(n);
  for (float& v : values) v = rng.NextFloat() < 0.3f ? 0.0f : std::pow(rng.NextFloat(), 4.0f);
  return values;
}

TEST(AliasTable, FrequenciesAndProbabilities) {
  for (const size_t n : {1u, 2u, 3u, 7u, 100u, 1001u}) {
    std::vector<float> weights = RandomValues(n, n);
    weights[n / 2] = 1;
    const AliasTable table(weights);
    double sum = 0;
    for (const float w : weights) sum += static_cast<double>(w);
    EXPECT_DOUBLE_EQ(table.Total(), sum);
    constexpr int kCount = 200000;
    std::vector<double> counts(n), expected(n), leftover(16);
    Rng rng(4);
    for (int i = 0; i < kCount; ++i) {
      const AliasTable::Result r = table.Sample(rng.NextFloat());
      ASSERT_LT(r.index, n);
      ASSERT_EQ(r.probability, table.Probability(r.index));
      ASSERT_TRUE(r.u >= 0 && r.u < 1);
      counts[r.index] += 1;
      leftover[static_cast<size_t>(r.u * 16)] += 1;
    }
    for (size_t i = 0; i < n; ++i) {
      expected[i] = kCount * static_cast<double>(weights[i]) / sum;
      EXPECT_FLOAT_EQ(table.Probability(static_cast<uint32_t>(i)).value,
                      static_cast<float>(static_cast<double>(weights[i]) / sum));
    }
    EXPECT_GT(test::HistogramPValue(counts, expected), test::kSignificance) << n;
    EXPECT_GT(test::HistogramPValue(leftover, std::vector<double>(16, kCount / 16.0)), test::kSignificance) << n;
  }
}

TEST(AliasTable, ZeroWeightIsNeverChosen) {
  const std::vector<float> weights = {0, 1e-30f, 0, -3, kNaN, kInfinity, 1e30f, 0, 1, 0};
  const AliasTable table(weights);
  Rng rng(8);
  for (int i = 0; i < 100000; ++i) {
    const AliasTable::Result r = table.Sample(i == 0 ? 0.0f : i == 1 ? kOneMinusEpsilon : rng.NextFloat());
    ASSERT_GT(table.Probability(r.index).value, 0.0f);
    ASSERT_TRUE(r.index == 6 || r.index == 8 || r.index == 1);
  }
  for (int n = 1; n <= 300; ++n) {  // equal weights, whose shares are 1 only up to rounding, between zeros
    std::vector<float> mixed(static_cast<size_t>(2 * n), 0.0f);
    for (int i = 0; i < n; ++i) mixed[static_cast<size_t>(2 * i)] = 0.1f;
    const AliasTable even(mixed);
    for (int i = 0; i < 4 * n; ++i) {
      const float u = std::min((static_cast<float>(i) + 0.99999f) / static_cast<float>(4 * n), kOneMinusEpsilon);
      ASSERT_EQ(even.Sample(u).index % 2, 0u);
    }
  }
}

TEST(AliasTable, NothingToSample) {
  EXPECT_TRUE(AliasTable().IsZero());
  EXPECT_TRUE(AliasTable(std::vector<float>{}).IsZero());
  EXPECT_TRUE(AliasTable(std::vector<float>{0, -1, kNaN, kInfinity}).IsZero());
}

TEST(Distribution1D, FrequenciesDensityAndInverse) {
  for (const size_t n : {1u, 2u, 3u, 10u, 333u, 4096u}) {
    std::vector<float> values = RandomValues(n, n + 17);
    values[n / 2] = 0.7f;
    const Distribution1D table(values);
    ASSERT_EQ(table.Size(), n);
    double sum = 0, integral = 0;
    for (const float v : values) sum += static_cast<double>(v);
    constexpr int kCount = 100000;
    std::vector<double> counts(n), expected(n);
    Rng rng(n);
    for (int i = 0; i < kCount; ++i) {
      const float u = i == 0 ? 0.0f : i == 1 ? kOneMinusEpsilon : rng.NextFloat();
      const Distribution1D::Result r = table.Sample(u);
      ASSERT_GT(values[r.index], 0.0f);
      ASSERT_TRUE(r.x >= 0 && r.x < 1);
      ASSERT_EQ(r.pdf, table.Density(r.x));  // bit for bit
      ASSERT_NEAR(table.Invert(r.x), u, 1e-6f + 1.2e-7f * r.pdf);
      counts[r.index] += 1;
    }
    for (size_t i = 0; i < n; ++i) {
      const float density = table.Density((static_cast<float>(i) + 0.5f) / static_cast<float>(n));
      const double wanted = static_cast<double>(values[i]) / sum * static_cast<double>(n);
      EXPECT_NEAR(static_cast<double>(density), wanted, static_cast<double>(n) * 0x1p-21 + 1e-6 * wanted);
      EXPECT_EQ(density == 0, values[i] == 0);
      integral += static_cast<double>(density) / static_cast<double>(n);
      expected[i] = kCount * static_cast<double>(values[i]) / sum;
    }
    EXPECT_NEAR(integral, 1, 1e-6);
    EXPECT_FLOAT_EQ(table.Integral(), static_cast<float>(sum / static_cast<double>(n)));
    EXPECT_GT(test::HistogramPValue(counts, expected), test::kSignificance) << n;
  }
}

TEST(Distribution1D, DarkIntervalBesideABrightOneCanBeReached) {
  std::vector<float> values(1000, 1.0f);
  values[400] = 1e9f;
  values[7] = 0;
  const Distribution1D table(values);
  std::vector<bool> reached(values.size());
  for (int i = 0; i < (1 << 24); ++i) reached[table.Sample(static_cast<float>(i) * 0x1p-24f).index] = true;
  for (size_t i = 0; i < values.size(); ++i) EXPECT_EQ(reached[i], values[i] > 0) << i;
}

TEST(Distribution2D, SampleDensityAndInverse) {
  for (const auto& [width, height] :
       {std::pair(1, 1), std::pair(5, 3), std::pair(37, 64), std::pair(300, 7), std::pair(1, 100)}) {
    const size_t n = static_cast<size_t>(width) * static_cast<size_t>(height);
    std::vector<float> values = RandomValues(n, n);
    values[n / 2] = 2;
    for (int x = 0; x < width && height > 2; ++x) values[static_cast<size_t>(x)] = 0;  // an empty row
    const Distribution2D table(values, width, height);
    double sum = 0;
    for (const float v : values) sum += static_cast<double>(v);
    EXPECT_NEAR(table.Integral(), sum / static_cast<double>(n), 1e-12 * sum);
    constexpr int kCount = 200000;
    std::vector<double> counts(n), expected(n);
    Rng rng(n + 1);
    for (int i = 0; i < kCount; ++i) {
      Point2 u = rng.NextPoint2();
      if (i < 4) u = {i & 1 ? kOneMinusEpsilon : 0.0f, i & 2 ? kOneMinusEpsilon : 0.0f};
      const Distribution2D::Result r = table.Sample(u);
      ASSERT_EQ(r.pdf, table.Density(r.uv));
      ASSERT_GT(r.pdf, 0.0f);
      const size_t cell = static_cast<size_t>(static_cast<int>(static_cast<double>(r.uv.y) * height) * width +
                                              static_cast<int>(static_cast<double>(r.uv.x) * width));
      ASSERT_GT(values[cell], 0.0f);
      counts[cell] += 1;
      const Point2 back = table.Invert(r.uv);
      ASSERT_NEAR(back.x, u.x, 1e-4f);
      ASSERT_NEAR(back.y, u.y, 1e-4f);
    }
    double integral = 0;
    for (size_t i = 0; i < n; ++i) {
      expected[i] = kCount * static_cast<double>(values[i]) / sum;
      const int x = static_cast<int>(i) % width, y = static_cast<int>(i) / width;
      const float density = table.Density({(static_cast<float>(x) + 0.5f) / static_cast<float>(width),
                                           (static_cast<float>(y) + 0.5f) / static_cast<float>(height)});
      EXPECT_EQ(density == 0, values[i] == 0);
      integral += static_cast<double>(density) / static_cast<double>(n);
    }
    EXPECT_NEAR(integral, 1, 1e-6);
    EXPECT_GT(test::HistogramPValue(counts, expected), test::kSignificance) << width << "x" << height;
  }
}

TEST(Distribution2D, Extremes) {
  const auto expectUsable = [](const std::vector<float>& values, int width, int height) {
    const Distribution2D table(values, width, height);
    ASSERT_FALSE(table.IsZero());
    Rng rng(2);
    for (int i = 0; i < 10000; ++i) {
      const Distribution2D::Result r = table.Sample(rng.NextPoint2());
      ASSERT_TRUE(r.pdf > 0 && std::isfinite(r.pdf));
      ASSERT_EQ(r.pdf, table.Density(r.uv));
    }
  };
  std::vector<float> values(64 * 64, 1e-30f);
  expectUsable(values, 64, 64);
  values[77] = 1e30f;
  expectUsable(values, 64, 64);
  values.assign(64 * 64, 0.0f);
  values[4095] = 1e-44f;
  expectUsable(values, 64, 64);
  values.assign(64 * 64, 3e38f);
  values[5] = kNaN;
  values[6] = -kInfinity;
  expectUsable(values, 64, 64);
  EXPECT_TRUE(Distribution2D(std::vector<float>(6, 0.0f), 3, 2).IsZero());
  EXPECT_TRUE(Distribution2D(std::vector<float>{kNaN, -1}, 2, 1).IsZero());
  EXPECT_EQ(Distribution2D(std::vector<float>(6, 0.0f), 3, 2).Density({0.5f, 0.5f}), 0.0f);
  EXPECT_TRUE(Distribution1D(std::vector<float>{}).IsZero());
  EXPECT_EQ(Distribution1D().Density(0.5f), 0.0f);
}

TEST(Distribution2D, UniformImageHasUniformDensity) {
  const Distribution2D table(std::vector<float>(1000 * 500, 3.0f), 1000, 500);
  Rng rng(6);
  for (int i = 0; i < 1000; ++i) EXPECT_NEAR(table.Density(rng.NextPoint2()), 1.0f, 1e-4f);
}

}  // namespace
}  // namespace lampyr
