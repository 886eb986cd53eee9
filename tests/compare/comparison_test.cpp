// Comparing integrators: what is measured is what is there.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "app/compare/comparison.h"
#include "app/compare/first_look.h"
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
// Of what the point light sends through the ball, a path from the camera finds nothing.
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
  const BuiltScene built = Build(kCamera + kCaustic);
  const ComparedScene scene(built, 2, kNever);
  for (const Pilot& pilot : FlyPilots(scene, 0.3, kQuiet)) {
    // path's picture has no noise to speak of, and no caustic.
    EXPECT_EQ(pilot.chosen, pilot.integrator == "bdpt") << pilot.integrator;
    if (pilot.integrator == "path") {
      EXPECT_NE(pilot.note.find("finds less light than "), std::string::npos) << pilot.note;
    }
    EXPECT_GT(pilot.samplesPerPixel, 0);
    EXPECT_GT(pilot.seconds, 0.15);
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
  for (const Pilot& pilot : FlyPilots(ComparedScene(built, 2, kNever), 0.5, kQuiet))
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

TEST(Reference, BlackPicturesAndExtremesOfRadiance) {
  // The lamp lights nothing that is seen.
  const BuiltScene black = Build("LookAt 0 1 0  0 10 0  0 0 1\n" + kCamera.substr(kCamera.find("Film")) + kLamp);
  for (const Pilot& pilot : FlyPilots(ComparedScene(black, 2, kNever), 0.05, kQuiet)) EXPECT_EQ(pilot.mean, 0);
  for (const char* radiance : {"1e-30 1e-30 1e-30", "1e30 1e30 1e30"}) {
    std::string lamp = kLamp;
    lamp.replace(lamp.find("30 28 26"), 8, radiance);
    const BuiltScene built = Build(kCamera + lamp);
    const ComparedScene scene(built, 2, kNever);
    for (const Pilot& pilot : FlyPilots(scene, 0.2, kQuiet)) {
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
  EXPECT_FALSE(FindKeptReference(file, key + "x", 0));
  EXPECT_FALSE(FindKeptReference(file, key, 5.1));
  std::filesystem::resize_file(file, std::filesystem::file_size(file) / 2);
  EXPECT_FALSE(FindKeptReference(file, key, 0));
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
