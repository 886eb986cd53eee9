// Quantiles against published tables and against their own inverses.
#include <gtest/gtest.h>

#include <cmath>

#include "film/metrics.h"

namespace lampyr {
namespace {

TEST(Quantiles, NormalTable) {
  EXPECT_NEAR(NormalQuantileTwoSided(0.05), 1.959963984540054, 1e-12);
  EXPECT_NEAR(NormalQuantileTwoSided(0.01), 2.575829303548901, 1e-12);
  EXPECT_NEAR(NormalQuantileTwoSided(0.5), 0.6744897501960817, 1e-12);
  EXPECT_NEAR(NormalQuantileTwoSided(1e-9), 6.109410204869, 1e-9);
  EXPECT_EQ(NormalQuantileTwoSided(1.0), 0);
  for (const double p : {0.999, 1e-3, 1e-20, 1e-200}) {
    EXPECT_NEAR(std::erfc(NormalQuantileTwoSided(p) / std::sqrt(2.0)) / p, 1, 1e-10) << p;
  }
}

TEST(Quantiles, ChiSquaredTable) {
  EXPECT_NEAR(ChiSquaredQuantile(0.05, 1), 3.841458820694124, 1e-10);
  EXPECT_NEAR(ChiSquaredQuantile(0.01, 10), 23.20925115895436, 1e-9);
  EXPECT_NEAR(ChiSquaredQuantile(0.05, 100), 124.3421134, 1e-6);
  EXPECT_NEAR(ChiSquaredQuantile(0.95, 2), 0.102586588775101, 1e-10);
  EXPECT_NEAR(ChiSquaredQuantile(0.001, 64), 104.7164, 1e-3);
  EXPECT_NEAR(ChiSquaredTail(2.0, 2), std::exp(-1.0), 1e-14);
  EXPECT_NEAR(ChiSquaredTail(200.0, 2) / std::exp(-100.0), 1, 1e-12);
}

TEST(Quantiles, ChiSquaredInvertsItsTail) {
  for (const double degrees : {1.0, 2.0, 7.0, 64.0, 1000.0, 65536.0, 1e6}) {
    for (const double p : {1e-12, 1e-6, 1e-3, 0.1, 0.5, 0.9, 0.999}) {
      EXPECT_NEAR(ChiSquaredTail(ChiSquaredQuantile(p, degrees), degrees) / p, 1, 1e-6) << degrees << " " << p;
    }
  }
  EXPECT_EQ(ChiSquaredTail(0, 5), 1);
  EXPECT_EQ(ChiSquaredQuantile(1, 5), 0);
  EXPECT_EQ(ChiSquaredQuantile(0.1, 0), 0);
}

TEST(Quantiles, StudentTable) {
  EXPECT_NEAR(StudentQuantileTwoSided(0.05, 1), 12.7062047361747, 1e-9);
  EXPECT_NEAR(StudentQuantileTwoSided(0.05, 4), 2.77644510519779, 1e-10);
  EXPECT_NEAR(StudentQuantileTwoSided(0.01, 9), 3.2498355415921, 1e-10);
  EXPECT_NEAR(StudentQuantileTwoSided(0.001, 2), 31.599054576443, 1e-8);
  EXPECT_NEAR(StudentQuantileTwoSided(0.05, 100), 1.98397151845, 1e-8);
  EXPECT_LT(StudentQuantileTwoSided(0.05, 2.5), StudentQuantileTwoSided(0.05, 2));
  EXPECT_GT(StudentQuantileTwoSided(0.05, 2.5), StudentQuantileTwoSided(0.05, 3));
  EXPECT_NEAR(StudentQuantileTwoSided(0.05, 1e6), NormalQuantileTwoSided(0.05), 1e-5);
  EXPECT_NEAR(StudentQuantileTwoSided(0.05, 1e9), NormalQuantileTwoSided(0.05), 1e-12);
}

TEST(Quantiles, Sidak) {
  EXPECT_NEAR(SidakRate(0.05, 10), 0.005116196891823743, 1e-15);
  EXPECT_NEAR(SidakRate(1e-3, 1000000), 1.000500333083e-9, 1e-20);
  EXPECT_EQ(SidakRate(0.05, 1), 0.05);
  EXPECT_EQ(SidakRate(0.05, 0), 0.05);
}

}  // namespace
}  // namespace lampyr
