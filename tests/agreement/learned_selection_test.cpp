// Selection that learns from shadow rays: as right as without, the same for any number of threads, and worth it where
// much of the light that seems near is behind something.
#include <gtest/gtest.h>

#include <array>

#include "agreement/agreement_scenes.h"
#include "integrators/guide/selection_test.h"
#include "sampling/rng.h"
#include "support/replicas.h"
#include "support/selection_noise.h"

namespace lampyr::test {
namespace {

// Two rooms and a wall between them: one is seen, with a few dim lamps; most lamps, and the bright ones, hang in the
// other, and near the wall. Daylight comes in by no more than a slit.
std::string TwoRooms() {
  std::string text = FilmWith("box", 32, 32) +
                     "LookAt -3.8 1 0  -0.5 0.8 0  0 1 0\nCamera \"perspective\" \"float fov\" 70\n" + World(4) +
                     "LightSource \"infinite\" \"rgb L\" [0.5 0.6 0.8]\n";
  Rng rng(1);
  const auto lamp = [&](float x0, float x1, const char* intensity) {
    const Point3 p(x0 + (x1 - x0) * rng.NextFloat(), 0.3f + 1.4f * rng.NextFloat(), 4 * rng.NextFloat() - 2);
    text += "LightSource \"point\" \"point3 from\" [" + std::to_string(p.x) + " " + std::to_string(p.y) + " " +
            std::to_string(p.z) + "] \"rgb I\" [" + intensity + "]\n";
  };
  for (int i = 0; i < 40; ++i) lamp(-3, -0.5f, "0.02 0.02 0.015");
  for (int i = 0; i < 200; ++i) lamp(0.1f, 1.5f, "0.2 0.2 0.2");
  text += "Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5]\n";
  const auto box = [&](const char* points) {
    text += std::string("Shape \"bilinearmesh\" \"point3 P\" [") + points + "]\n";
  };
  box("-4 0 -2.2  4 0 -2.2  -4 0 2.2  4 0 2.2");    // floor
  box("-4 2 -2.2  4 2 -2.2  -4 2 2.1  4 2 2.1");    // ceiling, that leaves a slit
  box("-4 0 -2.2  4 0 -2.2  -4 2 -2.2  4 2 -2.2");  // sides
  box("-4 0 2.2  4 0 2.2  -4 2 2.2  4 2 2.2");
  box("-4 0 -2.2  -4 0 2.2  -4 2 -2.2  -4 2 2.2");  // ends, and the wall
  box("4 0 -2.2  4 0 2.2  4 2 -2.2  4 2 2.2");
  box("0 0 -2.2  0 0 2.2  0 2 -2.2  0 2 2.2");
  return text;
}

RenderOverrides Learning(bool learns) {
  RenderOverrides overrides;
  overrides.values["learn-lights"] = overrides.values["learn-always"] = learns;
  return overrides;
}

class LearnedSelection : public testing::TestWithParam<const char*> {};

TEST_P(LearnedSelection, ChangesTheNoiseAlone) {
  const std::string text = TwoRooms();
  const Replicas without = RenderReplicas(text, "path", 12, 128, Learning(false));
  RenderOverrides overrides = Learning(true);
  overrides.seed = 100;
  const Replicas learned = RenderReplicas(text, GetParam(), 12, 96, overrides);
  const double rate = SidakRate(1e-3, 2);
  const Agreement result = CompareReplicas(learned, without, 8, rate);
  std::printf("%s: %d blocks, largest |z| %.2f (threshold %.2f), chi2 %.1f (%.1f), bias %+.3f %% +- %.3f %%\n",
              GetParam(), result.blocks, result.largestZ, result.thresholdZ, result.chiSquared,
              result.chiSquaredThreshold, 100 * result.bias, 196 * result.biasError);
  EXPECT_TRUE(result.Agrees());
  EXPECT_EQ(learned.faults, 0u);
  EXPECT_FALSE(CompareReplicas(learned, without, 8, rate, 1.03).Agrees()) << "too noisy";
}

INSTANTIATE_TEST_SUITE_P(Integrators, LearnedSelection, testing::Values("path", "bdpt"));

// The learned selection at a transmissive sheet is one for paths from both of its sides. Most lamps near the sheet are
// hidden; a lamp behind it lights it.
TEST(LearnedSelectionSides, OfTransmissiveSurfacesAreOne) {
  std::string text =
      FilmWith("box", 16, 16) + "LookAt 0 0 4  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 26\n" + World(1) +
      "LightSource \"spot\" \"rgb I\" [800 800 800] \"point3 from\" [0 0 -6] \"point3 to\" [0 0 0] \"float "
      "coneangle\" 11 \"float conedeltaangle\" 2\n";
  for (int i = 0; i < 9; ++i) {
    const std::string at = std::to_string(0.6 * (i % 3 - 1)) + " " + std::to_string(0.6 * (i / 3 - 1)) + " -0.2";
    text += "LightSource \"point\" \"rgb I\" [1.5 1.5 1.5] \"point3 from\" [" + at +
            "]\nAttributeBegin Material \"diffuse\" \"rgb reflectance\" [0 0 0] Translate " + at +
            " Shape \"sphere\" \"float radius\" 0.02 AttributeEnd\n";
  }
  text +=
      "Material \"diffusetransmission\" \"rgb reflectance\" [0.4 0.4 0.4] \"rgb transmittance\" [0.4 0.4 0.4] Shape "
      "\"trianglemesh\" \"point3 P\" [-1 -1 0  1 -1 0  1 1 0  -1 1 0] \"integer indices\" [0 1 2 0 2 3]\n";
  const Replicas without = RenderReplicas(text, "bdpt", 12, 200, Learning(false));
  RenderOverrides overrides = Learning(true);
  overrides.seed = 100;
  for (const char* integrator : {"bdpt", "vcm"}) {
    const Agreement result = CompareReplicas(RenderReplicas(text, integrator, 12, 200, overrides), without, 16, 1e-3);
    std::printf("%s: bias %+.3f %% +- %.3f %%\n", integrator, 100 * result.bias, 196 * result.biasError);
    EXPECT_LT(std::abs(result.bias), 4 * result.biasError) << integrator;
    EXPECT_LT(result.biasError, 0.002) << integrator << ": too noisy";
  }
}

TEST(LearnedSelectionNoise, PaysWhereMostOfTheLightIsBehindAWall) {
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  const SceneDescription scene = ParseScene(TwoRooms(), "test.pbrt", diagnostics);
  const std::vector<bool> all(size_t{32} * 32, true);
  for (const char* integrator : {"path", "bdpt"}) {
    const SelectionNoise without = MeasureSelection(scene, all, integrator, "tree", 256, 4);
    const SelectionNoise learned = MeasureSelection(scene, all, integrator, "learned", 256, 4);
    const double variance = learned.meanSquaredError / without.meanSquaredError;
    std::printf("%s: learned %.3f x the variance, %.2f x the time: %.1f x the efficiency\n", integrator, variance,
                learned.seconds / without.seconds, learned.Efficiency() / without.Efficiency());
    EXPECT_LT(variance, integrator == std::string("path") ? 0.4 : 0.7);
  }
}

// The render that a user gets, who asks for nothing.
GuidingStatistics LearnedByDefault(const std::string& text, const char* integrator, int samples, Image* image = nullptr,
                                   bool learns = true) {
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  RenderOverrides overrides;
  overrides.integrator = integrator;
  overrides.values["learn-lights"] = learns;
  overrides.values["guide-paths"] = false;
  const BuiltScene built = BuildScene(ParseScene(text, "test.pbrt", diagnostics), overrides, true, diagnostics);
  const std::unique_ptr<Integrator> made = MakeIntegrator(built.scene, built.settings);
  Film film(built.settings.width, built.settings.height, built.settings.crop);
  ProgressiveRender render(built.scene, *made, built.settings, 2, film);
  render.AddSamples(samples);
  if (image) *image = film.Develop();
  return render.Outcome().guiding;
}

// A room whose lamps light all of it.
std::string OneRoom() {
  std::string text = TwoRooms();
  const std::string wall = "\"point3 P\" [0 0 -2.2  0 0 2.2  0 2 -2.2  0 2 2.2]";
  const size_t at = text.find(wall);
  return text.replace(at, wall.size(), "\"point3 P\" [3.9 0 -2.2  3.9 0 2.2  3.9 2 -2.2  3.9 2 2.2]");
}

TEST(LearnedSelectionByDefault, IsUsedWhereItPays) {
  for (const char* integrator : {"path", "bdpt", "vcm"}) {
    const GuidingStatistics found = LearnedByDefault(TwoRooms(), integrator, 33);
    std::printf("%s: gain %.2f\n", integrator, found.lightGain);
    EXPECT_TRUE(found.usesLearnedLights) << integrator;
    EXPECT_GT(found.lightGain, 1.5) << integrator;
  }
}

// Factors that are not used change no byte of the picture.
TEST(LearnedSelectionByDefault, IsNotUsedWhereItDoesNotPay) {
  for (const char* integrator : {"path", "bdpt", "vcm", "sppm"}) {
    Image learned, without;
    const GuidingStatistics found = LearnedByDefault(OneRoom(), integrator, 9, &learned);
    LearnedByDefault(OneRoom(), integrator, 9, &without, false);
    EXPECT_FALSE(found.usesLearnedLights) << integrator << " " << found.lightGain;
    EXPECT_EQ(learned.data, without.data) << integrator;
  }
}

// The gain that decides is that of the variance of the picture.
TEST(LearnedSelectionByDefault, KnowsTheGain) {
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  const SceneDescription scene = ParseScene(TwoRooms(), "test.pbrt", diagnostics);
  const std::vector<bool> all(size_t{32} * 32, true);
  RenderOverrides overrides;
  overrides.sampler = "independent";  // the test is of independent samples
  overrides.values["guide-paths"] = false;
  const double without = MeasureSelection(scene, all, "path", "tree", 64, 8, overrides).meanSquaredError;
  const double learned = MeasureSelection(scene, all, "path", "learned", 64, 8, overrides).meanSquaredError;
  const double gain = LearnedByDefault(TwoRooms(), "path", 64).lightGain;
  std::printf("estimated %.2f, measured %.2f\n", gain, without / learned);  // factors of the last samples, and of all
  EXPECT_GT(gain, 0.6 * without / learned);
  EXPECT_LT(gain, 1.6 * without / learned);
}

// There is nothing to learn where there is no choice that learning could change.
TEST(LearnedSelectionByDefault, NeedsAChoice) {
  const char* const point = "LightSource \"point\" ";
  const char* const sky = "LightSource \"infinite\" ";
  const std::pair<std::string, bool> scenes[] = {{"", false},
                                                 {point, false},
                                                 {sky, false},
                                                 {std::string(sky) + "LightSource \"distant\"", false},
                                                 {std::string(point) + sky, true},
                                                 {std::string(point) + point, true}};
  for (const auto& [lights, learns] : scenes) {
    Diagnostics diagnostics(Diagnostics::Mode::Collect);
    const SceneDescription scene = ParseScene(FilmWith("box", 4, 4) + World(1) + lights, "test.pbrt", diagnostics);
    EXPECT_EQ(BuildScene(scene, {}, true, diagnostics).scene.lighting->LearnsSelection(), learns) << lights;
  }
}

TEST(SelectionTest, KeepsNothingWithoutATest) {
  TestedSamples samples;
  samples.SetFraction(1, SelectionTest(4, 4, 16, false, true).Tests());
  EXPECT_TRUE(samples.Wants(0));
  samples.Start(0, 0);
  samples.End(1);
  EXPECT_FALSE(samples.Tests());
  EXPECT_TRUE(samples.All().empty());
}

// Two lights that bring 1 and 3, chosen alike or nearly in proportion to that.
TEST(SelectionTest, TellsTheRatioOfVariances) {
  SelectionTest test(4, 4, 16, false, false);
  TestedSamples samples;
  for (int i = 0; i < 2000; ++i) {
    const bool isFirst = i % 2 == 0;
    const float radiance = isFirst ? 2.0f : 6.0f;
    samples.Start(static_cast<uint32_t>(i % 16), static_cast<uint32_t>(i / 16));
    samples.Add(radiance, 0.5f, 0.5f, isFirst ? 0.4f : 0.6f);
    samples.End(radiance);
  }
  const std::array<TestedSamples, 1> all = {samples};
  test.Learn(all);
  test.Decide(1);
  EXPECT_FALSE(test.IsUsed());  // nothing was learned before these
  test.Learn(all);
  test.Decide(2);
  EXPECT_NEAR(test.Gain(), (20.0 - 16) / (17.5 - 16), 0.1);
  EXPECT_TRUE(test.IsUsed());
}

// Neither threads nor the lengths of passes show, whether what is learned is used from the start or once it pays.
TEST(LearnedSelectionBytes, AreThoseOfOneThread) {
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  for (const auto& [integrator, always] : {std::pair("path", true), {"bdpt", true}, {"path", false}, {"bdpt", false}}) {
    RenderOverrides overrides = Learning(true);
    overrides.values["learn-always"] = always;
    overrides.integrator = integrator;
    const BuiltScene built = BuildScene(ParseScene(TwoRooms(), "test.pbrt", diagnostics), overrides, true, diagnostics);
    const Image one = RenderBuilt(built, 13, 1).image;
    EXPECT_EQ(RenderBuilt(built, 13, 3).image.data, one.data) << integrator;
    const std::unique_ptr<Integrator> any = MakeIntegrator(built.scene, built.settings);
    Film film(built.settings.width, built.settings.height, built.settings.crop);
    ProgressiveRender passes(built.scene, *any, built.settings, 2, film);
    for (const int samples : {3, 1, 6, 3}) passes.AddSamples(samples);
    EXPECT_EQ(film.Develop().data, one.data) << integrator;
  }
}

}  // namespace
}  // namespace lampyr::test
