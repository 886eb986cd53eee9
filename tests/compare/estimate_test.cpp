// Intervals hold the truth as often as they say.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "app/compare/estimate.h"

namespace lampyr {
namespace {

constexpr int kTrials = 4000;
// 95 % of the trials, to three and a half standard deviations.
constexpr double kSlack = 3.5 * 0.22 / 63.2;

TEST(Estimate, IntervalOfAMeanCoversIt) {
  std::mt19937 generator(1);
  std::normal_distribution<double> normal(10, 1);
  int covered = 0, logCovered = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::vector<double> values(5);
    for (double& v : values) v = normal(generator);
    const SignificantEstimate mean = MeanOf(values);
    covered += mean.low <= 10 && mean.high >= 10;
    const Estimate onLogScale = *MeanOnLogScale(values);
    logCovered += onLogScale.low <= 10 && onLogScale.high >= 10;
    EXPECT_NEAR(onLogScale.value / onLogScale.low, onLogScale.high / onLogScale.value, 1e-9);
  }
  EXPECT_NEAR(covered / double{kTrials}, 0.95, kSlack);
  EXPECT_NEAR(logCovered / double{kTrials}, 0.95, kSlack);
}

TEST(Estimate, IntervalOfARatioCoversIt) {
  std::mt19937 generator(2);
  std::normal_distribution<double> first(6, 0.6), second(2, 0.1);
  int covered = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::vector<double> a(5), b(5);
    for (double& v : a) v = first(generator);
    for (double& v : b) v = second(generator);
    const Estimate ratio = *RatioOfMeans(a, b);
    covered += ratio.low <= 3 && ratio.high >= 3;
  }
  EXPECT_NEAR(covered / double{kTrials}, 0.95, 2 * kSlack);  // Welch's degrees of freedom are an approximation
}

// Errors of renders are skewed: few are large. Five repeats then promise a little more than they keep.
TEST(Estimate, IntervalOfASkewedMeanNearlyCoversIt) {
  std::mt19937 generator(4);
  std::normal_distribution<double> normal(0, 0.5);
  const double truth = std::exp(0.125);
  int covered = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::vector<double> values(5);
    for (double& v : values) v = std::exp(normal(generator));
    const Estimate mean = *MeanOnLogScale(values);
    covered += mean.low <= truth && mean.high >= truth;
  }
  EXPECT_GT(covered / double{kTrials}, 0.9);
}

TEST(Estimate, WhatWasSubtractedWidensTheInterval) {
  const std::vector<double> values = {1, 1.01, 0.99, 1};
  const Estimate sharp = *MeanOnLogScale(values), wide = *MeanOnLogScale(values, 0.1);
  EXPECT_LT(sharp.high, 1.02);
  EXPECT_GT(wide.high, 1.3);
  EXPECT_EQ(sharp.value, wide.value);
}

TEST(Estimate, SignificanceIsRareWhereThereIsNothing) {
  std::mt19937 generator(3);
  std::normal_distribution<double> normal(0, 1);
  int significant = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::vector<double> values(5);
    for (double& v : values) v = normal(generator);
    significant += MeanOf(values).significant;
  }
  EXPECT_NEAR(significant / double{kTrials}, 0.01, 3.5 * 0.1 / 63.2);
  EXPECT_TRUE(MeanOf(std::vector<double>{1, 1.01, 0.99, 1}).significant);
  EXPECT_FALSE(MeanOf(std::vector<double>{1, 1.01, 0.99, 1}, 1).significant);  // known no better than by 1
}

// The jackknife for variances, which are no means.
TEST(Estimate, IntervalOfTheJackknifeCoversAVariance) {
  std::mt19937 generator(5);
  std::uniform_real_distribution<double> uniform(0, 1);
  const auto variance = [](const std::vector<double>& values, size_t without) {
    double sum = 0, squares = 0, n = 0;
    for (size_t i = 0; i < values.size(); ++i) {
      if (i == without) continue;
      sum += values[i];
      squares += values[i] * values[i];
      ++n;
    }
    return (squares - sum * sum / n) / (n - 1);
  };
  int covered = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::vector<double> values(20), without;
    for (double& v : values) v = uniform(generator);
    for (size_t i = 0; i < values.size(); ++i) without.push_back(variance(values, i));
    const double value = variance(values, values.size());
    const SignificantEstimate estimate = JackknifeOf(value, without);
    EXPECT_EQ(estimate.value, value);
    covered += estimate.low <= 1. / 12 && estimate.high >= 1. / 12;
  }
  EXPECT_NEAR(covered / double{kTrials}, 0.95, 2 * kSlack);
}

TEST(Estimate, WhatIsNotKnownIsSaid) {
  EXPECT_TRUE(std::isinf(JackknifeOf(1, {}).high));
  EXPECT_FALSE(MeanOnLogScale(std::vector<double>{-1, -2, 0.5}));
  EXPECT_FALSE(RatioOfMeans(std::vector<double>{1, 2}, std::vector<double>{0, 0}));
  const Estimate single = *MeanOnLogScale(std::vector<double>{3});
  EXPECT_EQ(single.low, 0);
  EXPECT_TRUE(std::isinf(single.high));
  EXPECT_FALSE(MeanOf(std::vector<double>{3}).significant);
}

}  // namespace
}  // namespace lampyr
