// Homogeneous media, and the parameters that all types share.
#include <gmock/gmock.h>

#include "media/presets.h"
#include "scene/spectrum.h"
#include "unit/media/medium_scene.h"

namespace lampyr {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(HomogeneousMedium, IsTheSameEverywhere) {
  const auto medium = MediumOf(R"("homogeneous" "rgb sigma_a" [ 1 2 3 ] "rgb sigma_s" [ 4 5 6 ] "float scale" 0.5
    "float g" -0.25 "rgb Le" [ 2 4 8 ] "float Lescale" 3)");
  EXPECT_TRUE(medium->IsHomogeneous());
  EXPECT_TRUE(medium->IsEmissive());
  EXPECT_EQ(medium->Asymmetry(), -0.25f);
  EXPECT_EQ(medium->Name(), "m");
  EXPECT_EQ(medium->Bytes(), 0u);
  for (const Point3& p : {Point3(0.0f), Point3(1e6f, -3, 2)}) {
    const MediumCoefficients at = medium->At(p);
    EXPECT_EQ(at.absorption, Color(0.5f, 1, 1.5f));
    EXPECT_EQ(at.scattering, Color(2, 2.5f, 3));
    EXPECT_EQ(at.Extinction(), Color(2.5f, 3.5f, 4.5f));
    EXPECT_EQ(at.emission, Color(3, 12, 36));
  }
}

TEST(HomogeneousMedium, HasTheDefaultsOfPbrt) {
  const auto medium = MediumOf("\"homogeneous\"", "Scale 2 3 4");
  EXPECT_EQ(medium->At({}).absorption, Color(1.0f));
  EXPECT_EQ(medium->At({}).scattering, Color(1.0f));
  EXPECT_TRUE(medium->At({}).emission.IsBlack());
  EXPECT_FALSE(medium->IsEmissive());
  EXPECT_EQ(medium->Asymmetry(), 0);
}

TEST(HomogeneousMedium, TakesSpectra) {
  const auto medium = MediumOf(R"("homogeneous" "spectrum sigma_a" [ 300 0.25 900 0.25 ]
    "spectrum sigma_s" [ 300 0.5 900 0.5 ] "blackbody Le" 3000 "float Lescale" 2)");
  EXPECT_EQ(medium->At({}).absorption, Color(0.25f));
  EXPECT_EQ(medium->At({}).scattering, Color(0.5f));
  const Color radiance = BlackbodyToColor(3000, SpectrumRole::Illuminant) * 2;
  EXPECT_EQ(medium->At({}).emission, radiance * 0.25f);
  EXPECT_FALSE(MediumOf("\"homogeneous\" \"rgb sigma_a\" [ 0 0 0 ] \"rgb Le\" [ 1 1 1 ]")->IsEmissive());
}

TEST(HomogeneousMedium, HasPresets) {
  const auto ketchup = MediumOf(R"("homogeneous" "string preset" "Ketchup" "float scale" 10)");
  EXPECT_EQ(ketchup->At({}).scattering, Color(0.18f, 0.07f, 0.03f) * 10);
  EXPECT_EQ(ketchup->At({}).absorption, Color(0.061f, 0.97f, 1.45f) * 10);
  const auto beer = MediumOf(R"("homogeneous" "string preset" "Budweiser Beer")");
  EXPECT_EQ(beer->At({}).absorption, Color(0.011492f, 0.024911f, 0.057786f));
  EXPECT_EQ(ScatteringPresetNames().size(), 47u);
  for (const std::string& name : ScatteringPresetNames()) {
    const MeasuredScattering* preset = FindScatteringPreset(name);
    ASSERT_TRUE(preset);
    EXPECT_TRUE(preset->scattering.IsValid() && preset->absorption.IsValid()) << name;
    EXPECT_GT((preset->scattering + preset->absorption).Max(), 0) << name;
  }
  EXPECT_EQ(FindScatteringPreset("ketchup"), nullptr);
}

TEST(MediumErrors, SayWhatWouldBeRight) {
  EXPECT_EQ(MediumError("\"homogenous\""),
            "scene.pbrt:2:21: error: there is no medium of type \"homogenous\" (did you mean \"homogeneous\"?)");
  EXPECT_EQ(MediumError("\"homogeneous\" \"string preset\" \"Wholemlik\""),
            "scene.pbrt:2:49: error: there is no preset \"Wholemlik\" of scattering (did you mean \"Wholemilk\"?)");
  EXPECT_THAT(MediumError("\"homogeneous\" \"rgb sigma_t\" [ 1 1 1 ]"),
              HasSubstr("scene.pbrt:2:49: error: MakeNamedMedium \"m\" has no parameter \"sigma_t\" (did you mean "));
  for (const char* g : {"1", "-1", "1.5", "0.999999999"}) {
    EXPECT_EQ(MediumError(std::string("\"homogeneous\" \"float g\" ") + g),
              "scene.pbrt:2:49: error: \"g\" must be between -1 and 1, and neither of them");
  }
  for (const char* name : {"scale", "Lescale"}) {
    const std::string parameter = std::string("\"homogeneous\" \"float ") + name;
    EXPECT_THAT(MediumError(parameter + "\" -1"), HasSubstr(std::string("\"") + name + "\" must not be negative"));
    EXPECT_THAT(MediumError(parameter + "\" 1e99"), HasSubstr("the number 1e99 is too large"));
    EXPECT_THAT(MediumError(parameter + "\" nan"), HasSubstr("scene.pbrt:2:"));
    EXPECT_THAT(MediumError(parameter + "\" [ 1 2 ]"), HasSubstr("scene.pbrt:2:49: error: \""));
  }
  EXPECT_THAT(MediumError("\"homogeneous\" \"rgb sigma_a\" [ 1 -1 1 ]"), HasSubstr("2:49: error: \"sigma_a\" of"));
  EXPECT_THAT(MediumError("\"homogeneous\" \"rgb sigma_a\" [ 3e38 1 1 ] \"rgb sigma_s\" [ 3e38 1 1 ]"),
              HasSubstr("scene.pbrt:2:1: error: the extinction of this medium leaves the range of floats"));
  EXPECT_THAT(MediumError("\"homogeneous\" \"rgb sigma_a\" [ 1e30 1 1 ] \"float scale\" 1e30"),
              HasSubstr("the extinction of this medium leaves the range of floats"));
  EXPECT_THAT(MediumError("\"homogeneous\" \"rgb sigma_a\" [ 1e30 1 1 ] \"rgb Le\" [ 1e30 1 1 ]"),
              HasSubstr("the emission of this medium leaves the range of floats"));
}

TEST(MediumWarnings, TellOfWhatHasNoEffect) {
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  const auto media = MediaOf(
      "ActiveTransform EndTime Translate 1 0 0 ActiveTransform All\nMakeNamedMedium \"m\" "
      "\"string type\" \"homogeneous\" \"string preset\" \"Cream\" \"rgb sigma_a\" [ 1 1 1 ]",
      diagnostics);
  ASSERT_EQ(media.size(), 1u);
  EXPECT_THAT(diagnostics.Warnings(),
              ElementsAre("scene.pbrt:3:1: warning: media do not move, as in pbrt-v4: this one stays where it is when "
                          "the shutter opens",
                          "scene.pbrt:3:73: warning: \"sigma_a\" of MakeNamedMedium \"m\" has no effect here"));
}

TEST(Media, AreInTheOrderOfTheScene) {
  Diagnostics strict(Diagnostics::Mode::Strict);
  const auto media = MediaOf(R"(MakeNamedMedium "b" "string type" "homogeneous" "float g" 0.1
    MakeNamedMedium "a" "string type" "homogeneous" "float g" 0.2)",
                             strict);
  ASSERT_EQ(media.size(), 2u);
  EXPECT_EQ(media[0]->Name(), "b");
  EXPECT_EQ(media[1]->Name(), "a");
  EXPECT_EQ(media[1]->Asymmetry(), 0.2f);
}

}  // namespace
}  // namespace lampyr
