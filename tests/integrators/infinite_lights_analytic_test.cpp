// Floors lit from infinity: path tracing and light tracing against closed forms.
#include <gtest/gtest.h>

#include <cmath>

#include "support/render_scene.h"

namespace lampyr::test {
namespace {

// A patch of floor of reflectance 0.5 in the plane y = 0, [-half, half]² around the origin, seen from above by a camera
// that is not in any window's way: `sky` are the lights and what stands about.
Rendered RenderFloor(const std::string& integrator, const std::string& lights, double half, int samples) {
  const std::string h = std::to_string(half);
  return RenderText(R"(Film "rgb" "integer xresolution" 8 "integer yresolution" 8
PixelFilter "box"
LookAt 0 0.5 0  0 0 0  0 0 1
Camera "orthographic" "float screenwindow" [-)" +
                        h + " " + h + " -" + h + " " + h + "]\nIntegrator \"" + integrator +
                        "\" \"integer maxdepth\" 1\nWorldBegin\n" + lights + R"(
Material "diffuse" "rgb reflectance" [0.5 0.5 0.5]
Shape "bilinearmesh" "point3 P" [-4 0 -4  4 0 -4  -4 0 4  4 0 4]
)",
                    samples);
}

// Radiance of the floor for an irradiance.
void ExpectFloor(const std::string& lights, double irradiance, double half = 0.5) {
  const std::string kLight = "light";  // most of its photons land beside the small patch that is seen
  for (const std::string& integrator : {std::string("path"), kLight}) {
    const Rendered rendered = RenderFloor(integrator, lights, half, integrator == kLight ? 16384 : 1024);
    const MeanValue value = MeanOf(rendered.image);
    EXPECT_LT(value.standardError, 0.05 * irradiance * 0.5 / M_PI) << integrator;
    EXPECT_NEAR(value.mean, irradiance * 0.5 / M_PI, 4 * value.standardError + 1e-3 * irradiance) << integrator;
    EXPECT_EQ(rendered.outcome.counts.droppedSamples, 0u);
  }
}

const std::string kDownwards = " \"point3 from\" [0 1 0] \"point3 to\" [0 0 0] ";

TEST(InfiniteLightsAnalytic, SunOfAnyAngle) {
  // L π sin²θ for the half angle θ; the cosine at 45° for one aside.
  ExpectFloor("LightSource \"distant\" \"rgb L\" [3 3 3]" + kDownwards, 3);
  ExpectFloor("LightSource \"distant\" \"rgb L\" [3 3 3] \"float angle\" 60" + kDownwards, 3 * M_PI * 0.25);
  ExpectFloor("LightSource \"distant\" \"rgb L\" [3 3 3] \"float angle\" 60 \"bool normalize\" true" + kDownwards, 3);
  ExpectFloor(
      "LightSource \"distant\" \"float illuminance\" 2 \"float angle\" 0.53 \"point3 from\" [1 1 0] \"point3 to\" "
      "[0 0 0]",
      2 * std::sqrt(0.5));
}

TEST(InfiniteLightsAnalytic, DomeAndItsTint) {
  ExpectFloor("LightSource \"dome\" \"float intensity\" 0.5 \"float exposure\" 1 \"float diffuse\" 3", 3 * M_PI);
}

// Irradiance on a floor below the middle of a window of half sides a and b in a ceiling at height h: that of a
// rectangle of radiance L, four times Lambert's corner formula.
double UnderWindow(double L, double a, double b, double h) {
  const double x = a / h, y = b / h;
  return 4 * 0.5 * L *
         (x / std::sqrt(1 + x * x) * std::atan(y / std::sqrt(1 + x * x)) +
          y / std::sqrt(1 + y * y) * std::atan(x / std::sqrt(1 + y * y)));
}

TEST(InfiniteLightsAnalytic, WindowOverTheFloor) {
  // Light goes through the portal towards its -z: down.
  const std::string portal =
      "AttributeBegin Translate 0 1 0 Rotate -90 1 0 0 LightSource \"portal\" \"float width\" 2 \"float height\" 1 "
      "\"float "
      "intensity\" 4 AttributeEnd";
  ExpectFloor(portal, UnderWindow(4, 1, 0.5, 1), 0.05);
  // pbrt-v4's grammar; corners counterclockwise as seen from inside, and the light's transform without meaning for
  // them.
  const std::string infinite =
      "AttributeBegin Rotate 30 1 1 1 LightSource \"infinite\" \"rgb L\" [4 4 4] \"point3 portal\" [-1 1 -0.5  1 1 "
      "-0.5  1 1 0.5  -1 1 0.5] AttributeEnd";
  ExpectFloor(infinite, UnderWindow(4, 1, 0.5, 1), 0.05);
  // Seen from its back it sends nothing.
  const std::string reversed =
      "LightSource \"infinite\" \"rgb L\" [4 4 4] \"point3 portal\" [-1 1 -0.5  -1 1 0.5  1 1 0.5  1 1 -0.5]";
  for (const char* integrator : {"path", "light"}) {
    EXPECT_EQ(MeanOf(RenderFloor(integrator, reversed, 0.05, 16).image).mean, 0) << integrator;
  }
}

TEST(InfiniteLightsAnalytic, WhatIsOutsideOfTheWindowShadesAndIsNotLit) {
  // A board above half of the window, seen from above: the sky that it hides is hidden, and its outer side is dark.
  const std::string portal =
      "AttributeBegin Translate 0 1 0 Rotate -90 1 0 0 LightSource \"portal\" \"float width\" 2 \"float height\" 2 "
      "AttributeEnd\nMaterial \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5]\nShape \"bilinearmesh\" \"point3 P\" [0 "
      "1.001 -4  "
      "4 1.001 -4  0 1.001 4  4 1.001 4]\n";
  ExpectFloor(portal, UnderWindow(1, 1, 1, 1) / 2, 0.05);
  for (const char* integrator : {"path", "light"}) {
    const Rendered above = RenderText(R"(Film "rgb" "integer xresolution" 8 "integer yresolution" 8
LookAt 0.5 3 0  0.5 0 0  0 0 1
Camera "orthographic" "float screenwindow" [-0.3 0.3 -0.3 0.3]
Integrator ")" + std::string(integrator) + "\" \"integer maxdepth\" 1\nWorldBegin\n" +
                                          portal,
                                      64);
    EXPECT_EQ(MeanOf(above.image).mean, 0) << integrator;
  }
}

}  // namespace
}  // namespace lampyr::test
