// The layers of Film "gbuffer", where they are known in closed form.
#include <gtest/gtest.h>

#include <cmath>

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
  for (const std::string& channel : FirstHitChannels()) EXPECT_EQ(crop.At(channel, 2, 4), whole.At(channel, 5, 9));
}

TEST(FirstHitLayers, AnUnknownSpaceIsNamed) {
  try {
    Build("\"string coordinatesystem\" \"wrld\"", Square(kMatte, 0));
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("did you mean \"world\""), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace lampyr::test
