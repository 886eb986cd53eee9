// A ColorTable is a Distribution2D with colours.
#include "sampling/color_table.h"

#include <gtest/gtest.h>

#include "sampling/rng.h"
#include "sampling/tables.h"

namespace lampyr {
namespace {

Color ColorOf(int x, int y) {
  return {static_cast<float>(x), static_cast<float>(y), 0.5f};
}

TEST(ColorTable, IsADistributionWithColors) {
  for (const auto& [width, height] :
       {std::pair(1, 1), std::pair(5, 3), std::pair(37, 64), std::pair(1024, 512), std::pair(70001, 3)}) {
    Rng rng(static_cast<uint64_t>(width));
    std::vector<float> values(static_cast<size_t>(width) * static_cast<size_t>(height));
    for (float& v : values) v = rng.NextFloat() < 0.3f ? 0.0f : std::pow(rng.NextFloat(), 4.0f);
    values[values.size() / 2] = 1000;
    const ColorTable table(values, ColorOf, width, height);
    const Distribution2D distribution(values, width, height);
    ASSERT_FALSE(table.IsZero());
    for (int i = 0; i < 100000; ++i) {
      Point2 u = rng.NextPoint2();
      if (i < 4) u = {i & 1 ? kOneMinusEpsilon : 0.0f, i & 2 ? kOneMinusEpsilon : 0.0f};
      const ColorTable::Cell cell = table.Sample(u);
      const Distribution2D::Result expected = distribution.Sample(u);
      ASSERT_EQ(cell.pdf, expected.pdf);
      ASSERT_EQ(cell.x, static_cast<int>(static_cast<double>(expected.uv.x) * width));
      ASSERT_EQ(cell.y, static_cast<int>(static_cast<double>(expected.uv.y) * height));
      ASSERT_EQ(cell.color.r, static_cast<float>(cell.x));
      ASSERT_EQ(cell.color.g, static_cast<float>(cell.y));
      ASSERT_NEAR(table.At(cell).x, expected.uv.x, 1e-6f);
      ASSERT_NEAR(table.At(cell).y, expected.uv.y, 1e-6f);
      const Point2 anywhere = rng.NextPoint2();
      const ColorTable::Texel texel = table.Look(anywhere);
      ASSERT_EQ(texel.pdf, distribution.Density(anywhere));
      ASSERT_EQ(texel.color.r, static_cast<float>(static_cast<int>(static_cast<double>(anywhere.x) * width)));
    }
  }
}

TEST(ColorTable, WithoutWeightsThereAreColorsOnly) {
  const ColorTable table(std::vector<float>{0, -1, 0, 0, 0, 0}, ColorOf, 3, 2);
  EXPECT_TRUE(table.IsZero());
  EXPECT_EQ(table.Look({0.9f, 0.9f}).pdf, 0.0f);
  EXPECT_EQ(table.Look({0.9f, 0.9f}).color.r, 2.0f);
}

}  // namespace
}  // namespace lampyr
