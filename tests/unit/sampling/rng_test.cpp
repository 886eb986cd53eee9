// Derivation of further random numbers from few.
#include <gtest/gtest.h>

#include "sampling/rng.h"

namespace lampyr {
namespace {

// A float's 24 bits leave out three of four items of 2^26; the bits that are appended reach all of them, evenly.
TEST(WithMoreBits, FillsTheGapToTheNextFloat) {
  Rng rng(1);
  constexpr int parts = 16, draws = 160000;
  for (const float u : {0.0f, 0.25f, 0x1.fffffep-1f}) {
    int counts[parts] = {};
    for (int i = 0; i < draws; ++i) {
      const double more = WithMoreBits(u, rng.NextFloat(), rng.NextFloat(), rng.NextFloat());
      ASSERT_GE(more, static_cast<double>(u));
      ASSERT_LT(more, static_cast<double>(u) + 0x1p-24);
      ASSERT_LT(more, 1.0);
      ++counts[static_cast<int>((more - static_cast<double>(u)) * 0x1p24 * parts)];
    }
    for (const int count : counts) EXPECT_NEAR(count, draws / parts, 5 * 100);
  }
  EXPECT_EQ(WithMoreBits(0.3f, 1, 2, 3), WithMoreBits(0.3f, 1, 2, 3));
  EXPECT_NE(WithMoreBits(0.3f, 1, 2, 3), WithMoreBits(0.3f, 1, 3, 2));
}

// Sixteen samples of one point keep a distance, on the torus: 0.17, where 0.27 is the most that there is, and chance
// leaves some two of them 0.04 apart.
TEST(MovedPoint, SpreadsOverTheSquare) {
  Rng rng(2);
  for (int trial = 0; trial < 200; ++trial) {
    const Point2 u = rng.NextPoint2();
    EXPECT_EQ(MovedPoint(u, 0), u);
    for (int k = 0; k < 16; ++k) {
      const Point2 p = MovedPoint(u, k);
      ASSERT_TRUE(p.x >= 0 && p.x < 1 && p.y >= 0 && p.y < 1);
      for (int j = 0; j < k; ++j) {
        const Point2 between = glm::abs(p - MovedPoint(u, j));
        EXPECT_GT(glm::length(glm::min(between, 1.0f - between)), 0.17f);
      }
    }
  }
}

}  // namespace
}  // namespace lampyr
