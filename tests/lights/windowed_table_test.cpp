// Sums and samples of windows against the cells themselves.
#include "lights/types/windowed_table.h"

#include <gtest/gtest.h>

#include "sampling/rng.h"
#include "support/chi_squared.h"

namespace lampyr {
namespace {

constexpr int kWidth = 13, kHeight = 9;

std::vector<float> Values() {
  Rng rng(3);
  std::vector<float> values(kWidth * kHeight);
  for (float& v : values) v = 0.01f + rng.NextFloat();
  values[40] = 1e4f;
  return values;
}

const WindowedTable::Window kWindows[] = {{0, 1, 0, 1},
                                          {0.13, 0.71, 0.22, 0.94},
                                          {0.51, 0.52, 0.1, 0.9},                  // within a column
                                          {0.3, 0.3 + 1e-4, 0.6, 0.6 + 1e-3},      // within a cell
                                          {5.0 / 13, 6.0 / 13, 3.0 / 9, 7.0 / 9},  // on the cells' borders
                                          {0.999, 1, 0, 0.001}};

double Overlap(double low, double high, int cell, int cells) {
  return std::max(0.0, std::min(high, (cell + 1.0) / cells) - std::max(low, static_cast<double>(cell) / cells));
}

TEST(WindowedTable, IntegralsAreSumsOfCells) {
  const std::vector<float> values = Values();
  const WindowedTable table(values, kWidth, kHeight);
  double total = 0;
  for (const float v : values) total += static_cast<double>(v) / (kWidth * kHeight);
  for (const WindowedTable::Window& w : kWindows) {
    double sum = 0;
    for (int i = 0; i < kWidth * kHeight; ++i) {
      sum += static_cast<double>(values[static_cast<size_t>(i)]) * Overlap(w.x0, w.x1, i % kWidth, kWidth) *
             Overlap(w.y0, w.y1, i / kWidth, kHeight);
    }
    EXPECT_NEAR(table.Integral(w) / (sum / total), 1, 1e-6);
  }
  EXPECT_NEAR(table.Density({0.5 / kWidth, 0.5 / kHeight}), static_cast<double>(values[0]) / total, 1e-9);
  EXPECT_NEAR(table.Density({1, 1}), static_cast<double>(values.back()) / total, 1e-9);
}

TEST(WindowedTable, SamplesStayInTheWindowAndFollowTheCells) {
  const std::vector<float> values = Values();
  const WindowedTable table(values, kWidth, kHeight);
  constexpr int kSamples = 100000, kBins = 20;
  for (const WindowedTable::Window& w : kWindows) {
    // Bins that cut the cells.
    std::vector<double> observed(kBins * kBins, 0.0), expected(kBins * kBins, 0.0);
    for (int b = 0; b < kBins * kBins; ++b) {
      const auto at = [&](double low, double high, int i) { return low + (high - low) * i / kBins; };
      const WindowedTable::Window part{at(w.x0, w.x1, b % kBins), at(w.x0, w.x1, b % kBins + 1),
                                       at(w.y0, w.y1, b / kBins), at(w.y0, w.y1, b / kBins + 1)};
      for (int i = 0; i < kWidth * kHeight; ++i) {
        expected[static_cast<size_t>(b)] += static_cast<double>(values[static_cast<size_t>(i)]) *
                                            Overlap(part.x0, part.x1, i % kWidth, kWidth) *
                                            Overlap(part.y0, part.y1, i / kWidth, kHeight);
      }
    }
    double total = 0;
    for (const double e : expected) total += e;
    for (double& e : expected) e *= kSamples / total;
    Rng rng(8);
    for (int i = 0; i < kSamples; ++i) {
      const Point2d p = table.Sample(w, rng.NextPoint2());
      ASSERT_TRUE(p.x >= w.x0 && p.x <= w.x1 && p.y >= w.y0 && p.y <= w.y1);
      ASSERT_GT(table.Density(p), 0);
      const auto bin = [](double x, double low, double high) {
        return std::clamp(static_cast<int>((x - low) / (high - low) * kBins), 0, kBins - 1);
      };
      ++observed[static_cast<size_t>(bin(p.y, w.y0, w.y1) * kBins + bin(p.x, w.x0, w.x1))];
    }
    EXPECT_GT(testing::ChiSquaredPValue(observed, expected), 1e-4) << w.x0;
  }
}

}  // namespace
}  // namespace lampyr
