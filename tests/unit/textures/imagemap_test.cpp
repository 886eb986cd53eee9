// Image textures against values by hand: filters, wrap modes, encodings, roles.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "film/srgb.h"
#include "spectral/color_space.h"
#include "support/temporary_folder.h"
#include "texture_scene.h"
#include "textures/texel_lookup.h"

namespace lampyr {
namespace {

// 4 x 2 texels, texel (x, y) = 10 y + x in red, 100 more in green, 0 in blue; y from the top.
std::shared_ptr<const Image> Grid() {
  auto image = std::make_shared<Image>(4, 2, std::vector<std::string>{"R", "G", "B"});
  for (int y = 0; y < 2; ++y) {
    for (int x = 0; x < 4; ++x) {
      image->At(x, y, 0) = static_cast<float>(10 * y + x);
      image->At(x, y, 1) = static_cast<float>(10 * y + x + 100);
    }
  }
  return image;
}

// Texture coordinates of a texel's centre.
Point2 Centre(int x, int y) {
  return {(static_cast<float>(x) + 0.5f) / 4, 1 - (static_cast<float>(y) + 0.5f) / 2};
}

TEST(TexelLookup, CentresGiveTexelsInBothFilters) {
  for (const bool bilinear : {false, true}) {
    const TexelLookup texels(Grid(), WrapMode::Repeat, bilinear);
    for (int y = 0; y < 2; ++y) {
      for (int x = 0; x < 4; ++x) {
        EXPECT_NEAR(texels.LookupColor(Centre(x, y)).r, 10 * y + x, 1e-4f);
        EXPECT_NEAR(texels.LookupFloat(Centre(x, y)), (20 * y + 2 * x + 100) / 3.0f, 1e-4f);
      }
    }
  }
}

// As in pbrt-v4: a float texture reads the alpha if it is not 1 everywhere.
TEST(TexelLookup, FloatsOfImagesWithAlphaAreTheAlpha) {
  for (const float alpha : {1.0f, 0.25f}) {
    auto image = std::make_shared<Image>(4, 2, std::vector<std::string>{"R", "G", "B", "A"});
    for (int x = 0; x < 4; ++x) {
      for (int y = 0; y < 2; ++y) {
        for (size_t c = 0; c < 3; ++c) image->At(x, y, c) = 0.6f;
        image->At(x, y, 3) = x == 2 ? alpha : 1.0f;
      }
    }
    const TexelLookup texels(image, WrapMode::Repeat, false);
    EXPECT_FLOAT_EQ(texels.LookupFloat(Centre(2, 1)), alpha == 1 ? 0.6f : alpha);
    EXPECT_FLOAT_EQ(texels.LookupFloat(Centre(1, 1)), alpha == 1 ? 0.6f : 1.0f);
    EXPECT_FLOAT_EQ(texels.LookupColor(Centre(2, 1)).g, 0.6f);
  }
}

TEST(TexelLookup, BilinearBetweenTexels) {
  const TexelLookup texels(Grid(), WrapMode::Clamp, true);
  EXPECT_NEAR(texels.LookupColor({0.5f, 0.5f}).r, (1 + 2 + 11 + 12) / 4.0f, 1e-4f);
  EXPECT_NEAR(texels.LookupColor(Centre(1, 0) + Vector2(0.25f / 4, 0)).r, 1.25f, 1e-4f);
  EXPECT_NEAR(texels.LookupColor({0.0f, 1.0f}).r, 0.0f, 1e-4f);
  EXPECT_NEAR(texels.LookupColor({1.0f, 0.0f}).r, 13.0f, 1e-4f);
}

TEST(TexelLookup, WrapModes) {
  const auto texel = [](WrapMode mode, int x, int y) {
    return TexelLookup(Grid(), mode, false).LookupColor(Centre(x, y)).r;
  };
  EXPECT_EQ(texel(WrapMode::Repeat, -1, 0), 3);
  EXPECT_EQ(texel(WrapMode::Repeat, 9, 5), 11);
  EXPECT_EQ(texel(WrapMode::Repeat, -6, -1), 12);
  EXPECT_EQ(texel(WrapMode::Clamp, -7, 0), 0);
  EXPECT_EQ(texel(WrapMode::Clamp, 9, 5), 13);
  EXPECT_EQ(texel(WrapMode::Black, -1, 0), 0);
  EXPECT_EQ(texel(WrapMode::Black, 3, 2), 0);
  EXPECT_EQ(texel(WrapMode::Black, 3, 1), 13);
  // Over an edge of the octahedral map: the same edge, mirrored about its middle.
  EXPECT_EQ(texel(WrapMode::OctahedralSphere, -1, 0), 10);
  EXPECT_EQ(texel(WrapMode::OctahedralSphere, 4, 1), 3);
  EXPECT_EQ(texel(WrapMode::OctahedralSphere, 1, -1), 2);
  EXPECT_EQ(texel(WrapMode::OctahedralSphere, 0, 2), 13);
  // At the border, black weighs half.
  EXPECT_NEAR(TexelLookup(Grid(), WrapMode::Black, true).LookupColor({1.0f, 0.25f}).r, 6.5f, 1e-4f);
  EXPECT_NEAR(TexelLookup(Grid(), WrapMode::Repeat, true).LookupColor({1.0f, 0.25f}).r, 11.5f, 1e-4f);
}

TEST(TexelLookup, AnyCoordinateIsLegal) {
  for (const WrapMode mode : {WrapMode::Repeat, WrapMode::Black, WrapMode::Clamp, WrapMode::OctahedralSphere}) {
    for (const bool bilinear : {false, true}) {
      const TexelLookup texels(Grid(), mode, bilinear);
      for (const float x :
           {0.0f, -1e-30f, 1e6f, -1e9f, 1e20f, 3e38f, kInfinity, -kInfinity, std::numeric_limits<float>::quiet_NaN()}) {
        for (const Point2 st : {Point2(x, 0.5f), Point2(0.5f, x), Point2(x, -x)}) {
          EXPECT_TRUE(texels.LookupColor(st).IsValid());
        }
      }
    }
  }
}

TEST(ImageMap, ScaleInvertAndRoles) {
  const TemporaryFolder folder;
  WriteExr(folder / "grid.exr", *Grid(), ExrPrecision::Float);
  const auto file = StringValue("filename", (folder / "grid.exr").string());
  const Point2 at = Centre(2, 1);
  const TextureScene scaled("imagemap", true, {file, FloatValue("scale", 0.01)});
  EXPECT_NEAR(scaled.ColorAt(at.x, at.y).r, 0.12f, 1e-5f);
  EXPECT_NEAR(scaled.ColorAt(at.x, at.y).g, 1.12f, 1e-5f);
  // A reflectance is never above 1.
  EXPECT_EQ(scaled.Spectrum(SpectrumRole::Albedo).Evaluate({at, {}}).g, 1.0f);
  const TextureScene inverted("imagemap", true, {file, FloatValue("scale", 0.01), BoolValue("invert", true)});
  EXPECT_NEAR(inverted.ColorAt(at.x, at.y).r, 0.88f, 1e-5f);
  EXPECT_EQ(inverted.ColorAt(at.x, at.y).g, 0.0f);
  const TextureScene gray("imagemap", false, {file, StringValue("filter", "point"), StringValue("wrap", "clamp")});
  EXPECT_NEAR(gray.FloatAt(at.x, at.y), (12 + 112) / 3.0f, 1e-4f);
}

TEST(ImageMap, Encodings) {
  const TemporaryFolder folder;
  Image image(2, 2, {"R", "G", "B"});
  std::fill(image.data.begin(), image.data.end(), SrgbToLinear(100 / 255.0f));
  WritePng(folder / "a.png", image, 0, ToneMap::Clip);
  const auto value = [&](const char* encoding) {
    std::vector<Parameter> parameters = {StringValue("filename", (folder / "a.png").string())};
    if (encoding) parameters.push_back(StringValue("encoding", encoding));
    return TextureScene("imagemap", true, parameters).ColorAt(0.5f, 0.5f).g;
  };
  const float encoded = 100 / 255.0f;
  EXPECT_NEAR(value(nullptr), SrgbToLinear(encoded), 1e-6f);
  EXPECT_NEAR(value("sRGB"), SrgbToLinear(encoded), 1e-6f);
  EXPECT_NEAR(value("linear"), encoded, 1e-6f);
  EXPECT_NEAR(value("gamma 2.2"), std::pow(encoded, 2.2f), 1e-6f);
  for (const char* wrong : {"srgb", "gamma", "gamma -1", "gamma 2.2x", "gamma nan"})
    EXPECT_THROW(value(wrong), Error) << wrong;
}

TEST(ImageMap, BadChoices) {
  const auto file = StringValue("filename", "a.png");
  EXPECT_THAT(ErrorOf({MakeTexture("a", true, "imagemap", {file, StringValue("wrap", "repaet")}, 2)}),
              ::testing::StartsWith("test.pbrt:2:20: error: \"repaet\" is no wrap (did you mean \"repeat\"?)"));
  EXPECT_THAT(ErrorOf({MakeTexture("a", true, "imagemap", {file, StringValue("filter", "bilinaer")})}),
              ::testing::HasSubstr("bilinear"));
}

// As in pbrt-v4: an image is scaled before its values are bounded, whether by "scale" of its own or by a texture.
TEST(ImageMap, ScaleTexturesScaleTheImage) {
  const TemporaryFolder folder;
  WriteExr(folder / "grid.exr", *Grid(), ExrPrecision::Float);
  const Point2 at = Centre(2, 1);
  const TextureScene scene(
      {MakeTexture("i", true, "imagemap", {StringValue("filename", (folder / "grid.exr").string())}),
       MakeTexture("t", true, "scale", {TextureName("tex", "i"), FloatValue("scale", 0.005)})});
  EXPECT_NEAR(scene.Spectrum(SpectrumRole::Albedo).Evaluate({at, {}}).g, 0.56f, 1e-5f);
  EXPECT_NEAR(scene.Spectrum(SpectrumRole::Albedo).Evaluate({at, {}}).r, 0.06f, 1e-5f);
  // Numbers, too, and before they are inverted: with the image as "tex" or as "scale".
  const std::vector<Parameter> image = {StringValue("filename", (folder / "grid.exr").string()),
                                        FloatValue("scale", 0.01), BoolValue("invert", true)};
  const float plain = TextureScene({MakeTexture("t", false, "imagemap", image)}).FloatAt(at.x, at.y);
  ASSERT_GT(plain, 0);
  for (const bool isSwapped : {false, true}) {
    const TextureScene halved(
        {MakeTexture("i", false, "imagemap", image),
         MakeTexture("t", false, "scale",
                     {TextureName(isSwapped ? "scale" : "tex", "i"), FloatValue(isSwapped ? "tex" : "scale", 0.5)})});
    EXPECT_NEAR(halved.FloatAt(at.x, at.y), 1 - 0.5f * (1 - plain), 1e-5f) << isSwapped;
  }
}

// An OpenEXR file of one pixel, with chromaticities: x, y of red, green, blue and white.
std::string ExrWithChromaticities(const Color& color, const std::array<float, 8>& chromaticities,
                                  const std::string& channels = "BGR") {
  std::string bytes("\x76\x2f\x31\x01\x02\0\0\0", 8);
  const auto add = [&bytes](const auto& value) { bytes.append(reinterpret_cast<const char*>(&value), sizeof value); };
  const auto attribute = [&](const std::string& name, const std::string& type, int32_t size) {
    bytes += name + '\0' + type + '\0';
    add(size);
  };
  attribute("channels", "chlist", 3 * 18 + 1);
  for (const char name : channels) {
    bytes += std::string(1, name) + '\0';
    for (const int32_t value : {2, 0, 1, 1}) add(value);
  }
  bytes += '\0';
  attribute("compression", "compression", 1);
  bytes += '\0';
  for (const char* name : {"dataWindow", "displayWindow"}) {
    attribute(name, "box2i", 16);
    for (int i = 0; i < 4; ++i) add(int32_t{0});
  }
  attribute("lineOrder", "lineOrder", 1);
  bytes += '\0';
  attribute("pixelAspectRatio", "float", 4);
  add(1.0f);
  attribute("screenWindowCenter", "v2f", 8);
  add(0.0f);
  add(0.0f);
  attribute("screenWindowWidth", "float", 4);
  add(1.0f);
  attribute("chromaticities", "chromaticities", 32);
  for (const float value : chromaticities) add(value);
  bytes += '\0';
  add(uint64_t{bytes.size() + 8});
  add(int32_t{0});
  add(int32_t{12});
  for (const float value : {color.b, color.g, color.r}) add(value);
  return bytes;
}

TEST(ImageMap, ImagesWithoutColoursAreErrors) {
  const TemporaryFolder folder;
  WriteBytes(folder / "c.exr",
             ExrWithChromaticities(Color(1.0f), {0.64f, 0.33f, 0.3f, 0.6f, 0.15f, 0.06f, 0.3f, 0.3f}, "UVZ"));
  EXPECT_THAT(ErrorOf({MakeTexture("a", true, "imagemap", {StringValue("filename", (folder / "c.exr").string())})}),
              ::testing::HasSubstr("no R, G and B channels, and is not gray: its channels are U, V"));
}

// The colours of an image are those of the primaries and the white that it names, as in pbrt-v4.
TEST(ImageMap, ChromaticitiesOfFilesCount) {
  const TemporaryFolder folder;
  const Color given(0.6f, 0.4f, 0.3f);
  const auto read = [&](const std::array<float, 8>& chromaticities, SpectrumRole role) {
    WriteBytes(folder / "c.exr", ExrWithChromaticities(given, chromaticities));
    const TextureScene scene("imagemap", true, {StringValue("filename", (folder / "c.exr").string())});
    return scene.Spectrum(role).Evaluate({Point2(0.5f), {}});
  };
  const auto expect = [](const Color& color, const Vector3d& expected) {
    EXPECT_NEAR(color.r, expected.x, 1e-5);
    EXPECT_NEAR(color.g, expected.y, 1e-5);
    EXPECT_NEAR(color.b, expected.z, 1e-5);
  };
  const Vector3d rgb(given.r, given.g, given.b);
  for (const SpectrumRole role : {SpectrumRole::Albedo, SpectrumRole::Illuminant}) {
    const WhiteHandling white = role == SpectrumRole::Albedo ? WhiteHandling::Adapt : WhiteHandling::Keep;
    expect(read({0.64f, 0.33f, 0.30f, 0.60f, 0.15f, 0.06f, 0.3127f, 0.3290f}, role), rgb);
    expect(read({0.708f, 0.292f, 0.170f, 0.797f, 0.131f, 0.046f, 0.3127f, 0.3290f}, role),
           ToRec709(rgb, RgbColorSpace::Rec2020, white));
    expect(read({0.7347f, 0.2653f, 0, 1, 0.0001f, -0.0770f, 0.32168f, 0.33767f}, role),
           ToRec709(rgb, RgbColorSpace::Aces2065, white));
    expect(read({0.3f, 0.3f, 0.3f, 0.3f, 0.3f, 0.3f, 0.3f, 0.3f}, role), rgb);  // of no colour space
  }
}

TEST(ImageMap, ImagesAreReadOnceAndShared) {
  const TemporaryFolder folder;
  WriteExr(folder / "grid.exr", *Grid(), ExrPrecision::Float);
  const TextureScene scene(std::vector<TextureDescription>{});
  const auto first = scene.library.GetImage(folder / "grid.exr", ImageEncoding::Automatic, {});
  EXPECT_EQ(first, scene.library.GetImage(folder / "grid.exr", ImageEncoding::Automatic, {}));
  EXPECT_NE(first, scene.library.GetImage(folder / "grid.exr", ImageEncoding::Linear, {}));
  EXPECT_THROW(scene.library.GetImage(folder / "missing.exr", ImageEncoding::Automatic, {}), Error);
  EXPECT_THROW(scene.library.GetImage(folder / "missing.exr", ImageEncoding::Automatic, {}), Error);
}

}  // namespace
}  // namespace lampyr
