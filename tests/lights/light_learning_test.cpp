// Learning of clusters: from recorded samples, from nothing else, and only when it is frozen.
#include "lights/selection/light_learning.h"

#include <gtest/gtest.h>

#include <cmath>
#include <thread>
#include <vector>

namespace lampyr {
namespace {

const BoundingSphere kScene{Point3(1, 2, 3), 10};

Receiver At(const Point3& position, const Normal3& normal) {
  Receiver receiver;
  receiver.position = position;
  receiver.normal = normal;
  return receiver;
}

// Factor of a child whose parent has the factor `parent`.
double FactorOf(const LightLearning& learning, uint32_t region, uint32_t node, int child, double parent = 1) {
  const LightLearning::Row& row = learning.RowOf(region, node);
  return std::sqrt(static_cast<double>(row.known[child]) +
                   (1 - static_cast<double>(row.learned[child])) * parent * parent);
}

TEST(LightLearning, WithoutRecordsEverythingIsAsItsParent) {
  const LightLearning learning(kScene);
  for (int child = 0; child < LightLearning::kWidth; ++child) {
    EXPECT_FLOAT_EQ(1, static_cast<float>(FactorOf(learning, 7, 3, child)));
    EXPECT_FLOAT_EQ(0.25f, static_cast<float>(FactorOf(learning, 7, 3, child, 0.25)));
  }
}

TEST(LightLearning, RecordsCountFromTheNextFreezeOn) {
  LightLearning learning(kScene);
  for (int i = 0; i < 1000; ++i) learning.Record(7, 3, 2, 0);
  EXPECT_FLOAT_EQ(1, static_cast<float>(FactorOf(learning, 7, 3, 2)));
  learning.Freeze();
  EXPECT_LT(FactorOf(learning, 7, 3, 2), 0.1);
  EXPECT_GT(FactorOf(learning, 7, 3, 2), 0);  // what was never seen keeps a chance
  EXPECT_FLOAT_EQ(1, static_cast<float>(FactorOf(learning, 7, 3, 1)));
  EXPECT_FLOAT_EQ(1, static_cast<float>(FactorOf(learning, 8, 3, 2)));
  EXPECT_FLOAT_EQ(1, static_cast<float>(FactorOf(learning, 7, 4, 2)));
}

TEST(LightLearning, FactorsTendToTheRootOfTheMeanSquare) {
  LightLearning learning(kScene);
  for (int i = 0; i < 4000; ++i) learning.Record(1, 0, 5, i % 4 == 0 ? 2 : 0);
  learning.Freeze();
  EXPECT_NEAR(1, FactorOf(learning, 1, 0, 5), 2e-3);
}

TEST(LightLearning, NoRatioIsTooLargeOrTooOdd) {
  LightLearning learning(kScene);
  const double odd[] = {1e300, HUGE_VAL, -1, std::nan("")};
  for (const double ratio : odd) learning.Record(1, 0, 0, ratio);
  learning.Freeze();
  const double factor = FactorOf(learning, 1, 0, 0);
  EXPECT_TRUE(std::isfinite(factor));
  EXPECT_GT(factor, 1);
}

TEST(LightLearning, ThreadsAndOrderDoNotMatter) {
  LightLearning one(kScene), many(kScene);
  const auto record = [](LightLearning& learning, int first, int step) {
    for (int i = first; i < 4000; i += step)
      learning.Record(static_cast<uint32_t>(i % 3), 0, i % LightLearning::kWidth, 0.37 * (i % 11));
  };
  record(one, 0, 1);
  std::vector<std::thread> threads;
  for (int t = 3; t >= 0; --t) threads.emplace_back([&, t] { record(many, t, 4); });
  for (std::thread& thread : threads) thread.join();
  one.Freeze();
  many.Freeze();
  for (uint32_t region = 0; region < 3; ++region) {
    for (int child = 0; child < LightLearning::kWidth; ++child) {
      EXPECT_EQ(one.RowOf(region, 0).known[child], many.RowOf(region, 0).known[child]);
      EXPECT_EQ(one.RowOf(region, 0).learned[child], many.RowOf(region, 0).learned[child]);
    }
  }
}

TEST(LightLearning, RegionsArePlacesAndSides) {
  const LightLearning learning(kScene);
  const uint32_t floor = learning.RegionOf(At({1, 2, 3}, {0, 1, 0}));
  EXPECT_EQ(floor, learning.RegionOf(At({1.01f, 2.01f, 3.01f}, {0.1f, 0.99f, 0})));
  EXPECT_NE(floor, learning.RegionOf(At({1, 2, 3}, {0, -1, 0})));
  EXPECT_NE(floor, learning.RegionOf(At({1, 2, 3}, {1, 0, 0})));
  EXPECT_NE(floor, learning.RegionOf(At({4, 2, 3}, {0, 1, 0})));
  for (const Normal3& normal :
       {Normal3(1, 0, 0), Normal3(-1, 0, 0), Normal3(0, 1, 0), Normal3(0, -1, 0), Normal3(0, 0, 1), Normal3(0, 0, -1)})
    EXPECT_NE(learning.RegionOf(Receiver::InMedium({1, 2, 3})), learning.RegionOf(At({1, 2, 3}, normal)));
  // Far outside the scene, too.
  learning.RegionOf(At({1e30f, -1e30f, 1e30f}, {0, 1, 0}));
}

}  // namespace
}  // namespace lampyr
