// A floor lit by each of the lights that are a point: the radiance of a spot of it against I cosθ/d² by hand.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>

#include "support/render_scene.h"
#include "support/temporary_folder.h"

namespace lampyr::test {
namespace {

// Mean colour of the floor at (x, 0, z), reflectance 0.5, seen from above at an angle. A lit spot must be even: these
// are places in the middle of a texel or of a smooth profile.
Color FloorAt(double x, double z, const std::string& lights) {
  const std::string at = std::to_string(x) + " 0 " + std::to_string(z);
  const std::string eye = std::to_string(x) + " 0.5 " + std::to_string(z + 2);
  const auto rendered = RenderText("LookAt " + eye + "  " + at + R"(  0 1 0
Camera "perspective" "float fov" 0.05
Film "rgb" "integer xresolution" 8 "integer yresolution" 8
PixelFilter "box"
Integrator "path" "integer maxdepth" 1
WorldBegin
Material "diffuse" "rgb reflectance" [0.5 0.5 0.5]
Shape "trianglemesh" "point3 P" [-9 0 -9 -9 0 9 9 0 9 9 0 -9] "integer indices" [0 1 2 0 2 3]
)" + lights,
                                   4);
  const auto mean = [&](size_t channel) { return static_cast<float>(MeanOf(rendered.image, channel).mean); };
  return {mean(0), mean(1), mean(2)};
}

// Radiance of the floor at (x, z) by a point of intensity I at height 2 above the origin.
Color FromHeightTwo(double x, double z, const Color& intensity) {
  const double squared = 4 + x * x + z * z;
  return intensity * static_cast<float>(0.5 / M_PI * (2 / std::sqrt(squared)) / squared);
}

void ExpectNear(const Color& color, const Color& expected) {
  EXPECT_NEAR(color.r, expected.r, 1e-3f * expected.r + 1e-7f);
  EXPECT_NEAR(color.g, expected.g, 1e-3f * expected.g + 1e-7f);
  EXPECT_NEAR(color.b, expected.b, 1e-3f * expected.b + 1e-7f);
}

class PointLightsAnalytic : public ::testing::Test {
 protected:
  std::string Write(int width, int height, const std::function<Color(int, int)>& texel) {
    Image image(width, height, {"R", "G", "B"});
    for (int i = 0; i < width * height; ++i) {
      const Color c = texel(i % width, i / width);
      image.At(i % width, i / width, 0) = c.r;
      image.At(i % width, i / width, 1) = c.g;
      image.At(i % width, i / width, 2) = c.b;
    }
    const std::filesystem::path file = folder_.Path() / "image.exr";
    WriteExr(file, image, ExrPrecision::Float);
    return "\"string filename\" \"" + file.string() + "\" ";
  }

  TemporaryFolder folder_;
};

TEST_F(PointLightsAnalytic, PointWithAllThatMultipliesIt) {
  const Color expected = Color(24, 24, 36) * 0.25f;
  ExpectNear(FloorAt(0.3, -0.4, R"(LightSource "point" "rgb I" [4 2 1] "point3 from" [0 2 0] "float intensity" 3
  "float exposure" 2 "rgb color" [0.5 1 3] "float diffuse" 0.25 "float specular" 7 "bool normalize" true)"),
             FromHeightTwo(0.3, -0.4, expected));
}

TEST_F(PointLightsAnalytic, SpotInItsSoftEdge) {
  // At (1, 0): cosθ = 2/√5; the cone of 40° ends within 30° of softness at 10°.
  const double edge = std::cos(40 * M_PI / 180), core = std::cos(10 * M_PI / 180);
  const double t = (2 / std::sqrt(5.0) - edge) / (core - edge);
  const auto expected = static_cast<float>(t * t * (3 - 2 * t));
  const std::string spot = R"(LightSource "spot" "rgb I" [5 4 3] "point3 from" [0 2 0] "point3 to" [0 0 0]
  "float coneangle" 40 "float conedeltaangle" 30)";
  ExpectNear(FloorAt(1, 0, spot), FromHeightTwo(1, 0, Color(5, 4, 3) * expected));
  ExpectNear(FloorAt(0.2, 0.1, spot), FromHeightTwo(0.2, 0.1, Color(5, 4, 3)));
  ExpectNear(FloorAt(1.7, 0, spot), Color(0.0f));
}

// The projector looks down: its +z is -y of the world, its +y (the image's top) is +z. At 90° the 4 × 2 image covers
// |x| < 4, |z| < 2 of the floor, 2 × 2 a texel.
TEST_F(PointLightsAnalytic, ProjectionOnTheFloor) {
  const auto texel = [](int x, int y) { return Color(1.0f + x, 10.0f + y, 5.0f * (x + y)); };
  const std::string light = "AttributeBegin Translate 0 2 0 Rotate 90 1 0 0 LightSource \"projection\" " +
                            Write(4, 2, texel) + "\"float scale\" 2 AttributeEnd";
  for (int x = 0; x < 4; ++x) {
    for (int y = 0; y < 2; ++y) {
      SCOPED_TRACE(std::to_string(x) + " " + std::to_string(y));
      ExpectNear(FloorAt(-3 + 2 * x, 1 - 2 * y, light), FromHeightTwo(-3 + 2 * x, 1 - 2 * y, texel(x, y) * 2));
    }
  }
  ExpectNear(FloorAt(4.1, 0, light), Color(0.0f));
  ExpectNear(FloorAt(0, -2.1, light), Color(0.0f));
}

// Straight down is -y, the corners of the image; turned over (Rotate 180 about x) it is the middle, and the image's
// right edge is +x, its lower edge (local +z) -z of the world.
TEST_F(PointLightsAnalytic, GoniometricOnTheFloor) {
  const auto texel = [](int x, int y) { return Color(static_cast<float>(1 + x + 5 * y)); };
  const std::string light = "LightSource \"goniometric\" \"rgb I\" [1 2 3] " + Write(5, 5, texel) + "AttributeEnd";
  const std::string upright = "AttributeBegin Translate 0 2 0 " + light;
  ExpectNear(FloorAt(0.1, 0.1, upright), FromHeightTwo(0.1, 0.1, Color(1, 2, 3) * 25.0f));
  ExpectNear(FloorAt(-0.1, 0.1, upright), FromHeightTwo(-0.1, 0.1, Color(1, 2, 3) * 21.0f));
  ExpectNear(FloorAt(0.1, -0.1, upright), FromHeightTwo(0.1, -0.1, Color(1, 2, 3) * 5.0f));
  const std::string over = "AttributeBegin Translate 0 2 0 Rotate 180 1 0 0 " + light;
  ExpectNear(FloorAt(0.1, 0.1, over), FromHeightTwo(0.1, 0.1, Color(1, 2, 3) * 13.0f));
  // r = √(1 - cosθ) = 0.53 of half the image away from its middle: the next texel but one would begin at 0.6.
  ExpectNear(FloorAt(2, 0, over), FromHeightTwo(2, 0, Color(1, 2, 3) * 14.0f));
  ExpectNear(FloorAt(0, -2, over), FromHeightTwo(0, -2, Color(1, 2, 3) * 18.0f));
  ExpectNear(FloorAt(0, 2, over), FromHeightTwo(0, 2, Color(1, 2, 3) * 8.0f));
}

TEST_F(PointLightsAnalytic, PowerOfAProjector) {
  // White at 90°: I = Φ / (4π/6).
  const std::string light = "AttributeBegin Translate 0 2 0 Rotate 90 1 0 0 LightSource \"projection\" " +
                            Write(3, 3, [](int, int) { return Color(0.2f); }) + "\"float power\" 10 AttributeEnd";
  ExpectNear(FloorAt(0.3, 0.2, light), FromHeightTwo(0.3, 0.2, Color(static_cast<float>(10 / (4 * M_PI / 6)))));
}

// 100, 60 and 0 cd at 0°, 45° and 90° from the nadir.
TEST_F(PointLightsAnalytic, ProfilesOnTheFloor) {
  const std::filesystem::path file = folder_.Path() / "lamp.ies";
  std::ofstream(file) << "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 3 1 1 2 0 0 0\n1 1 0\n0 45 90\n0\n100 60 0\n";
  const std::string ies = " \"string shaping:ies:file\" \"" + file.string() + "\" ";
  // A point's profile is about -z: turned to look down. At (1, 0): θ = atan(1/2).
  const auto candela = static_cast<float>(100 - 40 * std::atan(0.5) / (M_PI / 4));
  const std::string point =
      "AttributeBegin Translate 0 2 0 Rotate -90 1 0 0 LightSource \"point\" \"rgb I\" [3 2 1]" + ies + "AttributeEnd";
  ExpectNear(FloorAt(1, 0, point), FromHeightTwo(1, 0, Color(3, 2, 1) * candela));
  ExpectNear(FloorAt(0, -1, point), FromHeightTwo(0, -1, Color(3, 2, 1) * candela));
  // A spot's is about its own axis.
  const std::string spot = R"(LightSource "spot" "rgb I" [3 2 1] "point3 from" [0 2 0] "point3 to" [0 0 0]
  "float coneangle" 40 "float conedeltaangle" 5)" +
                           ies;
  ExpectNear(FloorAt(1, 0, spot), FromHeightTwo(1, 0, Color(3, 2, 1) * candela));
  // Normalised: times 4π over the profile's ∫ 2π I sinθ dθ, of two linear pieces over π/4 each.
  const double slope = 40 / (M_PI / 4), steep = 60 / (M_PI / 4), q = std::sqrt(0.5);
  // ∫ θ sinθ = sinθ - θ cosθ
  const double first = 100 * (1 - q) - slope * (q - M_PI / 4 * q);
  const double second = 120 * q - steep * (1 - (q - M_PI / 4 * q));
  const std::string even = point.substr(0, point.size() - 12) + "\"bool shaping:ies:normalize\" true AttributeEnd";
  ExpectNear(FloorAt(1, 0, even),
             FromHeightTwo(1, 0, Color(3, 2, 1) * candela * static_cast<float>(2 / (first + second))));
}

TEST_F(PointLightsAnalytic, ConeOfAPoint) {
  // 1 - smoothstep(θ; 20°, 40°) at θ = atan(1/2).
  const std::string light =
      "AttributeBegin Translate 0 2 0 Rotate -90 1 0 0 LightSource \"point\" \"rgb I\" [3 2 1] \"float "
      "shaping:cone:angle\" 40 \"float shaping:cone:softness\" 0.5 AttributeEnd";
  const double t = (std::atan(0.5) * 180 / M_PI - 20) / 20;
  ExpectNear(FloorAt(1, 0, light), FromHeightTwo(1, 0, Color(3, 2, 1) * static_cast<float>(1 - t * t * (3 - 2 * t))));
  ExpectNear(FloorAt(1.7, 0, light), Color(0.0f));
}

}  // namespace
}  // namespace lampyr::test
