// Motion by hand: parts of a transform half way, keys over the shutter, times outside of the motion.
#include <gtest/gtest.h>

#include <random>

#include "base/error.h"
#include "math/motion.h"

namespace lampyr {
namespace {

const FileLocation kWhere;

AnimatedTransform Between(const Transform& start, const Transform& end) {
  return AnimatedTransform(start, end, "a shape", kWhere);
}

void ExpectNear(const Point3d& a, const Point3d& b, double tolerance = 1e-12) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
}

TEST(AnimatedTransform, HalfOfATurnOfATranslationAndOfAScale) {
  const double root = std::sqrt(0.5);
  const AnimatedTransform turn = Between(Transform(), Transform::Rotate(90, {0, 0, 1}));
  ExpectNear(turn.At(0.5).Point({1, 0, 0}), {root, root, 0});
  ExpectNear(turn.At(1.0 / 3).Point({1, 0, 0}), {std::cos(M_PI / 6), std::sin(M_PI / 6), 0});
  const AnimatedTransform shift = Between(Transform::Translate({1, 0, 0}), Transform::Translate({3, -2, 8}));
  ExpectNear(shift.At(0.25).Point({0, 0, 0}), {1.5, -0.5, 2});
  const AnimatedTransform scale = Between(Transform::Scale({1, 2, 3}), Transform::Scale({2, 6, 4}));
  ExpectNear(scale.At(0.5).Point({1, 1, 1}), {1.5, 4, 3.5});
}

TEST(AnimatedTransform, ProductsAreTakenApart) {
  // Translation · rotation · scale: each part is half way, applied in that order.
  const Transform start = Transform::Translate({0, 0, 2}) * Transform::Scale({2, 1, 1});
  const Transform end =
      Transform::Translate({4, 0, 2}) * Transform::Rotate(90, {0, 0, 1}) * Transform::Scale({4, 3, 1});
  const double root = std::sqrt(0.5);
  // (1,1,1) scaled by (3,2,1), turned by 45°, moved by (2,0,2).
  ExpectNear(Between(start, end).At(0.5).Point({1, 1, 1}), {2 + root * (3 - 2), root * (3 + 2), 3});
  // Scaled after it is turned: the stretch of the decomposition is not diagonal, the ends are still met.
  const Transform sheared = Transform::Scale({1, 3, 1}) * Transform::Rotate(30, {0, 0, 1});
  const AnimatedTransform animated = Between(start, sheared);
  ExpectNear(animated.At(1 - 1e-13).Point({1, 2, 3}), sheared.Point({1, 2, 3}), 1e-11);
  ExpectNear(animated.At(1e-13).Point({1, 2, 3}), start.Point({1, 2, 3}), 1e-11);
}

TEST(AnimatedTransform, TurnsTheShorterWay) {
  const AnimatedTransform turn = Between(Transform(), Transform::Rotate(270, {0, 0, 1}));
  const double root = std::sqrt(0.5);
  ExpectNear(turn.At(0.5).Point({1, 0, 0}), {root, -root, 0});
  // Half a turn has no shorter way; it is one of the two, and as long as it was.
  const Point3d half = Between(Transform(), Transform::Rotate(180, {0, 0, 1})).At(0.5).Point({1, 0, 0});
  EXPECT_NEAR(std::abs(half.y), 1, 1e-12);
}

TEST(AnimatedTransform, MirroredAtBothEnds) {
  const Transform mirror = Transform::Scale({-1, 1, 1});
  const AnimatedTransform turn = Between(mirror, Transform::Rotate(90, {0, 0, 1}) * mirror);
  const double root = std::sqrt(0.5);
  ExpectNear(turn.At(0.5).Point({1, 0, 0}), {-root, -root, 0});
  EXPECT_TRUE(turn.At(0.5).SwapsHandedness());
}

TEST(AnimatedTransform, MirroredAtOneEndIsAnError) {
  EXPECT_THROW(Between(Transform(), Transform::Scale({-1, 1, 1})), Error);
  glm::dmat4 perspective(1.0);
  perspective[2][3] = 1;
  EXPECT_THROW(Between(Transform(), Transform(perspective)), Error);
}

TEST(Motion, WhatIsOverAsTheShutterOpensIsAtItsEnd) {
  EXPECT_EQ((MotionTimes{0, 0}.FractionAt(0)), 1);
  EXPECT_EQ((MotionTimes{0.5, 0.5}.FractionAt(0.25)), 0);
  EXPECT_EQ((MotionTimes{-1, 0}.FractionAt(0)), 1);
}

TEST(Motion, TimesAreClampedToTheMotion) {
  const MotionTimes times{0.25, 0.75};
  EXPECT_EQ(times.FractionAt(0), 0);
  EXPECT_EQ(times.FractionAt(0.25), 0);
  EXPECT_DOUBLE_EQ(times.FractionAt(0.5), 0.5);
  EXPECT_EQ(times.FractionAt(1), 1);
  const MotionChain chain(MotionChain() * Between(Transform(), Transform::Translate({8, 0, 0})));
  const auto motion = MakeMotion(chain, times, {}, "a shape", kWhere);
  ASSERT_TRUE(motion);
  EXPECT_EQ(motion->Keys().size(), 2u);  // linear in the matrix
  for (const auto& [time, x] : {std::pair(0.0f, 0.0f),
                                {0.2f, 0.0f},
                                {0.25f, 0.0f},
                                {0.375f, 2.0f},
                                {0.5f, 4.0f},
                                {0.75f, 8.0f},
                                {0.8f, 8.0f},
                                {1.0f, 8.0f}}) {
    EXPECT_NEAR(motion->At(time).translation.x, x, 1e-6f) << time;
  }
}

TEST(Motion, ShutterThatSeesAPartOfIt) {
  const MotionChain chain(MotionChain() * Between(Transform(), Transform::Translate({8, 0, 0})));
  // The transform times are twice as long as the shutter and begin before it.
  const auto motion = MakeMotion(chain, {-0.5, 1.5}, {}, "a shape", kWhere);
  ASSERT_TRUE(motion);
  EXPECT_NEAR(motion->At(0).translation.x, 2, 1e-6);
  EXPECT_NEAR(motion->At(0.5f).translation.x, 4, 1e-6);
  EXPECT_NEAR(motion->At(1).translation.x, 6, 1e-6);
  // Before and after the motion nothing moves.
  EXPECT_FALSE(MakeMotion(chain, {1, 2}, {}, "a shape", kWhere));
  EXPECT_FALSE(MakeMotion(chain, {-2, 0}, {}, "a shape", kWhere));
  EXPECT_FALSE(MakeMotion(MotionChain(Transform::Scale({2, 2, 2})), {0, 1}, {}, "a shape", kWhere));
  // A motion without duration jumps.
  const auto jump = MakeMotion(chain, {0.5, 0.5}, {}, "a shape", kWhere);
  ASSERT_TRUE(jump);
  EXPECT_EQ(jump->At(0.4f).translation.x, 0);
  EXPECT_EQ(jump->At(0.6f).translation.x, 8);
}

TEST(Motion, KeysFollowTheMotion) {
  std::mt19937 generator(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto random = [&] { return Vector3d(uniform(generator), uniform(generator), uniform(generator)); };
  const auto randomTransform = [&](double largestAngle) {
    return Transform::Translate(random() * 3.0) * Transform::Rotate(largestAngle * uniform(generator), random()) *
           Transform::Scale(Vector3d(1.2) + random());
  };
  Bounds3 box;
  box.Add(Point3(-1, 0, 0.5f));
  box.Add(Point3(2, 1, 1));
  const double diagonal = glm::length(Vector3d(box.Diagonal()));
  size_t most = 0;
  for (int i = 0; i < 50; ++i) {
    const Transform start = randomTransform(30);
    MotionChain chain = MotionChain() * Between(start, randomTransform(30) * start);
    if (i % 2) chain = chain * Between(Transform(), Transform::Rotate(20, random()));
    const auto motion = MakeMotion(chain, {0, 1}, box, "a shape", kWhere);
    ASSERT_TRUE(motion);
    most = std::max(most, motion->Keys().size());
    for (int k = 0; k <= 1000; ++k) {
      const float time = static_cast<float>(k) / 1000;
      const Transform exact = chain.At(static_cast<double>(time));
      const Affine key = motion->At(time);
      for (int c = 0; c < 8; ++c) {
        const double deviation = glm::length(Point3d(key.Point(box.Corner(c))) - exact.Point(Point3d(box.Corner(c))));
        // Scaled by at most 2.2, twice: the size of the box as placed, generously.
        ASSERT_LT(deviation, 2e-5 * diagonal * 5) << i << " " << time;
      }
    }
  }
  EXPECT_LE(most, size_t{kMaxMotionKeys});
  EXPECT_GT(most, 8u);
}

TEST(Motion, RotationsStayWithinTheirTolerance) {
  for (const double degrees : {10.0, 90.0, 179.0}) {
    const MotionChain chain(MotionChain() * Between(Transform(), Transform::Rotate(degrees, {0, 0, 1})));
    const auto motion = MakeMotion(chain, {0, 1}, {}, "a shape", kWhere);
    double worst = 0;
    for (int k = 0; k <= 4000; ++k) {
      const float time = static_cast<float>(k) / 4000;
      const Point3d p = chain.At(static_cast<double>(time)).Point({1, 1, 0});
      worst = std::max(worst, glm::length(p - Point3d(motion->At(time).Point({1, 1, 0}))));
    }
    const double size = 2 * std::sqrt(3);
    EXPECT_LT(worst / size, degrees > 100 ? 4e-5 : 2e-5) << degrees;
    EXPECT_GT(worst / size, 1e-6) << degrees;  // and there are not more keys than it takes
  }
}

TEST(Motion, ChainsKeepWhatStaysAsOneProduct) {
  const Transform a = Transform::Rotate(20, {1, 2, 3}), b = Transform::Translate({0.1, 0.2, 0.3});
  const MotionChain chain = MotionChain(a) * AnimatedTransform(b);
  EXPECT_FALSE(chain.IsAnimated());
  EXPECT_TRUE(chain.At(0) == a * b);
  const MotionChain moving = chain * Between(Transform(), Transform::Translate({1, 0, 0})) * AnimatedTransform(b);
  EXPECT_TRUE(moving.IsAnimated());
  ExpectNear(moving.At(0.5).Point({1, 1, 1}),
             (a * b).Point(Transform::Translate({0.5, 0, 0}).Point(b.Point({1, 1, 1}))));
}

TEST(Motion, BeyondFloatIsAnError) {
  const MotionChain chain(MotionChain() * Between(Transform(), Transform::Translate({1e30, 0, 0})));
  EXPECT_THROW(MakeMotion(chain, {0, 1}, {}, "a shape", kWhere), Error);
}

}  // namespace
}  // namespace lampyr
