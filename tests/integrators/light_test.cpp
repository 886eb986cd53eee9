// Light tracing by itself: energy where it is known, borders, the numbers of paths, what must not change a picture.
#include <gtest/gtest.h>

#include <cmath>

#include "render/passes.h"
#include "support/replicas.h"

namespace lampyr::test {
namespace {

std::string Furnace(const std::string& filter, double reflectance, int size = 16) {
  const std::string r = std::to_string(reflectance), s = std::to_string(size);
  return "Film \"rgb\" \"integer xresolution\" " + s + " \"integer yresolution\" " + s + "\nPixelFilter \"" + filter +
         R"("
Camera "perspective" "float fov" 70
Integrator "light" "integer maxdepth" 400
WorldBegin
AreaLightSource "diffuse" "rgb L" [1 1 1]
Material "diffuse" "rgb reflectance" [)" +
         r + " " + r + " " + r + "]\nReverseOrientation\nShape \"sphere\" \"float radius\" 3\n";
}

TEST(Light, ClosedFurnace) {
  for (const double reflectance : {0.0, 0.5, 0.8}) {
    const Rendered rendered = RenderText(Furnace("box", reflectance), 1024);
    const MeanValue value = MeanOf(rendered.image);
    const double expected = 1 / (1 - reflectance);
    EXPECT_LT(value.standardError, 0.01 * expected) << reflectance;
    EXPECT_NEAR(value.mean, expected, 4 * value.standardError) << reflectance;
    EXPECT_EQ(rendered.outcome.counts.droppedSamples + rendered.rejectedRays, 0u);
  }
}

// In a furnace all pixels are alike: border pixels get what lies beyond the border, no more and no less.
TEST(Light, BordersAreAsBrightAsTheMiddle) {
  for (const char* filter : {"box", "triangle", "gaussian", "mitchell", "sinc"}) {
    const Replicas replicas = RenderReplicas(Furnace(filter, 0.3), "light", 10, 200);
    const struct {
      const char* name;
      int x0, y0, x1, y1;
    } parts[] = {{"left", 0, 0, 1, 16},     {"right", 15, 0, 16, 16}, {"top", 0, 0, 16, 1},
                 {"bottom", 0, 15, 16, 16}, {"corner", 0, 0, 1, 1},   {"middle", 4, 4, 12, 12}};
    for (const auto& part : parts) {
      const auto moments =
          replicas_internal::MomentsOf(replicas_internal::Means(replicas, 1, part.x0, part.y0, part.x1, part.y1));
      const double error = std::sqrt(moments.variance);
      EXPECT_NEAR(moments.mean, 1 / 0.7, 6 * error) << filter << " " << part.name;
      EXPECT_LT(error, 0.05) << filter << " " << part.name;
    }
  }
}

// The spread of pixels and of the whole image over replicas is what the variance layer says.
TEST(Light, VarianceLayersMatchTheSpread) {
  RenderOverrides overrides;
  overrides.sampler = "independent";
  const Replicas replicas = RenderReplicas(Furnace("gaussian", 0.5), "light", 64, 16, overrides);
  const auto variance = static_cast<size_t>(replicas.images[0].ChannelIndex("variance.G"));
  double estimated = 0, spread = 0;
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 16; ++x) {
      const auto moments = replicas_internal::MomentsOf(replicas_internal::Means(replicas, 1, x, y, x + 1, y + 1));
      spread += moments.variance * 64;
      for (const Image& image : replicas.images) estimated += static_cast<double>(image.At(x, y, variance)) / 64;
    }
  }
  // 256 · 63 degrees of freedom, a fifth of them independent: 2.5 % at one standard error.
  EXPECT_NEAR(estimated / spread, 1, 0.1);
}

const std::string kHead = R"(Film "rgb" "integer xresolution" 40 "integer yresolution" 30
LookAt 0 2 3  0 0.3 0  0 1 0
Camera "perspective" "float fov" 40 "float lensradius" 0.05 "float focaldistance" 3
Integrator "light" "integer maxdepth" 5
)";
const std::string kWorld = R"(WorldBegin
LightSource "point" "rgb I" [4 3 2] "point3 from" [1 2 1]
LightSource "infinite" "rgb L" [0.2 0.3 0.4]
AttributeBegin AreaLightSource "diffuse" "rgb L" [6 5 4] Translate -1 1.2 0 Shape "sphere" "float radius" 0.2 AttributeEnd
Material "diffuse" "rgb reflectance" [0.5 0.4 0.3]
Shape "trianglemesh" "point3 P" [-3 0 -3 -3 0 3 3 0 3 3 0 -3] "integer indices" [0 1 2 0 2 3]
AttributeBegin Material "dielectric" "float eta" 1.5 Translate 0.4 0.4 0 Shape "sphere" "float radius" 0.4 AttributeEnd
)";

TEST(Light, SameBytesForAnyNumberOfThreads) {
  const Image one = RenderText(kHead + kWorld, 24, {}, 1).image;
  EXPECT_GT(MeanOf(one).mean, 0.01);
  for (const int threads : {2, 3, 5})
    EXPECT_EQ(one.data, RenderText(kHead + kWorld, 24, {}, threads).image.data) << threads;
}

TEST(Light, SameBytesHoweverTheSamplesAreDivided) {
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  const BuiltScene built = BuildScene(ParseScene(kHead + kWorld, "test.pbrt", diagnostics), {}, true, diagnostics);
  const std::unique_ptr<Integrator> light = MakeIntegrator(built.scene, built.settings);
  const PixelFilter filter(built.settings.filter);
  const auto render = [&](std::initializer_list<uint32_t> passes) {
    Film film(built.settings.width, built.settings.height, built.settings.crop);
    uint32_t first = 0;
    for (const uint32_t count : passes) {
      RenderPass(built.scene, *light, built.settings, filter, first, count, 2, film);
      first += count;
    }
    EXPECT_EQ(film.LightPaths(), uint64_t{first} * 40 * 30);
    return film.Develop().data;
  };
  const std::vector<float> whole = render({17});
  EXPECT_EQ(render({1, 2, 3, 11}), whole);
  EXPECT_EQ(render({16, 1}), whole);
}

TEST(Light, CroppedRenderIsCropOfRender) {
  const Image whole = RenderText(kHead + kWorld, 16).image;
  for (const char* window : {"9,30,3,20", "0,7,0,30", "39,40,29,30"}) {
    RenderOverrides overrides;
    overrides.crop = window;
    const Image crop = RenderText(kHead + kWorld, 16, overrides).image;
    for (int y = 0; y < crop.height; ++y) {
      for (int x = 0; x < crop.width; ++x) {
        for (size_t c = 0; c < 6; ++c) {
          ASSERT_EQ(crop.At(x, y, c), whole.At(x + crop.offsetX, y + crop.offsetY, c))
              << window << " " << x << " " << y;
        }
      }
    }
  }
}

// maxdepth counts scattering events: 0 shows lamps, 1 direct light.
TEST(Light, DepthCountsScatteringEvents) {
  double light[3], path[3];
  for (int depth = 0; depth < 3; ++depth) {
    RenderOverrides overrides;
    overrides.values["max-depth"] = depth;
    light[depth] = MeanOf(RenderText(Furnace("box", 0.5), 512, overrides).image).mean;
    overrides.integrator = "path";
    path[depth] = MeanOf(RenderText(Furnace("box", 0.5), 64, overrides).image).mean;
    EXPECT_NEAR(light[depth], 2 - std::pow(0.5, depth), 0.02);
    EXPECT_NEAR(path[depth], 2 - std::pow(0.5, depth), 0.02);
  }
}

TEST(Light, AnEmptySceneAndADarkOneAreBlack) {
  for (const char* world : {"WorldBegin\n", "WorldBegin\nShape \"sphere\"\n",
                            "WorldBegin\nLightSource \"point\" \"rgb I\" [0 0 0]\nShape \"sphere\"\n"}) {
    const Rendered rendered = RenderText(kHead + world, 2);
    EXPECT_EQ(MeanOf(rendered.image).mean, 0) << world;
    EXPECT_EQ(rendered.outcome.counts.droppedSamples, 0u);
  }
}

}  // namespace
}  // namespace lampyr::test
