// The layers of Film "gbuffer" and the pixel layers, where they are known in closed form.
#include <gtest/gtest.h>

#include <cmath>

#include <bit>
#include <cstdint>
#include <map>

#include "render/cryptomatte.h"
#include "render/first_hit_layers.h"
#include "support/render_scene.h"

namespace lampyr::test {
namespace {

constexpr int kSize = 16;

// A camera at (1000, 2, -3), mirrored as pbrt's scenes are, that looks along z at what stands before it.
BuiltScene Build(const std::string& film, const std::string& world) {
  const std::string size = std::to_string(kSize);
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  return BuildScene(
      ParseScene("Film \"gbuffer\" \"integer xresolution\" " + size + " \"integer yresolution\" " + size + " " + film +
                     "\nPixelFilter \"box\"\nScale -1 1 1 LookAt 1000 2 -3  1000 2 0  0 1 0\n"
                     "Camera \"perspective\" \"float fov\" 40\nWorldBegin\n"
                     "LightSource \"point\" \"point3 from\" [1000 4 -3]\nTranslate 1000 2 0\n" +
                     world,
                 "test.pbrt", diagnostics),
      {}, true, diagnostics);
}

// Side lengths of 20; u along x, v along y.
std::string Square(const std::string& material, double degrees) {
  return material + " Rotate " + std::to_string(degrees) +
         " 1 0 0 Shape \"trianglemesh\" \"point3 P\" [-10 -10 0  10 -10 0  10 10 0  -10 10 0] \"point2 uv\" [0 0  1 0  "
         "1 1  0 "
         "1] \"integer indices\" [0 1 2 0 2 3]\n";
}
const std::string kMatte = "Material \"diffuse\" \"rgb reflectance\" [0.2 0.4 0.6]";

class Layers {
 public:
  explicit Layers(const BuiltScene& built) {
    const std::atomic<bool> goesOn(false);
    image_ = FirstHitLayers(built, 2, goesOn);
  }
  double At(const std::string& channel, int x, int y) const {
    return static_cast<double>(image_.At(x, y, static_cast<size_t>(image_.ChannelIndex(channel))));
  }
  const Image& Whole() const { return image_; }

 private:
  Image image_;
};

// Offset, per distance in front of the camera, of the point that the centre of a pixel sees.
double Slope(int pixel) {
  return std::tan(20 * M_PI / 180) * ((pixel + 0.5) / (0.5 * kSize) - 1);
}

TEST(FirstHitLayers, OfATiltedSquareInBothSpaces) {
  for (const bool isWorld : {false, true}) {
    const Layers layers(Build(isWorld ? "\"string coordinatesystem\" \"world\"" : "", Square(kMatte, 30)));
    const double tilt = std::tan(30 * M_PI / 180);
    for (const int x : {2, 9}) {
      for (const int y : {1, 12}) {
        // z = y tan 30° in front of the camera by 3: a ray that rises by s per distance meets it at 3 / (1 - s tan
        // 30°).
        const double up = -Slope(y), depth = 3 / (1 - up * tilt), height = depth * up;
        EXPECT_NEAR(layers.At("P.Y", x, y) - (isWorld ? 2 : 0), height, 0.02);
        EXPECT_NEAR(layers.At("P.Z", x, y) + (isWorld ? 3 : 0), depth, 0.02);
        EXPECT_NEAR(std::abs(layers.At("P.X", x, y) - (isWorld ? 1000 : 0)), std::abs(depth * Slope(x)), 0.02);
        EXPECT_NEAR(layers.At("N.Y", x, y), 0.5, 1e-4);
        EXPECT_NEAR(layers.At("N.Z", x, y), -std::sqrt(0.75), 1e-4);
        EXPECT_NEAR(layers.At("Ns.Z", x, y), -std::sqrt(0.75), 1e-4);
        EXPECT_NEAR(layers.At("v", x, y), 0.5 + height / std::cos(30 * M_PI / 180) / 20, 2e-3);
        EXPECT_NEAR(layers.At("dzdx", x, y), 0, 1e-4);
        const double below = -Slope(y + 1);
        EXPECT_NEAR(layers.At("dzdy", x, y), std::abs(3 / (1 - below * tilt) - depth), 1e-3);
        EXPECT_NEAR(layers.At("Albedo.R", x, y), 0.2, 1e-4);
        EXPECT_NEAR(layers.At("Albedo.B", x, y), 0.6, 1e-4);
      }
    }
    // Left in the picture is the camera's left in its own space, whose x is mirrored here.
    EXPECT_LT(layers.At("P.X", 1, 8), layers.At("P.X", 14, 8) * (isWorld ? -1 : 1) + (isWorld ? 3000 : 0));
  }
}

TEST(FirstHitLayers, AlbedoIsPowerAndNothingIsZero) {
  // Clear glass and a white mirror take no light away; behind an edge there is nothing.
  const Layers glass(Build("", Square("Material \"dielectric\"", 0)));
  EXPECT_NEAR(glass.At("Albedo.G", 8, 8), 1, 1e-3);
  const Layers black(Build("", Square("Material \"diffuse\" \"rgb reflectance\" [0 0 0]", 0)));
  EXPECT_EQ(black.At("Albedo.G", 8, 8), 0);
  EXPECT_NEAR(black.At("P.Z", 8, 8), 3, 0.02);
  const Layers nothing(Build("", "Shape \"sphere\" \"float radius\" 0.3\n"));
  EXPECT_EQ(nothing.At("P.Z", 1, 1), 0);
  EXPECT_EQ(nothing.At("N.Z", 1, 1), 0);
  EXPECT_NEAR(nothing.At("N.Z", 8, 8), -1, 0.1);
}

TEST(FirstHitLayers, DoNotDependOnThreadsOrCrops) {
  BuiltScene built = Build("", Square(kMatte, 30));
  const Layers whole(built);
  built.settings.crop = {3, 5, 9, 11};
  const Layers crop(built);
  for (const std::string& channel : FirstHitChannels(built.settings))
    EXPECT_EQ(crop.At(channel, 2, 4), whole.At(channel, 5, 9));
}

TEST(FirstHitLayers, AnUnknownSpaceIsNamed) {
  try {
    Build("\"string coordinatesystem\" \"wrld\"", Square(kMatte, 0));
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("did you mean \"world\""), std::string::npos) << error.what();
  }
}

// A floor of many squares, a ball that is named by its object, and a mirror above; seen by a plain film.
BuiltScene Staged(const std::vector<std::string>& layers, bool throughSmooth) {
  RenderOverrides overrides;
  overrides.layers = layers;
  overrides.seesThroughSmooth = throughSmooth;
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  const std::string size = std::to_string(kSize);
  return BuildScene(ParseScene("Film \"rgb\" \"integer xresolution\" " + size + " \"integer yresolution\" " + size + R"(
PixelFilter "box"
LookAt 0 0 -5  0 0 0  0 1 0
Camera "perspective" "float fov" 40
WorldBegin
LightSource "point" "point3 from" [0 4 -3]
MakeNamedMaterial "brass \"shiny\"" "string type" "diffuse" "rgb reflectance" [0.5 0.4 0.1]
ObjectBegin "ball"
NamedMaterial "brass \"shiny\""
Shape "sphere" "float radius" 0.5
ObjectEnd
AttributeBegin Translate 0 -1 0 ObjectInstance "ball" AttributeEnd
AttributeBegin
Material "conductor" "rgb reflectance" [1 1 1]
Shape "trianglemesh" "point3 P" [-9 0 2  9 0 2  9 9 2  -9 9 2] "integer indices" [0 1 2 0 2 3]
AttributeEnd
Material "diffuse" "rgb reflectance" [0.2 0.4 0.6]
Translate 0 0 -7
Shape "trianglemesh" "point3 P" [-99 -99 0  99 -99 0  99 99 0  -99 99 0] "integer indices" [0 1 2 0 2 3]
)",
                               "folder/stage.pbrt", diagnostics),
                    overrides, true, diagnostics);
}

// Names and their identifiers of a manifest, as a reader of the specification finds them.
std::map<std::string, uint32_t> ManifestOf(const BuiltScene& built, const std::string& layer) {
  const auto metadata = FirstHitMetadata(built);
  std::map<std::string, uint32_t> names;
  for (const auto& [key, value] : metadata) {
    if (!key.starts_with("cryptomatte/") || !key.ends_with("/name") || value != layer) continue;
    const std::string prefix = key.substr(0, key.size() - 4);
    EXPECT_EQ(prefix.size(), std::string("cryptomatte/0123456/").size());
    EXPECT_EQ(metadata.at(prefix + "hash"), "MurmurHash3_32");
    EXPECT_EQ(metadata.at(prefix + "conversion"), "uint32_to_float32");
    const std::string& manifest = metadata.at(prefix + "manifest");
    std::string text;  // of the string that is read, with its escapes resolved
    std::vector<std::string> strings;
    bool isInside = false;
    for (size_t i = 0; i < manifest.size(); ++i) {
      if (isInside && manifest[i] == '\\') {
        text += manifest[++i];
      } else if (manifest[i] == '"') {
        if (isInside) strings.push_back(std::exchange(text, ""));
        isInside = !isInside;
      } else if (isInside) {
        text += manifest[i];
      }
    }
    for (size_t i = 0; i + 1 < strings.size(); i += 2)
      names[strings[i]] = static_cast<uint32_t>(std::stoul(strings[i + 1], nullptr, 16));
  }
  return names;
}

// The coverage of a pixel by a name, over all ranks.
double CoverageOf(const Layers& layers, const std::string& layer, uint32_t id, int x, int y) {
  double coverage = 0, last = 1;
  for (const char* level : {"00", "01", "02"}) {
    for (const auto& [name, share] : {std::pair("R", "G"), std::pair("B", "A")}) {
      const double own = layers.At(layer + level + "." + share, x, y);
      EXPECT_LE(own, last) << "ranks are by coverage";
      last = own;
      const auto rank = static_cast<float>(layers.At(layer + level + "." + name, x, y));
      if (std::bit_cast<uint32_t>(rank) == id) coverage += own;
    }
  }
  return coverage;
}

TEST(Cryptomatte, IdentifiersAreHashesOfNames) {
  // Known values of MurmurHash3_32 with seed 0.
  EXPECT_EQ(std::bit_cast<uint32_t>(CryptomatteId("hello")), 0x248bfa47u);
  EXPECT_EQ(std::bit_cast<uint32_t>(CryptomatteId("hello, world")), 0x149bbb7fu);
  EXPECT_EQ(std::bit_cast<uint32_t>(CryptomatteId("The quick brown fox jumps over the lazy dog")), 0x2e4ff723u);
  for (int i = 0; i < 20000; ++i) ASSERT_TRUE(std::isnormal(CryptomatteId("name" + std::to_string(i))));
}

TEST(Cryptomatte, CoversWhatTheCameraSees) {
  const BuiltScene built = Staged({"crypto object", "crypto-material"}, false);
  const Layers layers(built);
  const auto objects = ManifestOf(built, "CryptoObject"), materials = ManifestOf(built, "CryptoMaterial");
  ASSERT_EQ(objects.size(), 3u);
  ASSERT_TRUE(objects.contains("ball"));
  EXPECT_TRUE(objects.contains("trianglemesh stage.pbrt:17:1"));
  ASSERT_TRUE(materials.contains("brass \"shiny\""));
  for (const auto& [name, id] : objects) EXPECT_EQ(id, std::bit_cast<uint32_t>(CryptomatteId(name)));
  double covered = 0;
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      const double ball = CoverageOf(layers, "CryptoObject", objects.at("ball"), x, y);
      EXPECT_NEAR(ball, CoverageOf(layers, "CryptoMaterial", materials.at("brass \"shiny\""), x, y), 1e-6);
      covered += ball;
    }
  }
  // A ball of radius 0.5 that is seen from 5.1, off the axis: its disk of tangent lines, stretched by perspective.
  const double tangent = 0.5 / std::sqrt(26 - 0.25), focal = 0.5 * kSize / std::tan(20 * M_PI / 180);
  EXPECT_NEAR(covered, M_PI * std::pow(focal * tangent, 2) * std::pow(26 / 25.0, 1.5), 4);
}

TEST(FirstHitLayers, PixelLayersAreInWorldSpaceAndSeeThroughMirrors) {
  const Layers plain(Staged({"N", "Z", "P", "uv", "albedo"}, false)), through(Staged({"N", "Z", "albedo"}, true));
  EXPECT_EQ(plain.Whole().channels, (std::vector<std::string>{"N.X", "N.Y", "N.Z", "Z", "P.X", "P.Y", "P.Z", "u", "v",
                                                              "Albedo.R", "Albedo.G", "Albedo.B"}));
  constexpr int kX = 8, kMirror = 2;
  EXPECT_NEAR(plain.At("N.Z", kX, kMirror), -1, 1e-5);
  EXPECT_NEAR(plain.At("Z", kX, kMirror), 7, 1e-4);
  EXPECT_NEAR(plain.At("P.Z", kX, kMirror), 2, 1e-4);
  EXPECT_NEAR(plain.At("Albedo.G", kX, kMirror), 1, 1e-3);
  // In the mirror is the wall behind the camera.
  EXPECT_NEAR(through.At("N.Z", kX, kMirror), 1, 1e-5);
  EXPECT_NEAR(through.At("Z", kX, kMirror), -2, 1e-4);
  EXPECT_NEAR(through.At("Albedo.G", kX, kMirror), 0.4, 1e-3);
}

}  // namespace
}  // namespace lampyr::test
