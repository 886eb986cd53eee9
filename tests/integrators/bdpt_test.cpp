// What bidirectional path tracing decides by itself: which techniques there are, and where its pictures must not flare.
#include <gtest/gtest.h>

#include <cmath>

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

// The pictures of single techniques add up to the render, in a crop and with a wide filter, too.
TEST(Bdpt, TechniquesAddUpToTheRender) {
  RenderOverrides overrides;
  overrides.integrator = "bdpt";
  overrides.crop = "3,29,5,30";
  overrides.values["max-depth"] = 9;  // some are longer than those with a picture
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  std::string text = kHead + R"(LightSource "infinite" "rgb L" [0.2 0.2 0.3]
LightSource "point" "rgb I" [1 1 1] "point3 from" [1 2 0.5]
AttributeBegin AreaLightSource "diffuse" "rgb L" [8 7 6] Translate -0.8 1.2 -0.6 Shape "sphere" "float radius" 0.2 AttributeEnd
)" + kGround + R"(Material "dielectric" "float eta" 1.5
Translate 0 0.6 0 Shape "sphere" "float radius" 0.6
)";
  text.replace(text.find("\"box\""), 5, "\"gaussian\"");
  const BuiltScene built = BuildScene(ParseScene(text, "test.pbrt", diagnostics), overrides, true, diagnostics);
  const RenderSettings& settings = built.settings;
  Film film(settings.width, settings.height, settings.crop);
  TechniqueImages techniques(settings.width, settings.height, settings.crop, settings.MaxDepth());
  StopConditions stop;
  stop.samplesPerPixel = 16;
  Render(
      built.scene, *MakeIntegrator(built.scene, settings), settings, stop, 2, film, [](const RenderOutcome&, double) {},
      &techniques);
  const Image image = film.Develop();
  const auto pictures = techniques.Develop(film);
  std::vector<double> sum(3 * static_cast<size_t>(image.width) * static_cast<size_t>(image.height));
  int seen = 0;
  for (const TechniqueImages::Picture& picture : pictures) {
    bool isBlack = true;
    for (size_t i = 0; i < sum.size(); ++i) {
      sum[i] += static_cast<double>(picture.weighted.data[i]);
      isBlack = isBlack && picture.weighted.data[i] == 0;
      EXPECT_GE(picture.unweighted.data[i], picture.weighted.data[i] * 0.9999f);
    }
    seen += isBlack ? 0 : 1;
  }
  EXPECT_GE(seen, 20);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      for (size_t c = 0; c < 3; ++c) {
        const double whole = static_cast<double>(image.At(x, y, c));
        const size_t i = 3 * (static_cast<size_t>(y) * static_cast<size_t>(image.width) + static_cast<size_t>(x)) + c;
        ASSERT_NEAR(sum[i], whole, 1e-5 * whole + 1e-7) << x << " " << y;
      }
    }
  }
}

}  // namespace
}  // namespace lampyr::test
