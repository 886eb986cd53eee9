// Comparing integrators: what is measured is what is there.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "app/compare/comparison.h"
#include "app/compare/first_look.h"
#include "app/compare/neighbourhood.h"
#include "app/compare/report.h"
#include "app/json_report.h"
#include "film/metrics.h"
#include "support/render_scene.h"
#include "support/temporary_folder.h"

namespace lampyr {
namespace {

const std::string kCamera = R"(LookAt 0 2.2 2.6  0 0.3 0  0 1 0
Film "rgb" "integer xresolution" 24 "integer yresolution" 24
Camera "perspective" "float fov" 42
Integrator "path" "integer maxdepth" 5
WorldBegin
Material "diffuse" "rgb reflectance" [0.6 0.5 0.4]
Shape "trianglemesh" "point3 P" [-2.5 0 -2.5  -2.5 0 2.5  2.5 0 2.5  2.5 0 -2.5] "integer indices" [0 1 2 0 2 3]
)";
const std::string kLamp = R"(AttributeBegin
AreaLightSource "diffuse" "rgb L" [30 28 26]
Translate 0.8 2 0.2 Shape "sphere" "float radius" 0.2
AttributeEnd
)";
// No path from the camera finds the light that the point light sends through the ball.
const std::string kCaustic = R"(AttributeBegin
Material "dielectric" "float eta" 1.5
Translate 0 0.6 0 Shape "sphere" "float radius" 0.5
AttributeEnd
LightSource "point" "rgb I" [9 9 9] "point3 from" [0.4 2.5 0]
)";

const std::atomic<bool> kNever{false};

BuiltScene Build(const std::string& text) {
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  return BuildScene(ParseScene(text, "test.pbrt", diagnostics), {}, true, diagnostics);
}

const ReferenceProgress kQuiet = [](double, const std::string&) {};

TEST(ComparedScene, LooksAreTakenAtTheirMilestonesAndChangeNothing) {
  const BuiltScene built = Build(kCamera + kLamp);
  const ComparedScene scene(built, 2, kNever);
  std::vector<int> samples(5);
  Image last, alone;
  const auto look = [&](size_t index, const ComparedScene::Milestone& reached, const Image& image) {
    samples[index] = reached.samplesPerPixel;
    if (index < 2) {
      EXPECT_GT(reached.seconds, index == 0 ? 0.03 : 0.06);
    }
    if (index == 4) last = image;
  };
  scene.Render("path", 7, {0.05, 0.1}, {3, 8, 50}, look, [](double) {});
  EXPECT_EQ(samples[2], 3);
  EXPECT_EQ(samples[3], 8);
  EXPECT_EQ(samples[4], 50);
  EXPECT_GE(samples[1], samples[0]);
  scene.Render(
      "path", 7, {}, {50}, [&](size_t, const auto&, const Image& image) { alone = image; }, [](double) {});
  EXPECT_EQ(last.data, alone.data);
}

TEST(ComparedScene, AnInterruptEndsIt) {
  const BuiltScene built = Build(kCamera + kLamp);
  const std::atomic<bool> interrupted{true};
  const ComparedScene scene(built, 2, interrupted);
  const auto look = [](size_t, const auto&, const Image&) {};
  EXPECT_THROW(scene.Render("path", 0, {}, {4096}, look, [](double) {}), ComparisonInterrupted);
}

TEST(Reference, IsMadeByWhatFindsAllTheLight) {
  std::string text = kCamera + kCaustic;
  text.replace(text.find("\"float fov\" 42"), 14, "\"float fov\" 20");
  const BuiltScene built = Build(text);
  // Three times as long as it takes: on a busy machine there are fewer samples in the same time.
  for (const Pilot& pilot : FlyPilots(ComparedScene(built, 2, kNever), 1, 10, kQuiet)) {
    if (pilot.integrator == "path") {  // its picture has no noise to speak of, and no caustic
      EXPECT_FALSE(pilot.chosen);
      EXPECT_TRUE(pilot.isFlawed);
      EXPECT_NE(pilot.note.find("finds less light than "), std::string::npos) << pilot.note;
    }
    // bdpt misses what of the caustic is seen through the ball. A picture without it is no reference.
    if (pilot.integrator == "vcm") {
      EXPECT_TRUE(pilot.chosen);
      EXPECT_NE(pilot.note.find("finds light that the others m"), std::string::npos) << pilot.note;
    }
    if (pilot.integrator == "bdpt") {
      EXPECT_FALSE(pilot.chosen);
      EXPECT_NE(pilot.note.find("cannot find all light"), std::string::npos) << pilot.note;
    }
    EXPECT_GT(pilot.samplesPerPixel, 0);
    EXPECT_GT(pilot.seconds, 0.5);
  }
}

// Under a lamp with an extent path and bdpt find everything.
TEST(Reference, IsNotBlurredWhereThatIsNotWorthIt) {
  std::string text = kCamera + kCaustic;
  text.replace(text.find("LightSource"), std::string::npos, kLamp);
  const BuiltScene built = Build(text);
  for (const Pilot& pilot : FlyPilots(ComparedScene(built, 2, kNever), 0.3, 3, kQuiet)) {
    EXPECT_FALSE(pilot.chosen && pilot.isFlawed) << pilot.integrator << ": " << pilot.note;
    if (pilot.integrator == "vcm") {
      EXPECT_FALSE(pilot.chosen) << pilot.note;
      EXPECT_NE(pilot.note.find(" in the same time"), std::string::npos) << pilot.note;
      EXPECT_FALSE(pilot.isFlawed);
    }
  }
}

// The caustic, seen in a mirror.
TEST(Reference, IsMadeWithPhotonsWhereNothingElseFindsTheLight) {
  std::string text = kCamera + kCaustic;
  text.replace(0, text.find("Film"), "LookAt 0 1.2 -1  0 0.2 1.5  0 1 0\n");
  text +=
      "Material \"conductor\" \"rgb reflectance\" [ 0.9 0.9 0.9 ]\n"
      "Shape \"bilinearmesh\" \"point3 P\" [ -2 0 1.5  2 0 1.5  -2 3 1.5  2 3 1.5 ]\n";
  const BuiltScene built = Build(text);
  for (const Pilot& pilot : FlyPilots(ComparedScene(built, 2, kNever), 1.5, 15, kQuiet))
    EXPECT_EQ(pilot.chosen, pilot.integrator == "vcm") << pilot.integrator << ": " << pilot.note;
}

TEST(Reference, ItsErrorIsWhatItSays) {
  const BuiltScene built = Build(kCamera + kLamp);
  const ComparedScene scene(built, 2, kNever);
  const Reference coarse = MakeReference(scene, "bdpt", 1, 8 * 16, kQuiet);  // 16 samples each
  EXPECT_EQ(coarse.facts.samplesPerPixel, 128);
  const Reference fine = MakeReference(scene, "path", 1, 8 * 1024, kQuiet);
  const double error = CompareImages(coarse.image, fine.image).mse;
  EXPECT_NEAR(error / *coarse.facts.mse, 1, 0.25);
  EXPECT_NEAR(coarse.facts.mean / fine.facts.mean, 1, 4 * coarse.noise.meanError);
}

// Its distance from the picture of an integrator that blurs nothing is no larger than it says, and radii are so small
// that what is told of a bias is below the noise.
TEST(Reference, WhatMergingBlursIsBoundedAndBelowTheNoise) {
  const BuiltScene built = Build(kCamera + kCaustic);
  const ComparedScene scene(built, 2, kNever);
  const Reference sharp = MakeReference(scene, "bdpt", 1, 8 * 512, kQuiet);
  EXPECT_EQ(*sharp.facts.bias, 0);
  EXPECT_EQ(*sharp.facts.radius, 0);
  EXPECT_EQ(sharp.blur.relMseLimit, 0);
  // With twice the samples, and more, the noise is below the blur of the least radius that a reference takes.
  const Reference noisy = MakeReference(scene, "vcm", 1, 16 * 8, kQuiet);
  EXPECT_LT(noisy.blur.relMse, *noisy.facts.relMse);
  const Reference merged = MakeReference(scene, "vcm", 1, 32 * 8, kQuiet);
  EXPECT_LT(*merged.facts.radius, 0.5);
  EXPECT_LE(merged.blur.relMse, merged.blur.relMseLimit);
  // The squared distance is that of the blur and of both noises.
  Image plain = ChannelsOf(merged.image, {"R", "G", "B"});
  const double distance = MeasureError(plain, sharp.image).relMse;
  EXPECT_LT(distance, *merged.facts.relMse + merged.blur.relMseLimit + 4 * merged.noise.relMseError);
  EXPECT_LT(std::abs(merged.facts.mean / sharp.facts.mean - 1),
            merged.blur.meanLimit + 4 * (merged.noise.meanError + sharp.noise.meanError));
}

TEST(Reference, SettingsOfTheSceneDoNotBiasIt) {
  BuiltScene built = Build(kCamera + kLamp);
  built.settings.values.Set("alpha", 1.0);
  built.settings.values.Set("radius", 0.5);
  MakeConsistent(built.settings.values);
  EXPECT_EQ(built.settings.values.Number("alpha"), 2. / 3);
  EXPECT_EQ(built.settings.values.Number("radius"), 0);
}

TEST(Reference, BlackPicturesAndExtremesOfRadiance) {
  // The lamp lights nothing that is seen.
  const BuiltScene black = Build("LookAt 0 1 0  0 10 0  0 0 1\n" + kCamera.substr(kCamera.find("Film")) + kLamp);
  for (const Pilot& pilot : FlyPilots(ComparedScene(black, 2, kNever), 0.05, 0.5, kQuiet)) EXPECT_EQ(pilot.mean, 0);
  for (const char* radiance : {"1e-30 1e-30 1e-30", "1e30 1e30 1e30"}) {
    std::string lamp = kLamp;
    lamp.replace(lamp.find("30 28 26"), 8, radiance);
    const BuiltScene built = Build(kCamera + lamp);
    const ComparedScene scene(built, 2, kNever);
    for (const Pilot& pilot : FlyPilots(scene, 0.2, 2, kQuiet)) {
      EXPECT_GT(pilot.relMse, 1e-9) << radiance;
      EXPECT_LT(pilot.relMse, 10) << radiance;
    }
    const Reference reference = MakeReference(scene, "path", 1, 8 * 16, kQuiet);
    EXPECT_GT(*reference.facts.relMse, 1e-8) << radiance;
    EXPECT_LT(*reference.facts.relMse, 0.01) << radiance;
  }
}

TEST(Reference, OneThatIsGivenIsThatPartOfTheImage) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.Path() / "given.exr";
  BuiltScene built = Build(kCamera + kLamp);
  built.settings.crop = {0, 0, 12, 10};
  WriteExr(file, test::RenderBuilt(built, 4, 2).image, ExrPrecision::Float);
  const Reference reference = ReadReference(file, built.settings);
  EXPECT_TRUE(reference.facts.noiseIsLimit);  // stratified samples: a bound
  EXPECT_GT(*reference.facts.relMse, 0);
  EXPECT_FALSE(NoiseOf(reference.image, 8));  // and nothing is subtracted
  built.settings.crop = {12, 10, 24, 20};
  EXPECT_THROW(ReadReference(file, built.settings), UsageError);
}

TEST(Reference, IsKeptWhileItIsOfTheSamePicture) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.Path() / "reference.exr";
  const BuiltScene built = Build(kCamera + kLamp);
  const ComparedScene scene(built, 2, kNever);
  const std::string key = ReferenceKey(scene, "hash");
  EXPECT_EQ(key, ReferenceKey(ComparedScene(built, 1, kNever), "hash"));
  EXPECT_NE(key, ReferenceKey(scene, "other"));
  const BuiltScene brighter = Build(kCamera + kLamp + kLamp);
  EXPECT_NE(key, ReferenceKey(ComparedScene(brighter, 2, kNever), "hash"));

  EXPECT_FALSE(FindKeptReference(file, key, 0));
  const Reference made = MakeReference(scene, "path", 1, 8 * 16, kQuiet);
  KeepReference(made, key, 5, file);
  const auto kept = FindKeptReference(file, key, 5);
  ASSERT_TRUE(kept);
  EXPECT_EQ(kept->image.data, made.image.data);
  EXPECT_EQ(kept->facts.origin, ComparisonReference::Origin::Cached);
  EXPECT_EQ(*kept->facts.relMse, *made.facts.relMse);
  EXPECT_EQ(kept->noise.meanError, made.noise.meanError);
  EXPECT_EQ(*kept->facts.bias, 0);
  EXPECT_FALSE(FindKeptReference(file, key + "x", 0));
  EXPECT_FALSE(FindKeptReference(file, key, 5.1));
  std::filesystem::resize_file(file, std::filesystem::file_size(file) / 2);
  EXPECT_FALSE(FindKeptReference(file, key, 0));
}

TEST(Reference, KeepsWhatItKnowsOfItsBlur) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.Path() / "reference.exr";
  const BuiltScene built = Build(kCamera + kCaustic);
  const Reference made = MakeReference(ComparedScene(built, 2, kNever), "vcm", 1, 32 * 4, kQuiet);
  KeepReference(made, "key", 5, file);
  const auto kept = FindKeptReference(file, "key", 5);
  ASSERT_TRUE(kept);
  EXPECT_EQ(kept->parts, made.parts);
  EXPECT_EQ(*kept->facts.bias, *made.facts.bias);
  EXPECT_EQ(kept->facts.biasIsLimit, made.facts.biasIsLimit);
  EXPECT_EQ(kept->facts.radius, made.facts.radius);
  EXPECT_EQ(kept->blur.relMseLimit, made.blur.relMseLimit);
  EXPECT_EQ(kept->blur.mseLimit, made.blur.mseLimit);
  EXPECT_EQ(kept->blur.meanLimit, made.blur.meanLimit);
  EXPECT_EQ(kept->noise.relMseError, made.noise.relMseError);
  const Reference given = ReadReference(file, built.settings);
  EXPECT_EQ(given.blur.relMseLimit, made.blur.relMseLimit);
}

TEST(Neighbourhood, NoiseIsThatOfVariancesOrStandardErrors) {
  Image errors(4, 4, {"R", "G", "B", "stderr.R", "stderr.G", "stderr.B"});
  for (size_t i = 0; i < errors.data.size(); ++i) errors.data[i] = i % 6 < 3 ? 2.0f : 0.5f;
  Image variances = errors;
  variances.channels = {"R", "G", "B", "variance.R", "variance.G", "variance.B"};
  for (size_t i = 0; i < variances.data.size(); ++i) variances.data[i] = i % 6 < 3 ? 2.0f : 0.25f;
  EXPECT_NEAR(RelativeNoise(errors), 0.25 / 4.04, 1e-9);
  EXPECT_NEAR(RelativeNoise(variances), 0.25 / 4.04, 1e-9);
  EXPECT_THROW(RelativeNoise(ChannelsOf(errors, {"R", "G", "B"})), Error);
}

TEST(ComparedScene, TimeOfTheChoiceIsPartOfAuto) {
  BuiltScene built = Build(kCamera + kLamp);
  built.choiceTime = {0.2, 0.2};
  const ComparedScene scene(built, 1, kNever, true);  // in time of the processor, which other work does not change
  for (const char* name : {"auto", "path"}) {
    std::vector<ComparedScene::Milestone> reached;
    const auto keep = [&](size_t, const ComparedScene::Milestone& milestone, const Image&) {
      reached.push_back(milestone);
    };
    scene.Render(
        name, 7, {0.1, 0.4}, {}, keep, [](double) {}, 0, scene.ChoiceSeconds(name));
    ASSERT_EQ(reached.size(), 2u);
    if (name == std::string("auto")) {
      EXPECT_EQ(reached[0].samplesPerPixel, 1);  // the time is over, but there must be a picture
      EXPECT_GT(reached[0].seconds, 0.2);
    } else {
      EXPECT_LT(reached[0].seconds, 0.2);
    }
    EXPECT_NEAR(reached[1].seconds, 0.4, 0.1);
  }
}

TEST(ComparedScene, TimesOfTheProcessorAreOverTheThreads) {
  BuiltScene built = Build(kCamera + kLamp);
  built.choiceTime = {1000, 0.2};
  EXPECT_EQ(ComparedScene(built, 2, kNever, true).ChoiceSeconds("auto"), 0.1);
  EXPECT_EQ(ComparedScene(built, 2, kNever).ChoiceSeconds("auto"), 1000);
}

// Trial renders and references are made when the choice is.
TEST(ComparedScene, TimeOfTheChoiceIsPartOfComparedRendersAlone) {
  BuiltScene built = Build(kCamera + kLamp);
  built.choiceTime = {1000, 1000};
  const ComparedScene scene(built, 2, kNever);
  const Reference reference = MakeReference(scene, "auto", 1, 8 * 4, kQuiet);
  EXPECT_LT(reference.facts.seconds, 500);
  ComparisonPlan plan;
  plan.integrators = {"path", "auto"};
  plan.autoIntegrator = "path";
  plan.sampleCounts = {2};
  plan.repeats = 2;
  ComparisonResults results;
  Compare(scene, plan, reference, kQuiet, results);
  EXPECT_LT(results.integrators[0].snapshots[0].seconds, 500);
  EXPECT_GT(results.integrators[1].snapshots[0].seconds, 1000);
}

class Compared : public testing::Test {
 protected:
  static ComparisonResults Run(const std::string& text, const ComparisonPlan& plan, int referenceSamples) {
    const BuiltScene built = Build(text);
    const ComparedScene scene(built, 2, kNever);
    const Reference reference = MakeReference(scene, "bdpt", 1, 8 * referenceSamples, kQuiet);
    ComparisonResults results;
    results.scene = "scene, with a \"comma\".pbrt";
    results.reference = reference.facts;
    Compare(scene, plan, reference, kQuiet, results);
    return results;
  }
  static const ComparedSnapshot& Find(const ComparisonResults& results, const std::string& integrator, double budget) {
    for (const ComparedIntegrator& i : results.integrators) {
      for (const ComparedSnapshot& s : i.snapshots) {
        if (i.name == integrator && s.budget == budget) return s;
      }
    }
    throw Error("no such snapshot");
  }
};

TEST_F(Compared, ErrorsFallAndEfficienciesArePerTime) {
  ComparisonPlan plan;
  plan.integrators = {"path", "bdpt"};
  plan.sampleCounts = {4, 64};
  plan.repeats = 6;
  const ComparisonResults results = Run(kCamera + kLamp, plan, 512);
  for (const char* name : {"path", "bdpt"}) {
    const ComparedSnapshot &few = Find(results, name, 4), &many = Find(results, name, 64);
    ASSERT_TRUE(few.mse && many.mse && few.relMse && many.relMse);
    EXPECT_EQ(few.samplesPerPixel, 4);
    EXPECT_GT(few.mse->value / many.mse->value, 8);  // 16 and more: Sobol points do better than 1/n
    EXPECT_LT(few.mse->low, few.mse->value);
    EXPECT_GT(few.mse->high, few.mse->value);
    EXPECT_NEAR(many.efficiency->value * many.mse->value * many.seconds, 1, 0.3);
    EXPECT_GT(many.seconds, few.seconds);
    EXPECT_GT(few.flip.value, many.flip.value);
  }
  for (const ComparedIntegrator& integrator : results.integrators) {
    EXPECT_FALSE(integrator.meanBias.significant) << integrator.name << " " << integrator.meanBias.value;
    EXPECT_LT(std::abs(integrator.meanBias.value), 0.01);
    EXPECT_FALSE(integrator.systematic.significant) << integrator.name << " " << integrator.systematic.value;
    ASSERT_EQ(integrator.timeToError.size(), 3u);
    EXPECT_LT(integrator.timeToError[0].seconds.value, integrator.timeToError[2].seconds.value);
  }
  ASSERT_EQ(results.ratios.size(), 4u);
  const EfficiencyRatio& ratio = results.ratios[2];
  EXPECT_EQ(ratio.integrator, "bdpt");
  EXPECT_EQ(ratio.budget, 64);
  EXPECT_TRUE(ratio.relative);
  EXPECT_NEAR(ratio.ratio.value,
              Find(results, "bdpt", 64).relEfficiency->value / Find(results, "path", 64).relEfficiency->value,
              1e-9 * ratio.ratio.value);
  EXPECT_EQ(results.pictures.size(), 1 + 2 * 2 * 2u);
}

TEST_F(Compared, AnIntegratorThatMissesLightIsFoundOut) {
  ComparisonPlan plan;
  plan.integrators = {"path", "bdpt"};
  plan.sampleCounts = {64};
  const ComparisonResults results = Run(kCamera + kCaustic, plan, 512);
  const ComparedIntegrator &path = results.integrators[0], &bdpt = results.integrators[1];
  EXPECT_TRUE(path.meanBias.significant);
  EXPECT_LT(path.meanBias.value, -0.02);
  EXPECT_TRUE(path.systematic.significant);
  EXPECT_EQ(path.timeToError[2].kind, TimeToError::Kind::Never);
  EXPECT_FALSE(path.hints.empty());
  EXPECT_FALSE(bdpt.meanBias.significant) << bdpt.meanBias.value;
  EXPECT_NE(bdpt.timeToError[2].kind, TimeToError::Kind::Never);
  const std::string text = ToText(results);
  EXPECT_NE(text.find("path is darker than the reference"), std::string::npos) << text;
  EXPECT_NE(text.find("never"), std::string::npos) << text;
}

TEST_F(Compared, ErrorsAreBiasAndNoise) {
  ComparisonPlan plan;
  plan.integrators = {"path", "bdpt", "vcm"};
  plan.sampleCounts = {4, 64};
  const ComparisonResults results = Run(kCamera + kCaustic, plan, 512);
  for (const ComparedIntegrator& integrator : results.integrators) {
    EXPECT_EQ(integrator.blurs, integrator.name == "vcm");
    for (const ComparedSnapshot& snapshot : integrator.snapshots) {
      ASSERT_TRUE(snapshot.noise) << integrator.name;
      double relMse = 0;
      for (const ComparedRun& run : snapshot.runs) relMse += run.relMse / static_cast<double>(snapshot.runs.size());
      const double ofBias = snapshot.bias.value * snapshot.bias.value;
      // A part below 0, by chance, has no root.
      const double slack = snapshot.bias.value > 0 ? 1e-6 : std::max(0.02 * relMse, 1e-5);
      EXPECT_NEAR(ofBias + snapshot.noise->value * snapshot.noise->value, relMse, slack) << integrator.name;
      EXPECT_LE(snapshot.noise->low, snapshot.noise->value);
      EXPECT_GE(snapshot.noise->high, snapshot.noise->value);
    }
    if (integrator.name != "vcm") {
      EXPECT_EQ(integrator.snapshots[1].bias.significant, integrator.name == "path") << integrator.name;
    }
    const ComparedSnapshot &few = integrator.snapshots[0], &many = integrator.snapshots[1];
    EXPECT_GT(few.noise->value / many.noise->value, 2.8);  // 4, and more by stratification
    double shares = 0;
    for (const SpectrumRing& ring : integrator.spectrum) shares += ring.share;
    double relMse = 0;
    for (const ComparedRun& run : many.runs) relMse += run.relMse / static_cast<double>(many.runs.size());
    EXPECT_NEAR(shares / relMse, 1, 1e-3) << integrator.name;
  }
  const ComparedSnapshot& path = Find(results, "path", 64);
  EXPECT_NEAR(path.bias.value / Find(results, "path", 4).bias.value, 1, 0.1);  // what it misses stays
  EXPECT_NEAR(path.bias.value * path.bias.value, results.integrators[0].systematic.value, 1e-9);
  EXPECT_NE(ToText(results).find("bias (with blur: vcm)"), std::string::npos) << ToText(results);
}

// The radius shrinks: no error is out of reach, even if all of what is measured is above it.
TEST_F(Compared, BlurIsNotSaidToStay) {
  BuiltScene built = Build(kCamera + kCaustic);
  built.settings.values.Set("radius", 0.5);
  const ComparedScene scene(built, 2, kNever);
  const Reference reference = MakeReference(scene, "bdpt", 1, 8 * 512, kQuiet);
  ComparisonPlan plan;
  plan.integrators = {"sppm"};
  plan.sampleCounts = {16};
  ComparisonResults results;
  results.reference = reference.facts;
  Compare(scene, plan, reference, kQuiet, results);
  const ComparedIntegrator& sppm = results.integrators[0];
  EXPECT_TRUE(sppm.blurs);
  ASSERT_TRUE(sppm.systematic.significant);
  const TimeToError& last = sppm.timeToError[2];
  ASSERT_GT(sppm.systematic.low, last.error * last.error);
  EXPECT_EQ(last.kind, TimeToError::Kind::Extrapolated);
  EXPECT_GT(last.seconds.value, sppm.snapshots[0].seconds);
  const std::string text = ToText(results);
  EXPECT_NE(text.find("sppm blurs by "), std::string::npos) << text;
  EXPECT_NE(text.find("blur falls more slowly"), std::string::npos) << text;
  EXPECT_EQ(text.find("never"), std::string::npos) << text;
  EXPECT_EQ(text.find("do not remove"), std::string::npos) << text;
}

// A reference that is blurred by more than an error bounds it, and the verdicts too.
TEST_F(Compared, NothingIsSaidBelowTheBlurOfTheReference) {
  const BuiltScene built = Build(kCamera + kCaustic);
  const ComparedScene scene(built, 2, kNever);
  ComparisonPlan plan;
  plan.integrators = {"path", "bdpt"};
  plan.sampleCounts = {64};
  Reference reference = MakeReference(scene, "bdpt", 1, 8 * 512, kQuiet);
  ComparisonResults sharp;
  sharp.reference = reference.facts;
  Compare(scene, plan, reference, kQuiet, sharp);
  const ComparedSnapshot& path = sharp.integrators[0].snapshots[0];
  ASSERT_TRUE(path.relMse);
  const double common = sharp.integrators[0].systematic.value;

  // Half of what path misses: its error stays resolved and its interval gets wider, by a bias that may be half or one
  // and a half times as large.
  reference.blur = {.relMseLimit = 0.25 * common, .mseLimit = 0, .meanLimit = 0};
  ComparisonResults blurred;
  blurred.reference = reference.facts;
  Compare(scene, plan, reference, kQuiet, blurred);
  ASSERT_TRUE(blurred.integrators[0].snapshots[0].relMse);
  const Estimate &before = *path.relMse, &after = *blurred.integrators[0].snapshots[0].relMse;
  EXPECT_NEAR(after.high / before.high, 1 + 1.25 * common / path.relMse->value, 0.01);
  EXPECT_NEAR(after.low / before.low, 1 - 0.75 * common / path.relMse->value, 0.01);
  EXPECT_TRUE(blurred.integrators[0].systematic.significant);
  // bdpt is as near to the truth as path to the reference: that cannot be said any more.
  EXPECT_FALSE(blurred.integrators[1].snapshots[0].relMse &&
               blurred.integrators[1].snapshots[0].relMse->value < 0.25 * common);

  reference.blur = {.relMseLimit = 4 * path.relMse->value, .mseLimit = 4 * path.mse->value, .meanLimit = 1};
  ComparisonResults hidden;
  hidden.reference = reference.facts;
  Compare(scene, plan, reference, kQuiet, hidden);
  EXPECT_FALSE(hidden.integrators[0].snapshots[0].relMse);
  EXPECT_FALSE(hidden.integrators[0].snapshots[0].relEfficiency);
  EXPECT_FALSE(hidden.integrators[0].snapshots[0].mse);
  EXPECT_FALSE(hidden.integrators[0].systematic.significant);
  EXPECT_FALSE(hidden.integrators[0].meanBias.significant);
  EXPECT_TRUE(hidden.ratios.empty());
  EXPECT_EQ(hidden.integrators[0].timeToError[0].kind, TimeToError::Kind::Unresolved);
  hidden.reference.bias = 2 * std::sqrt(path.relMse->value);
  const std::string text = ToText(hidden);
  EXPECT_NE(text.find("within the reference's own noise and blur"), std::string::npos) << text;
  EXPECT_NE(text.find("within the reference's error"), std::string::npos) << text;
}

TEST_F(Compared, NothingIsSaidBelowTheNoiseOfTheReference) {
  ComparisonPlan plan;
  plan.integrators = {"path"};
  plan.sampleCounts = {1, 1024};
  plan.repeats = 3;
  const ComparisonResults results = Run(kCamera + kLamp, plan, 4);
  EXPECT_TRUE(Find(results, "path", 1).relMse);
  EXPECT_FALSE(Find(results, "path", 1024).relMse);
  EXPECT_FALSE(Find(results, "path", 1024).relEfficiency);
  EXPECT_NE(ToText(results).find("within the reference's noise"), std::string::npos);
  EXPECT_NE(ToJson(results).find("\"relMse\": null"), std::string::npos);
  const std::string csv = ToCsv(results);
  std::istringstream lines(csv);
  size_t columns = 0;
  for (std::string line; std::getline(lines, line);) {
    size_t commas = 0;
    bool quoted = false;
    for (const char c : line) {
      quoted ^= c == '"';
      commas += c == ',' && !quoted;
    }
    if (columns == 0) columns = commas;
    EXPECT_EQ(commas, columns) << line;
  }
  EXPECT_EQ(columns, 22u);
}

}  // namespace
}  // namespace lampyr
