// Sums whose order does not show.
#include "math/compensated_sum.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <vector>

namespace lampyr {
namespace {

double Sum(const std::vector<double>& terms) {
  CompensatedSum sum;
  for (const double term : terms) sum.Add(term);
  return sum.Value();
}

TEST(CompensatedSum, KeepsWhatADoubleLoses) {
  EXPECT_EQ(Sum({1, 0x1p-60, -1}), 0x1p-60);
  EXPECT_EQ(Sum({0x1p-60, 1, -1}), 0x1p-60);
  EXPECT_EQ(Sum({1e16, 1, 1, 1, -1e16}), 3);
  CompensatedSum sum;
  sum.Add(1e16);
  EXPECT_EQ(sum.ValueWith(1.0), 1e16);  // rounded, once
  sum.Add(1.0);
  sum.Add(-1e16);
  EXPECT_EQ(sum.ValueWith(0x1p-60), 1.0);
}

// Products of floats over twelve orders of magnitude, as samples of a pixel are.
TEST(CompensatedSum, OrderAndDivisionDoNotShow) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> exponent(-6, 6), factor(-1.5f, 1.5f);
  int naive = 0;
  for (int round = 0; round < 200; ++round) {
    std::vector<double> terms(1000);
    for (double& term : terms)
      term = static_cast<double>(std::pow(10.0f, exponent(random))) * static_cast<double>(factor(random));
    const double forward = Sum(terms);
    const double plain = std::accumulate(terms.begin(), terms.end(), 0.0);
    naive += plain == forward ? 0 : 1;
    std::shuffle(terms.begin(), terms.end(), random);
    EXPECT_EQ(Sum(terms), forward);
    CompensatedSum all;
    for (size_t begin = 0; begin < terms.size();) {
      const size_t end = std::min(terms.size(), begin + 1 + random() % 300);
      CompensatedSum part;
      for (; begin < end; ++begin) part.Add(terms[begin]);
      all.Add(part);
    }
    EXPECT_EQ(all.Value(), forward);
  }
  EXPECT_GT(naive, 100) << "a plain sum would have done";
}

}  // namespace
}  // namespace lampyr
