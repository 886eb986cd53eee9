// Decisions of bidirectional path tracing: its techniques, and the places where its pictures must not flare.
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <tuple>

#include "integrators/bidirectional/bidirectional_integrator.h"
#include "support/replicas.h"

namespace lampyr::test {
namespace {

const std::string kHead = R"(Film "rgb" "integer xresolution" 32 "integer yresolution" 32
PixelFilter "box"
LookAt 0 1.6 3  0 0.3 0  0 1 0
Camera "perspective" "float fov" 40
Integrator "path" "integer maxdepth" 4
WorldBegin
)";
const std::string kGround = R"(Material "diffuse" "rgb reflectance" [0.5 0.5 0.5]
Shape "trianglemesh" "point3 P" [-3 0 -3 -3 0 3 3 0 3 3 0 -3] "integer indices" [0 1 2 0 2 3]
)";

// Bumps tilt the shading normals of a closed sphere: light paths scatter there with a weight that knows no bound.
TEST(Bdpt, BumpsDoNotFlare) {
  const Rendered rendered =
      RenderText(kHead + R"(LightSource "point" "rgb I" [3 3 3] "point3 from" [1.5 2.5 1]
Texture "bumps" "float" "checkerboard" "float uscale" 12 "float vscale" 12 "float tex1" 0 "float tex2" 0.05
)" + kGround +
                     R"(Material "diffuse" "rgb reflectance" [0.7 0.7 0.7] "texture displacement" "bumps"
Translate 0 0.6 0 Shape "sphere" "float radius" 0.6
)",
                 256, [] {
                   RenderOverrides overrides;
                   overrides.integrator = "bdpt";
                   return overrides;
                 }());
  const double mean = MeanOf(rendered.image).mean;
  double largest = 0;
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 32; ++x) largest = std::max(largest, static_cast<double>(rendered.image.At(x, y, 1)));
  }
  EXPECT_LT(largest, 100 * mean);
  EXPECT_EQ(rendered.outcome.counts.droppedSamples, 0u);
}

// A light that sends out no paths is found from the camera all the same, whatever else sends out paths.
TEST(Bdpt, LightsThatTraceNoPathsAreFound) {
  const std::string lamps = R"(AttributeBegin
AreaLightSource "diffuse" "rgb L" [8 7 6] "bool traceLightPaths" false
Translate -0.8 1.4 0 Shape "sphere" "float radius" 0.2
AttributeEnd
LightSource "infinite" "rgb L" [0.2 0.2 0.3] "bool traceLightPaths" false
LightSource "point" "rgb I" [1 1 1] "point3 from" [1 2 0.5]
)";
  const Replicas path = RenderReplicas(kHead + lamps + kGround, "path", 16, 32);
  const Replicas bdpt = RenderReplicas(kHead + lamps + kGround, "bdpt", 16, 32);
  EXPECT_TRUE(CompareReplicas(bdpt, path, 8, 1e-3).Agrees());
  EXPECT_EQ(path.faults + bdpt.faults, 0u);
}

// Each depth is the same as path tracing's: 0 shows the lights alone.
TEST(Bdpt, DepthCountsScatteringEvents) {
  const std::string lamp = R"(AttributeBegin AreaLightSource "diffuse" "rgb L" [5 5 5]
Translate 0 1.2 -0.5 Shape "sphere" "float radius" 0.3 AttributeEnd
)";
  for (const int depth : {0, 1, 2, 6}) {
    RenderOverrides overrides;
    overrides.values["max-depth"] = depth;
    const Replicas path = RenderReplicas(kHead + lamp + kGround, "path", 16, 32, overrides);
    const Replicas bdpt = RenderReplicas(kHead + lamp + kGround, "bdpt", 16, 32, overrides);
    const Agreement agreement = CompareReplicas(bdpt, path, 8, 1e-3);
    if (depth > 0) {
      EXPECT_TRUE(agreement.Agrees()) << depth;
    }
    EXPECT_LT(std::abs(agreement.bias), 0.01) << depth;
  }
}

// The layers of single techniques add up to the picture, in a crop and with a wide filter, too; beside a layer by an
// expression, with pixels of different numbers of samples, where light is carried by wavelength, and with a medium that
// glows.
class Strategies : public testing::TestWithParam<std::tuple<std::string, std::string>> {};

TEST_P(Strategies, AddUpToThePicture) {
  const auto& [integrator, what] = GetParam();
  RenderOverrides overrides;
  overrides.integrator = integrator;
  overrides.crop = "3,29,5,30";
  overrides.values["max-depth"] = 9;  // some are longer than those with layers of their own
  overrides.layers = {"strategies"};
  if (what == "layers") overrides.layers.emplace_back("caustic");
  if (what == "adaptive") overrides.adaptive.emplace();
  const std::string glass = what == "spectral" ? "\"spectrum eta\" \"glass-F11\"" : "\"float eta\" 1.5";
  std::string text = kHead + R"(LightSource "infinite" "rgb L" [0.2 0.2 0.3]
LightSource "point" "rgb I" [1 1 1] "point3 from" [1 2 0.5]
AttributeBegin AreaLightSource "diffuse" "rgb L" [8 7 6] Translate -0.8 1.2 -0.6 Shape "sphere" "float radius" 0.2 AttributeEnd
)" + kGround + "Material \"dielectric\" " +
                     glass + R"(
Translate 0 0.6 0 Shape "sphere" "float radius" 0.6
)";
  if (what == "glow")
    text +=
        R"(MakeNamedMedium "fire" "string type" "homogeneous" "rgb sigma_a" [1 1 1] "rgb sigma_s" [1 1 1] "rgb Le" [2 1 0.5]
MediumInterface "fire" "" Material "interface" Translate -0.7 0 -0.5 Shape "sphere" "float radius" 0.3
)";
  text.replace(text.find("\"box\""), 5, "\"gaussian\"");
  const Image image = RenderText(text, 16, overrides, 2).image;
  const bool mayBeNegative = what == "spectral";  // of one wavelength's red, green and blue
  std::vector<double> sum(3 * static_cast<size_t>(image.width) * static_cast<size_t>(image.height));
  std::set<std::string> seen;
  for (size_t k = 0; k < image.channels.size(); ++k) {
    const std::string& channel = image.channels[k];
    if (!channel.starts_with("weighted.")) continue;
    const int all = image.ChannelIndex("un" + channel);
    ASSERT_GE(all, 0) << channel;
    const size_t color = channel.ends_with("R") ? 0 : channel.ends_with("G") ? 1 : 2;
    for (int y = 0; y < image.height; ++y) {
      for (int x = 0; x < image.width; ++x) {
        const float weighted = image.At(x, y, k);
        sum[3 * (static_cast<size_t>(y) * static_cast<size_t>(image.width) + static_cast<size_t>(x)) + color] +=
            static_cast<double>(weighted);
        if (weighted != 0) seen.insert(channel.substr(0, channel.rfind('.')));
        if (!mayBeNegative) {
          EXPECT_GE(image.At(x, y, static_cast<size_t>(all)), weighted * 0.9999f) << channel;
        }
      }
    }
  }
  EXPECT_GE(seen.size(), 20u);
  EXPECT_EQ(seen.contains("weighted.merged"), integrator == "vcm");
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      for (size_t c = 0; c < 3; ++c) {
        const double whole = static_cast<double>(image.At(x, y, c));
        const size_t i = 3 * (static_cast<size_t>(y) * static_cast<size_t>(image.width) + static_cast<size_t>(x)) + c;
        ASSERT_NEAR(sum[i], whole, 1e-5 * std::abs(whole) + 1e-6) << x << " " << y;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Of, Strategies,
                         testing::Combine(testing::Values("bdpt", "vcm"),
                                          testing::Values("plain", "layers", "adaptive", "spectral", "glow")),
                         [](const auto& tested) {
                           return std::get<0>(tested.param) + "_" + std::get<1>(tested.param);
                         });

TEST(Bdpt, StrategiesAreOfIntegratorsThatHaveThem) {
  RenderOverrides overrides;
  overrides.integrator = "path";
  overrides.layers = {"strategies"};
  EXPECT_THROW(RenderText(kHead + kGround, 1, overrides), UsageError);
  std::string text = kHead + kGround;
  text.insert(text.find("\nPixelFilter"), " \"string layers\" [ \"strategies\" ]");
  try {
    RenderOverrides ofScene;
    ofScene.integrator = "path";
    RenderText(text, 1, ofScene);
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("only bdpt, vcm have strategies"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("test.pbrt:"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace lampyr::test
