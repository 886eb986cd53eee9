#include "math/upper_angle.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lampyr {
namespace {

TEST(UpperAngle, IsTheArcTangent) {
  for (int i = 0; i <= 200000; ++i) {
    const double angle = 3.14159265358979323846 * i / 200000;
    for (const double length : {1e-60, 1.0, 1e80}) {
      const double x = length * std::cos(angle), y = length * std::max(std::sin(angle), 0.0);
      const double expected = std::atan2(y, x);
      ASSERT_NEAR(UpperAngle(y, x), expected, 1e-15 * expected + 1e-300) << y << " " << x;
    }
  }
}

TEST(UpperAngle, KeepsTheDigitsOfSmallAngles) {
  for (double y = 1e-30; y < 1; y *= 1.37) EXPECT_NEAR(UpperAngle(y, 1.0), std::atan2(y, 1), 4e-16 * y);
  EXPECT_EQ(UpperAngle(0.0, 1.0), 0);
  EXPECT_NEAR(UpperAngle(0.0, -1.0), 3.14159265358979323846, 1e-15);
  EXPECT_NEAR(UpperAngle(1.0, 0.0), 1.57079632679489661923, 1e-15);
}

TEST(UpperAngle, InFloat) {
  for (int i = 0; i <= 100000; ++i) {
    const double angle = 3.14159265358979323846 * i / 100000;
    const auto x = static_cast<float>(std::cos(angle)), y = static_cast<float>(std::max(std::sin(angle), 0.0));
    const double expected = std::atan2(static_cast<double>(y), static_cast<double>(x));
    ASSERT_NEAR(static_cast<double>(UpperAngle(y, x)), expected, 2.5e-7 * expected);
  }
  EXPECT_EQ(UpperAngle(1e-20f, 1.0f), 1e-20f);
}

TEST(SineCosineOfUpper, AreSineAndCosine) {
  for (int i = 0; i <= 200000; ++i) {
    const double angle = 3.14159265358979323846 * i / 200000;
    const auto [sine, cosine] = SineCosineOfUpper(angle);
    ASSERT_NEAR(sine, std::sin(angle), 3e-16) << angle;
    ASSERT_NEAR(cosine, std::cos(angle), 3e-16) << angle;
  }
  for (double angle = 0.19; angle > 1e-200; angle *= 0.3)
    EXPECT_NEAR(SineCosineOfUpper(angle).sine, std::sin(angle), 3e-16 * angle);
}

}  // namespace
}  // namespace lampyr
