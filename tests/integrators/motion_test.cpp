// Scenes that move while the shutter is open: the image is the mean of the images at all its times; rays and lights
// agree on where a light is.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "support/render_scene.h"

namespace lampyr::test {
namespace {

// A camera above a floor, and something that moves between them.
std::string Head(const std::string& options = "", const std::string& camera = "") {
  return R"(Film "rgb" "integer xresolution" 12 "integer yresolution" 12
PixelFilter "box"
)" + options +
         R"(LookAt 0 3 -4  0 0.4 0  0 1 0
Camera "perspective" "float fov" 45 )" +
         camera + R"(
Integrator "path" "integer maxdepth" 2
WorldBegin
AttributeBegin
Rotate -90 1 0 0
Shape "disk" "float radius" 4
AttributeEnd
)";
}

// The transform of time `x` in [0,1], as statements.
using MotionText = std::function<std::string(double)>;

struct Scene {
  const char* name;
  MotionText motion;
  std::string before, after;  // the statements around the motion
};

std::string Number(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.17g ", x);
  return text;
}

std::string Still(const Scene& scene, double x) {
  return Head() + scene.before + scene.motion(x) + scene.after;
}

std::string Moving(const Scene& scene, const std::string& options = "", const std::string& camera = "") {
  return Head(options, camera) + scene.before + "ActiveTransform StartTime\n" + scene.motion(0) +
         "ActiveTransform EndTime\n" + scene.motion(1) + "ActiveTransform All\n" + scene.after;
}

const std::string kEmission = "AreaLightSource \"diffuse\" \"rgb L\" [4 4 4]\n";

std::vector<Scene> Scenes() {
  const MotionText shift = [](double x) { return "Translate " + Number(2 * x - 1) + " 0.8 0\n"; };
  const MotionText turn = [](double x) {
    return "Translate " + Number(x - 0.5) + " 0.9 0 Rotate " + Number(30 + 80 * x) + " 1 0.3 0\n";
  };
  const MotionText grow = [](double x) {
    return "Translate 0 0.9 0 Scale " + Number(0.4 + x) + Number(0.6) + Number(0.4 + 0.5 * x) + "\n";
  };
  const std::string quad = "Shape \"bilinearmesh\" \"point3 P\" [-.5 -.5 0  .5 -.5 0  -.5 .5 0  .5 .5 0]\n";
  const std::string mesh =
      "Shape \"trianglemesh\" \"point3 P\" [-.5 -.5 0  .5 -.5 0  .5 .5 0  -.5 .5 0] \"integer indices\" [0 1 2 0 2 "
      "3]\n";
  const std::string sphere = "Shape \"sphere\" \"float radius\" 0.4\n";
  const std::string sky = "LightSource \"infinite\" \"rgb L\" [1 1 1]\n";
  const std::string cutOut =
      "Texture \"dots\" \"float\" \"checkerboard\" \"float uscale\" 4 \"float vscale\" 4 \"float tex1\" 1 \"float "
      "tex2\" 0.25\n";
  return {
      {"sphere shifts", shift, kEmission, sphere},
      {"sphere stretches", grow, kEmission, sphere},
      {"quad turns", turn, kEmission, quad},
      {"mesh turns", turn, kEmission, mesh},
      {"two-sided mesh turns", turn, "AreaLightSource \"diffuse\" \"bool twosided\" true\n", mesh},
      {"mesh that starts in its own place",
       [](double x) { return x > 0 ? "Translate " + Number(1.5 * x) + " 0 0\n" : std::string(); }, kEmission,
       "Shape \"trianglemesh\" \"point3 P\" [-1 .8 -.4  0 .8 -.4  0 .7 .4  -1 .7 .4] \"integer indices\" [0 1 2 0 2 "
       "3]\n"},
      {"instance turns", turn, "ObjectBegin \"o\"\n" + kEmission + mesh + sphere + "ObjectEnd\n",
       "ObjectInstance \"o\"\n"},
      {"shape moves within an object", shift, "ObjectBegin \"o\"\n" + kEmission,
       sphere + "ObjectEnd\nTranslate 0 0 0.3\nObjectInstance \"o\"\n"},
      {"shade moves", shift, sky, sphere},
      {"shade with holes turns", turn, sky + cutOut, "Shape \"disk\" \"texture alpha\" \"dots\"\n"},
      {"light with holes turns", turn, cutOut + kEmission, "Shape \"disk\" \"texture alpha\" \"dots\"\n"},
      {"curve moves", shift, sky,
       "Shape \"curve\" \"string type\" \"cylinder\" \"point3 P\" [-1 0 0 -.3 1 0 .3 -1 0 1 0 0] \"float width\" .4\n"},
      {"point moves", shift, "", "LightSource \"point\" \"rgb I\" [2 2 2]\n"},
      {"spot turns", turn, "",
       "LightSource \"spot\" \"rgb I\" [5 5 5] \"point3 from\" [0 0 0.5] \"point3 to\" [0 0 1] \"float coneangle\" "
       "50\n"},
      {"distant turns", turn, "", "LightSource \"distant\" \"point3 from\" [0 0 -1] \"point3 to\" [0 0 0]\n"}};
}

constexpr int kTimes = 24;

// The mean over the times of the images of what stays, by `samples` at each: every pixel, and its variance.
struct Pixels {
  std::vector<double> mean, variance;
};
Pixels PixelsOf(const Image& image) {
  Pixels pixels;
  const auto variance = static_cast<size_t>(image.ChannelIndex("variance.G"));
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      pixels.mean.push_back(static_cast<double>(image.At(x, y, 1)));
      pixels.variance.push_back(static_cast<double>(image.At(x, y, variance)));
    }
  }
  return pixels;
}
Pixels MeanOfTimes(const Scene& scene, int samples) {
  Pixels sum;
  for (int i = 0; i < kTimes; ++i) {
    RenderOverrides overrides;
    overrides.seed = static_cast<uint64_t>(100 + i);
    const Pixels one = PixelsOf(RenderText(Still(scene, (i + 0.5) / kTimes), samples, overrides).image);
    sum.mean.resize(one.mean.size());
    sum.variance.resize(one.mean.size());
    for (size_t p = 0; p < one.mean.size(); ++p) {
      sum.mean[p] += one.mean[p] / kTimes;
      sum.variance[p] += one.variance[p] / (kTimes * kTimes);
    }
  }
  return sum;
}

MeanValue Total(const Pixels& pixels) {
  MeanValue total;
  for (size_t p = 0; p < pixels.mean.size(); ++p) {
    total.mean += pixels.mean[p] / static_cast<double>(pixels.mean.size());
    total.standardError += pixels.variance[p];
  }
  total.standardError = std::sqrt(total.standardError) / static_cast<double>(pixels.mean.size());
  return total;
}

// Sum of the pixels' differences.
double Distance(const Pixels& a, const Pixels& b) {
  double distance = 0;
  for (size_t p = 0; p < a.mean.size(); ++p) distance += std::abs(a.mean[p] - b.mean[p]);
  return distance;
}

TEST(Motion, ImageIsTheMeanOverTheShutter) {
  int cases = 0;
  for (const Scene& scene : Scenes()) {
    const Rendered moving = RenderText(Moving(scene), 1024);
    EXPECT_EQ(moving.outcome.counts.droppedSamples + moving.rejectedRays, 0u) << scene.name;
    const Pixels image = PixelsOf(moving.image), reference = MeanOfTimes(scene, 128);
    const MeanValue a = Total(image), b = Total(reference);
    const double sigma = std::hypot(a.standardError, b.standardError);
    ASSERT_GT(b.mean, 0.01) << scene.name;
    EXPECT_LT(sigma, 0.02 * b.mean) << scene.name;
    // The midpoint rule over the times has an error of its own, of their distance squared.
    EXPECT_NEAR(a.mean, b.mean, 4.5 * sigma + 2e-3 * b.mean) << scene.name;
    // Not only in the mean: far nearer to it everywhere than any one time is. (Edges are coarse in the sum of few
    // times.)
    const Pixels open = PixelsOf(RenderText(Still(scene, 0), 1024).image);
    const Pixels middle = PixelsOf(RenderText(Still(scene, 0.5), 1024).image);
    const double distance = Distance(image, reference);
    EXPECT_LT(distance, 0.25 * Distance(open, reference)) << scene.name;
    EXPECT_LT(distance, 0.4 * Distance(middle, reference)) << scene.name;
    ++cases;
  }
  std::printf("%d cases\n", cases);
}

TEST(Motion, TransformTimesAndShutter) {
  const Scene scene = Scenes().front();
  // Transform times 1 to 3, shutter from 1.5 to 2.5: the middle half of the motion.
  const std::string camera = "\"float shutteropen\" 1.5 \"float shutterclose\" 2.5";
  const MeanValue part = MeanOf(RenderText(Moving(scene, "TransformTimes 1 3\n", camera), 1024).image);
  const MotionText whole = scene.motion;
  const Scene half = {"", [whole](double x) { return whole(0.25 + 0.5 * x); }, scene.before, scene.after};
  const MeanValue expected = MeanOf(RenderText(Moving(half), 1024).image);
  EXPECT_NEAR(part.mean, expected.mean, 4.5 * std::hypot(part.standardError, expected.standardError));
  // The shutter opens long before and closes long after: mostly where it starts and where it ends.
  const std::string longer = "\"float shutteropen\" -500 \"float shutterclose\" 501 ";
  const Pixels ends = PixelsOf(
      RenderText(
          Moving(scene,
                 "Film \"rgb\" \"integer xresolution\" 12 \"integer yresolution\" 12 \"float iso\" 0.0999000999\n",
                 longer),
          4096)
          .image);
  const Pixels start = PixelsOf(RenderText(Still(scene, 0), 1024).image),
               end = PixelsOf(RenderText(Still(scene, 1), 1024).image);
  for (size_t p = 0; p < ends.mean.size(); ++p) {
    const double sigma = std::sqrt(ends.variance[p] + (start.variance[p] + end.variance[p]) / 4);
    EXPECT_NEAR(ends.mean[p], 0.5 * (start.mean[p] + end.mean[p]), 5 * sigma + 0.02) << p;
  }
}

// Camera, media and textures stay where they are when the shutter opens, which may be within the transform times.
TEST(Motion, WhatCannotMoveIsPlacedAtShutterOpen) {
  const auto scene = [](bool moves, const std::string& camera, const std::string& inWorld) {
    // A camera turns around the world: half way it is not half turned in its place.
    const bool turns = camera != "camera";
    const std::string turn = "Translate 0.4 0 0.2\n" + std::string(turns ? "Rotate 40 0.2 1 0\n" : ""),
                      back = "Translate -0.4 0 0.2\n" + std::string(turns ? "Rotate -40 0.2 1 0\n" : "");
    const std::string motion =
        "ActiveTransform StartTime\n" + turn + "ActiveTransform EndTime\n" + back + "ActiveTransform All\n";
    const std::string middle = "Translate 0 0 0.2\n", placed = moves ? motion : middle;
    std::string text = "Film \"rgb\" \"integer xresolution\" 12 \"integer yresolution\" 12\n" +
                       std::string(moves ? "TransformTimes -1 1\n" : "") + (camera == "camera" ? placed : "") +
                       "LookAt 0 0.5 -4  0 0 0  0 1 0 Camera \"perspective\" \"float fov\" 45\nIntegrator \"path\"\n"
                       "WorldBegin\nLightSource \"infinite\"\nAttributeBegin\n";
    if (inWorld == "medium") {
      text += placed +
              "MakeNamedMedium \"m\" \"string type\" \"uniformgrid\" \"integer nx\" 2 \"float density\" [9 1] "
              "\"point3 p0\" [-1 -1 -1] \"point3 p1\" [1 1 1] \"rgb sigma_s\" [0 0 0] \"rgb sigma_a\" [1 1 1]\n"
              "AttributeEnd AttributeBegin\nMediumInterface \"m\" \"\" Material \"interface\"\n"
              "Shape \"sphere\" \"float radius\" 2\n";
    } else if (inWorld == "texture") {
      text += placed +
              "Texture \"t\" \"spectrum\" \"checkerboard\" \"integer dimension\" 3 \"rgb tex1\" [0.1 0.1 0.1] \"rgb "
              "tex2\" [0.9 0.9 0.9]\n"
              "AttributeEnd AttributeBegin\nMaterial \"diffuse\" \"texture reflectance\" \"t\"\nShape \"sphere\"\n";
    } else {
      text += "Translate 0.7 0.2 0 Shape \"sphere\"\n";
    }
    return text + "AttributeEnd\n";
  };
  for (const char* what : {"camera", "medium", "texture"}) {
    const MeanValue moved = MeanOf(RenderText(scene(true, what, what), 256).image);
    const Pixels a = PixelsOf(RenderText(scene(true, what, what), 256).image),
                 b = PixelsOf(RenderText(scene(false, what, what), 256).image);
    EXPECT_GT(moved.mean, 0.1) << what;
    EXPECT_LT(Distance(a, b), 0.02 * moved.mean) << what;
  }
}

TEST(Motion, AnyShutterOutsideOfTheMotionIsStill) {
  const Scene scene = Scenes().front();
  for (const bool after : {false, true}) {
    const std::string camera = after ? "\"float shutteropen\" 4 \"float shutterclose\" 5" : "";
    const std::string options = after ? "TransformTimes 1 3\n" : "TransformTimes 1 2\n";
    const Rendered moving = RenderText(Moving(scene, options, camera), 16);
    const Rendered still = RenderText(Still(scene, after ? 1 : 0), 16);
    EXPECT_EQ(moving.image.data, still.image.data) << after;
  }
}

TEST(Motion, OneMovingLightIsManyThatStay) {
  constexpr int n = 40;
  std::string many = Head();
  for (int i = 0; i < n; ++i) {
    many +=
        "LightSource \"point\" \"rgb I\" [0.1 0.1 0.1] \"point3 from\" [" + Number(2 * (i + 0.5) / n - 1) + " 0.8 0]\n";
  }
  const std::string one = Head() +
                          "ActiveTransform StartTime Translate -1 0.8 0\nActiveTransform EndTime Translate 1 0.8 0\n"
                          "ActiveTransform All\nLightSource \"point\" \"rgb I\" [4 4 4]\n";
  const Pixels a = PixelsOf(RenderText(one, 1024).image), b = PixelsOf(RenderText(many, 4096).image);
  int compared = 0;
  for (size_t p = 0; p < a.mean.size(); ++p) {
    const double sigma = std::sqrt(a.variance[p] + b.variance[p]);
    EXPECT_NEAR(a.mean[p], b.mean[p], 5 * sigma + 2e-3 * b.mean[p]) << p;
    compared += b.mean[p] > 0.05;
  }
  EXPECT_GT(compared, 60);
}

TEST(Motion, CameraSeesAMovingLightWhereItIs) {
  const std::string scene = R"(Film "rgb" "integer xresolution" 16 "integer yresolution" 1
PixelFilter "box"
Camera "orthographic" "float screenwindow" [0 16 0 1]
WorldBegin
ActiveTransform EndTime
Translate 8 0 0
ActiveTransform All
AreaLightSource "diffuse" "bool twosided" true SETTING
Shape "bilinearmesh" "point3 P" [2 0 5  6 0 5  2 1 5  6 1 5]
)";
  const auto render = [&](const std::string& setting) {
    std::string text = scene;
    text.replace(text.find("SETTING"), 7, setting);
    return PixelsOf(RenderText(text, 4096).image);
  };
  // A box of width 4 that moves by 8: the share of the time at which it covers x.
  const Pixels seen = render("");
  for (int x = 0; x < 16; ++x) {
    const auto covered = [](double at) { return (std::clamp(at - 2, 0.0, 8.0) - std::clamp(at - 6, 0.0, 8.0)) / 8; };
    const double expected = 0.5 * (covered(x) + covered(x + 1.0));
    EXPECT_NEAR(seen.mean[x], expected, 5 * std::sqrt(seen.variance[x]) + 1e-3) << x;
  }
  for (const double x : render("\"bool cameraVisible\" false").mean) EXPECT_EQ(x, 0);
}

TEST(Motion, SameBytesForAnyNumberOfThreads) {
  for (const Scene& scene : Scenes()) {
    EXPECT_EQ(RenderText(Moving(scene), 8, {}, 1).image.data, RenderText(Moving(scene), 8, {}, 2).image.data);
  }
}

std::string ErrorOf(const std::string& text) {
  try {
    Diagnostics diagnostics(Diagnostics::Mode::Collect);
    BuildScene(ParseScene(text, "test.pbrt", diagnostics), {}, true, diagnostics);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(Motion, MotionsThatDoNotExistAreLocatedErrors) {
  const std::string head = "WorldBegin\nActiveTransform EndTime\nScale -1 1 1\nActiveTransform All\n";
  const std::string flat =
      " that moves goes from a placement that mirrors to one that does not, or back: it would be flat on its way. "
      "Mirror at both times, after ActiveTransform All";
  EXPECT_EQ(ErrorOf(head + "Shape \"sphere\""), "test.pbrt:5:1: error: a shape" + flat);
  EXPECT_EQ(ErrorOf(head + "LightSource \"point\""), "test.pbrt:5:1: error: a light" + flat);
  EXPECT_EQ(
      ErrorOf("WorldBegin\nObjectBegin \"o\"\nShape \"sphere\"\nObjectEnd\nActiveTransform EndTime\nScale -1 1 1\n"
              "ObjectInstance \"o\""),
      "test.pbrt:7:1: error: an instance" + flat);
  EXPECT_EQ(ErrorOf("WorldBegin\nActiveTransform EndTime\nTranslate 1e30 0 0\nActiveTransform All\nShape \"sphere\""),
            "test.pbrt:5:1: error: the motion of a shape reaches farther than 1e18");
}

}  // namespace
}  // namespace lampyr::test
