// Guides: densities are those of the sampling, and integrate to 1; targets are where photons were of use.
#include "lights/selection/emission_guide.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "support/aimed.h"
#include "support/estimate.h"
#include "support/render_scene.h"

namespace lampyr::test {
namespace {

BuiltScene Build(const std::string& lights) {
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  const std::string text = "Film \"rgb\" \"integer xresolution\" 4 \"integer yresolution\" 4\nWorldBegin\n" + lights +
                           "Shape \"sphere\" \"float radius\" 10\n";
  return BuildScene(ParseScene(text, "test.pbrt", diagnostics), {}, true, diagnostics);
}

constexpr const char* kLamps = R"(LightSource "point" "rgb I" [1 1 1] "point3 from" [3 1 0]
LightSource "point" "rgb I" [7 7 7] "point3 from" [-3 1 0]
LightSource "point" "rgb I" [1 1 1] "point3 from" [0 1 3]
)";
constexpr const char* kSky = "LightSource \"infinite\" \"rgb L\" [1 1 1]\n";

TEST(EmissionGuide, DirectionsHaveTheDensityOfTheirSampling) {
  const BuiltScene built = Build(kLamps);
  // From outside both balls, from within one, and from so far that they are as small as directions allow.
  for (const float distance : {2.0f, 0.1f, 30000.0f}) {
    const auto guide = AimAt(*built.scene.lighting, Point3(1, 0, 0), 0.5f);
    const Point3 from(1, distance, 0);
    Rng rng(3);
    Estimate uniform, inverse;
    EmissionGuide::Choice choice;
    int aimed = 0, missed = 0;
    for (int i = 0; i < 200000; ++i) {
      const Vector3 direction = SampleUniformSphere(rng.NextPoint2());
      uniform.Add(static_cast<double>(guide->DirectionDensity(0, from, direction).value * 4 * kPi));
      do {
        choice = guide->Select(rng.NextFloat());
      } while (choice.target == EmissionGuide::kNone);
      const Vector3 sampled = guide->SampleDirection(choice, from, rng.NextPoint2());
      EXPECT_NEAR(glm::length(sampled), 1, 1e-6);
      const auto density = static_cast<double>(guide->DirectionDensity(choice.light, from, sampled).value);
      ++aimed;
      missed += density > 0 ? 0 : 1;
      // ∫ over what can be sampled: the solid angle of the union of both cones, whatever the weights.
      inverse.Add(density > 0 ? 1 / density : 0.0);
    }
    EXPECT_LE(missed, distance > 1000 ? aimed / 200 : aimed / 10000);
    if (distance > 1000) continue;  // uniform directions do not find them
    EXPECT_NEAR(uniform.Mean(), 1, 5 * std::sqrt(uniform.Variance()));
    Estimate covered;
    for (int i = 0; i < 400000; ++i) {
      const Vector3 direction = SampleUniformSphere(rng.NextPoint2());
      covered.Add(guide->DirectionDensity(0, from, direction).value > 0 ? 4 * static_cast<double>(kPi) : 0.0);
    }
    EXPECT_NEAR(inverse.Mean(), covered.Mean(), 5 * std::sqrt(inverse.Variance() + covered.Variance()));
  }
}

TEST(EmissionGuide, LinesHaveTheDensityOfTheirSampling) {
  const BuiltScene built = Build(kSky);
  const auto guide = AimAt(*built.scene.lighting, Point3(1, 0, 0), 0.5f);
  const Vector3 direction = glm::normalize(Vector3(0.3f, -1, 0.2f));
  const Frame frame = Frame::FromNormal(direction);
  constexpr float half = 4;  // of a square that all targets are seen in
  Rng rng(4);
  Estimate integral, covered, inverse;
  for (int i = 0; i < 400000; ++i) {
    const Point2 u = rng.NextPoint2();
    const Point3 on = Point3(1, 0, 0) + half * ((2 * u.x - 1) * frame.x + (2 * u.y - 1) * frame.y) + 7.0f * direction;
    const auto density = static_cast<double>(guide->LineDensity(0, on, direction).value);
    constexpr double area = 4.0 * static_cast<double>(half) * static_cast<double>(half);
    integral.Add(density * area);
    covered.Add(density > 0 ? area : 0.0);
    EmissionGuide::Choice choice;
    do {
      choice = guide->Select(rng.NextFloat());
    } while (choice.target == EmissionGuide::kNone);
    const Point3 sampled = guide->SampleLine(choice, direction, rng.NextPoint2());
    const auto own = static_cast<double>(guide->LineDensity(0, sampled - 5.0f * direction, direction).value);
    inverse.Add(own > 0 ? 1 / own : 0.0);
  }
  EXPECT_NEAR(integral.Mean(), 1, 5 * std::sqrt(integral.Variance()));
  EXPECT_NEAR(inverse.Mean(), covered.Mean(), 5 * std::sqrt(inverse.Variance() + covered.Variance()));
}

TEST(EmissionGuide, LightsAreChosenAsOftenAsItSays) {
  const BuiltScene built = Build(kLamps);
  const LightingServices& lighting = *built.scene.lighting;
  std::vector<UsefulPhoton> useful;
  Rng rng(5);
  for (int i = 0; i < 100; ++i) useful.push_back({0, Point3(rng.NextFloat(), 0, 0), 1, 1, 0.1});
  for (int i = 0; i < 3; ++i) useful.push_back({2, Point3(0, rng.NextFloat(), 0), 2, 4, 0.1});  // too few to aim at
  const EmissionGuide guide(useful, lighting.Lights(), lighting.EmissionSelector(), lighting.SceneSphere());
  EXPECT_GT(guide.ComponentCount(), 1);
  int chosen[3] = {}, aimed[3] = {};
  constexpr int count = 400000;
  for (int i = 0; i < count; ++i) {
    const EmissionGuide::Choice choice = guide.Select((i + 0.5) / count);
    ASSERT_TRUE(choice.exists);
    ++chosen[choice.light];
    aimed[choice.light] += choice.target != EmissionGuide::kNone ? 1 : 0;
    EXPECT_EQ(choice.probability.value, guide.Probability(choice.light).value);
  }
  double sum = 0;
  for (uint32_t light = 0; light < 3; ++light) {
    const auto probability = static_cast<double>(guide.Probability(light).value);
    sum += probability;
    EXPECT_NEAR(chosen[light], probability * count, 3) << light;
    EXPECT_NEAR(aimed[light], static_cast<double>(guide.Share(light)) * probability * count, 3) << light;
    // Never less often than the part that is not guided.
    EXPECT_GE(probability,
              0.9999 * (1 - EmissionGuide::kGuided) *
                  static_cast<double>(lighting.EmissionSelector().Probability({}, light, kAnyPatch).value));
  }
  EXPECT_NEAR(sum, 1, 1e-6);
  EXPECT_GT(guide.Share(0), 0.5f);
  EXPECT_EQ(guide.Share(1), 0);
  EXPECT_EQ(guide.Share(2), 0);
}

// All photons that are sent without a guide are sent with one, at least as often as by its unguided part, and more
// often where they contribute.
TEST(EmissionGuide, GainsWherePhotonsWereOfUse) {
  const BuiltScene built = Build(kSky);
  const auto guide = AimAt(*built.scene.lighting, Point3(1, 0, 0), 0.5f);
  const float radius = built.scene.lighting->SceneSphere().radius;
  const auto own = static_cast<double>(1 / (kPi * radius * radius));
  EXPECT_GT(guide->Gain(0, Point3(1, 0, 0), {0, 1, 0}, own), 10);
  EXPECT_DOUBLE_EQ(guide->Gain(0, Point3(-5, 0, 0), {0, 1, 0}, own), 1 - EmissionGuide::kGuided);
  EXPECT_TRUE(guide->Aims(0, Point3(1, 9, 0), {0, 1, 0}));
  EXPECT_FALSE(guide->Aims(0, Point3(-5, 9, 0), {0, 1, 0}));
}

TEST(EmissionGuide, WithoutUsefulPhotonsNothingIsAimed) {
  const BuiltScene built = Build(kLamps);
  const LightingServices& lighting = *built.scene.lighting;
  const EmissionGuide guide({}, lighting.Lights(), lighting.EmissionSelector(), lighting.SceneSphere());
  EXPECT_EQ(guide.ComponentCount(), 0);
  for (uint32_t light = 0; light < 3; ++light) {
    EXPECT_EQ(guide.Share(light), 0);
    EXPECT_EQ(guide.Probability(light).value, lighting.EmissionSelector().Probability({}, light, kAnyPatch).value);
  }
  EXPECT_EQ(guide.Gain(1, Point3(0.0f), {0, 1, 0}, 0.1), 1);
}

// All photons in one place, and worths of all sizes.
TEST(EmissionGuide, StandsOddPhotons) {
  const BuiltScene built = Build(kLamps);
  const LightingServices& lighting = *built.scene.lighting;
  std::vector<UsefulPhoton> useful;
  for (int i = 0; i < 100; ++i) useful.push_back({0, Point3(1, 0, 0), 1e-30, 1e-60, 1e-3});
  for (int i = 0; i < 100; ++i) useful.push_back({1, Point3(1, 0, 0), 1e30, 1e60, 0});
  const EmissionGuide guide(useful, lighting.Lights(), lighting.EmissionSelector(), lighting.SceneSphere());
  double sum = 0;
  for (uint32_t light = 0; light < 3; ++light) {
    EXPECT_TRUE(std::isfinite(guide.Probability(light).value));
    EXPECT_TRUE(std::isfinite(guide.Share(light)));
    sum += static_cast<double>(guide.Probability(light).value);
  }
  EXPECT_NEAR(sum, 1, 1e-5);
  for (int i = 0; i < 1000; ++i) {
    const EmissionGuide::Choice choice = guide.Select(i / 1000.0);
    ASSERT_TRUE(choice.exists);
    if (choice.target == EmissionGuide::kNone) continue;
    EXPECT_TRUE(IsFinite(guide.SampleDirection(choice, Point3(3, 1, 0), Point2(0.3f, 0.7f))));
  }
}

}  // namespace
}  // namespace lampyr::test
