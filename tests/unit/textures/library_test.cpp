// The library: constants stay constants, textures refer to earlier ones, every mistake has its place.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "scene/scene_parser.h"
#include "support/temporary_folder.h"
#include "texture_scene.h"
#include "textures/texture_library.h"

namespace lampyr {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

TEST(TextureLibrary, ParametersWithoutTextures) {
  const TextureScene scene(std::vector<TextureDescription>{});
  const ParameterList list = MakeParameters({FloatValue("roughness", 0.25), RgbValue("reflectance", 0.1, 0.2, 0.3)});
  EXPECT_TRUE(scene.library.GetFloat(list, "roughness", 1).IsConstant());
  EXPECT_EQ(scene.library.GetFloat(list, "roughness", 1).Evaluate({}), 0.25f);
  EXPECT_EQ(scene.library.GetFloat(list, "other", 0.75f).Evaluate({}), 0.75f);
  EXPECT_FALSE(scene.library.FindFloat(list, "other").has_value());
  EXPECT_FALSE(scene.library.FindColor(list, "other", SpectrumRole::Albedo).has_value());
  const Color color = scene.library.GetColor(list, "reflectance", Color(1.0f), SpectrumRole::Albedo).Evaluate({});
  EXPECT_NEAR(color.r, 0.1f, 1e-6f);
  EXPECT_NEAR(color.b, 0.3f, 1e-6f);
  EXPECT_THROW(scene.library.GetFloat(list, "reflectance", 1), Error);
}

// An index of refraction is no reflectance, and need not be one: only what uses it as such is an error.
TEST(TextureLibrary, SpectraAboveOneAreNoReflectances) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder / "s.pbrt";
  std::ofstream(file)
      << "WorldBegin\nTexture \"eta\" \"spectrum\" \"constant\" \"spectrum value\" [ 300 1.5 900 1.5 ]\n"
         "Shape \"s\" \"texture x\" \"eta\"";
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  const SceneDescription description = ReadScene(file, diagnostics);
  const TextureLibrary library(description.textures, Transform(), diagnostics);
  const ParameterList& list = description.shapes.at(0).shape.parameters;
  EXPECT_NEAR(library.GetColor(list, "x", Color(0.0f), SpectrumRole::Unbounded).Evaluate({}).g, 1.5f, 1e-5f);
  EXPECT_THROW(library.GetColor(list, "x", Color(0.0f), SpectrumRole::Albedo), Error);
}

TEST(TextureLibrary, TexturesThatDoNotVaryAreConstants) {
  const TextureScene scene(
      {MakeTexture("a", false, "constant", {FloatValue("value", 3)}),
       MakeTexture("b", false, "scale", {TextureName("tex", "a"), FloatValue("scale", 0.5)}),
       MakeTexture("t", false, "mix",
                   {TextureName("tex1", "a"), TextureName("tex2", "b"), FloatValue("amount", 0.25)})});
  EXPECT_TRUE(scene.Float().IsConstant());
  EXPECT_FLOAT_EQ(scene.FloatAt(0, 0), 0.75f * 3 + 0.25f * 1.5f);
}

TEST(TextureLibrary, FloatAndSpectrumNamesAreApart) {
  const TextureScene scene({MakeTexture("t", false, "constant", {FloatValue("value", 2)}),
                            MakeTexture("t", true, "constant", {RgbValue("value", 0.1, 0.2, 0.3)})});
  EXPECT_EQ(scene.FloatAt(0, 0), 2);
  EXPECT_NEAR(scene.ColorAt(0, 0).g, 0.2f, 1e-6f);
}

// As in pbrt-v4, which makes image maps first.
TEST(TextureLibrary, ImageMapsMayFollowTheirUse) {
  const TemporaryFolder folder;
  Image image(2, 2, {"R", "G", "B"});
  image.data.assign(image.data.size(), 1.0f);
  WritePng(folder / "a.png", image, 0, ToneMap::Clip);
  const TextureScene scene(
      {MakeTexture("t", false, "scale", {TextureName("tex", "later"), FloatValue("scale", 0.5)}),
       MakeTexture("later", false, "imagemap", {StringValue("filename", (folder / "a.png").string())})});
  EXPECT_FLOAT_EQ(scene.FloatAt(0.3f, 0.3f), 0.5f);
}

// As in pbrt-v4: an opacity or an amount in the alpha of a file is encoded as its colours are.
TEST(TextureLibrary, AmountsInAlphaAreDecoded) {
  const TextureScene scene(std::vector<TextureDescription>{});
  const auto image = std::make_shared<Image>(1, 1, std::vector<std::string>{"R", "G", "B", "A"});
  image->data = {0.2f, 0.3f, 0.4f, 0.5f};
  EXPECT_EQ(scene.library.WithDecodedAlpha(image), image);
  const auto alphaOf = [&](float gamma) {
    const auto encoded = std::make_shared<Image>(*image);
    encoded->colorGamma = gamma;
    const auto decoded = scene.library.WithDecodedAlpha(encoded);
    EXPECT_EQ(decoded->At(0, 0, 2), 0.4f);
    return decoded->At(0, 0, 3);
  };
  EXPECT_NEAR(alphaOf(0), 0.2140f, 1e-4f);
  EXPECT_NEAR(alphaOf(2), 0.25f, 1e-6f);
}

TEST(TextureLibrary, MistakesHaveTheirPlaceAndTheNearestName) {
  const TextureScene scene({MakeTexture("wood", true, "constant", {}), MakeTexture("grain", false, "constant", {})});
  const auto errorOf = [&](const std::string& texture, bool isSpectrum) -> std::string {
    const ParameterList list = MakeParameters({FloatValue("x", 1), TextureName("p", texture)}, 7);
    try {
      if (isSpectrum) {
        scene.library.GetColor(list, "p", Color(0.0f), SpectrumRole::Albedo);
      } else {
        scene.library.GetFloat(list, "p", 0);
      }
    } catch (const Error& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_THAT(errorOf("woood", true), StartsWith("test.pbrt:7:20: error"));
  EXPECT_THAT(errorOf("woood", true), HasSubstr("did you mean \"wood\"?"));
  EXPECT_THAT(errorOf("grian", false), HasSubstr("did you mean \"grain\"?"));
  EXPECT_THAT(errorOf("wood", false), HasSubstr("is a spectrum texture"));
  EXPECT_THAT(errorOf("grain", true), HasSubstr("is a float texture"));
}

TEST(TextureLibrary, BadStatements) {
  EXPECT_THAT(ErrorOf({MakeTexture("a", false, "chekerboard", {}, 3)}),
              StartsWith("test.pbrt:3:1: error: \"chekerboard\" is no texture type (did you mean \"checkerboard\"?)"));
  EXPECT_THAT(ErrorOf({MakeTexture("a", false, "marble", {})}), HasSubstr("makes a spectrum, not a float"));
  EXPECT_THAT(ErrorOf({MakeTexture("a", true, "fbm", {})}), HasSubstr("makes a float, not a spectrum"));
  EXPECT_THAT(ErrorOf({MakeTexture("a", true, "constant", {}), MakeTexture("a", true, "constant", {}, 5)}),
              StartsWith("test.pbrt:5:1: error"));
  EXPECT_THAT(
      ErrorOf({MakeTexture("a", true, "scale", {TextureName("tex", "b")}), MakeTexture("b", true, "constant", {})}),
      HasSubstr("defined after its use"));
  EXPECT_THAT(ErrorOf({MakeTexture("a", true, "scale", {TextureName("tex", "a")})}),
              HasSubstr("defined after its use"));
  EXPECT_THAT(ErrorOf({MakeTexture("a", false, "mix", {FloatValue("ammount", 1)})}), HasSubstr("amount"));
  EXPECT_THAT(ErrorOf({MakeTexture("a", false, "checkerboard", {IntegerValue("dimension", 4)})}), HasSubstr("2 or 3"));
  EXPECT_THAT(ErrorOf({MakeTexture("a", false, "fbm", {IntegerValue("octaves", 1000000)})}), HasSubstr("octaves"));
  EXPECT_THAT(ErrorOf({MakeTexture("a", false, "dots", {StringValue("mapping", "spheric")})}), HasSubstr("spherical"));
  EXPECT_THAT(ErrorOf({MakeTexture("a", false, "imagemap", {})}), HasSubstr("filename"));
  EXPECT_THAT(ErrorOf({MakeTexture("a", false, "imagemap", {StringValue("filename", "/missing/a.png")}, 4)}),
              StartsWith("test.pbrt:4:10: error: cannot read image"));
  EXPECT_THAT(ErrorOf({MakeTexture("a", false, "fbm", {}, 2, Transform::Scale({1, 0, 1}))}), HasSubstr("singular"));
}

TEST(TextureLibrary, WhatIsNotSupportedWarns) {
  const TextureScene scene(
      {MakeTexture("a", true, "ptex", {StringValue("filename", "a.ptx")}, 1),
       MakeTexture("c", false, "dots", {StringValue("mapping", "spherical"), FloatValue("uscale", 2)}, 3)});
  const auto warnings = scene.diagnostics.Warnings();
  ASSERT_EQ(warnings.size(), 2u);
  EXPECT_THAT(warnings[0], StartsWith("test.pbrt:1:1: warning: texture type \"ptex\" is not supported"));
  EXPECT_THAT(warnings[1], HasSubstr("uscale"));
}

// By the cosine between the surface's normal, of either side, and `dir` in the texture's own space.
TEST(TextureLibrary, DirectionMixFollowsTheNormal) {
  const std::vector<Parameter> values = {FloatValue("tex1", 4), FloatValue("tex2", 1)};
  const auto valueAt = [](const TextureScene& scene, const Normal3& normal) {
    return scene.Float().Evaluate({{}, {}, normal});
  };
  const TextureScene byDefault({MakeTexture("t", false, "directionmix", values)});
  EXPECT_FLOAT_EQ(valueAt(byDefault, {0, 1, 0}), 4);
  EXPECT_FLOAT_EQ(valueAt(byDefault, {0, -1, 0}), 4);
  EXPECT_FLOAT_EQ(valueAt(byDefault, {1, 0, 0}), 1);
  EXPECT_FLOAT_EQ(valueAt(byDefault, {0.8f, 0.6f, 0}), 0.6f * 4 + 0.4f);
  std::vector<Parameter> turned = values;
  turned.push_back(VectorValue("dir", 3, 0, 0));
  const TextureScene scene({MakeTexture("t", false, "directionmix", turned, 1, Transform::Rotate(90, {0, 0, 1}))});
  EXPECT_NEAR(valueAt(scene, {0, 1, 0}), 4, 1e-6f);
  EXPECT_NEAR(valueAt(scene, {1, 0, 0}), 1, 1e-6f);
  EXPECT_THAT(ErrorOf({MakeTexture("a", false, "directionmix", {VectorValue("dir", 0, 0, 0)}, 3)}),
              HasSubstr("no direction"));
}

TEST(Alpha, ConstantsAndTextures) {
  EXPECT_EQ(MakeAlphaSource(FloatParameter(1.0f)), nullptr);
  EXPECT_EQ(MakeAlphaSource(FloatParameter(2.0f)), nullptr);
  EXPECT_FLOAT_EQ(MakeAlphaSource(FloatParameter(0.25f))->Alpha({0, 0}, Point3(0.0f), {}), 0.25f);
  EXPECT_EQ(MakeAlphaSource(FloatParameter(-3.0f))->Alpha({0, 0}, Point3(0.0f), {}), 0.0f);
  const TextureScene scene("checkerboard", false, {});
  const auto alpha = MakeAlphaSource(scene.Float());
  ASSERT_NE(alpha, nullptr);
  EXPECT_EQ(alpha->Alpha({0.5f, 0.5f}, Point3(0.0f), {}), 1.0f);
  EXPECT_EQ(alpha->Alpha({1.5f, 0.5f}, Point3(0.0f), {}), 0.0f);
}

}  // namespace
}  // namespace lampyr
