// Several camera rays where the camera sees the edges of lights: the same picture with less noise.
#include <gtest/gtest.h>

#include "agreement/agreement_scenes.h"
#include "render/light_edges.h"
#include "support/render_scene.h"
#include "support/replicas.h"

namespace lampyr::test {
namespace {

// Lamps in and out of focus before a dim sky, one with holes, one seen through fog; a floor that they light.
std::string Lamps(const std::string& filter = "gaussian", const std::string& film = "") {
  std::string text = "Film \"rgb\" \"integer xresolution\" 40 \"integer yresolution\" 24 " + film + "\nPixelFilter \"" +
                     filter +
                     "\"\nLookAt 0 1 -4  0 0.8 0  0 1 0\n"
                     "Camera \"perspective\" \"float fov\" 45 \"float lensradius\" 0.1 \"float focaldistance\" 4\n" +
                     World(4) + "LightSource \"infinite\" \"rgb L\" [0.02 0.03 0.05]\n" +
                     "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"rgb sigma_s\" [0.3 0.3 0.3] \"rgb "
                     "sigma_a\" [0.1 0.1 0.1]\n"
                     "Material \"diffuse\" \"rgb reflectance\" [0.4 0.4 0.4]\n"
                     "Shape \"bilinearmesh\" \"point3 P\" [-9 0 -3  9 0 -3  -9 0 20  9 0 20]\n"
                     "AttributeBegin MediumInterface \"fog\" \"\" Material \"interface\" Translate 1 0.9 0 Shape "
                     "\"sphere\" \"float radius\" 0.6 AttributeEnd\n";
  const auto lamp = [&](const char* at, const char* radiance, const char* shape) {
    text += std::string("AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [") + radiance +
            "] \"string lightGroup\" \"" + radiance + "\" Translate " + at + " Shape " + shape + " AttributeEnd\n";
  };
  lamp("-1 0.8 0", "20 15 5", "\"sphere\" \"float radius\" 0.12");
  lamp("1 0.9 0", "15 15 20", "\"sphere\" \"float radius\" 0.15");
  lamp("-2 3 9", "60 20 10", "\"sphere\" \"float radius\" 0.1");
  lamp("1.5 2.5 12", "10 60 20", "\"sphere\" \"float radius\" 0.08");
  lamp("0 1.2 1", "30 30 30", "\"disk\" \"float radius\" 0.2 \"float alpha\" 0.5");
  return text;
}

RenderOverrides Edges(bool on) {
  RenderOverrides overrides;
  overrides.values["light-edges"] = on;
  return overrides;
}

class LightEdgesIn : public testing::TestWithParam<const char*> {};

TEST_P(LightEdgesIn, ChangesTheNoiseAlone) {
  RenderOverrides overrides = Edges(true);
  const Replicas with = RenderReplicas(Lamps(), GetParam(), 12, 32, overrides);
  overrides = Edges(false);
  overrides.seed = 100;
  const Replicas without = RenderReplicas(Lamps(), GetParam(), 12, 96, overrides);
  const double rate = SidakRate(1e-3, 4);
  const Agreement result = CompareReplicas(with, without, 8, rate);
  std::printf("%s: %d blocks, largest |z| %.2f (threshold %.2f), chi2 %.1f (%.1f), bias %+.3f %% +- %.3f %%\n",
              GetParam(), result.blocks, result.largestZ, result.thresholdZ, result.chiSquared,
              result.chiSquaredThreshold, 100 * result.bias, 196 * result.biasError);
  EXPECT_TRUE(result.Agrees());
  EXPECT_EQ(with.faults, 0u);
  EXPECT_FALSE(CompareReplicas(with, without, 8, rate, 1.05).Agrees()) << "too noisy";
}

INSTANTIATE_TEST_SUITE_P(Integrators, LightEdgesIn, testing::Values("path", "bdpt", "sppm", "vcm"));

double NoiseOf(const std::string& text, const RenderOverrides& overrides, int samples) {
  const Replicas replicas = RenderReplicas(text, "path", 12, samples, overrides);
  double sum = 0;
  for (int y = 0; y < 24; ++y) {
    for (int x = 0; x < 40; ++x)
      sum +=
          replicas_internal::MomentsOf(replicas_internal::Means(replicas, 1, x, y, x + 1, y + 1)).variance / (24 * 40);
  }
  return sum;
}

TEST(LightEdges, LowerTheNoise) {
  const double with = NoiseOf(Lamps(), Edges(true), 16), without = NoiseOf(Lamps(), Edges(false), 16);
  std::printf("variance of a pixel: %.4g with further rays, %.4g without\n", with, without);
  EXPECT_LT(with, 0.4 * without);
}

// Neither a limit on samples nor a filter with negative weights can be divided among rays.
TEST(LightEdges, AreLeftAloneWhereSamplesCannotBeDivided) {
  for (const std::string& text : {Lamps("mitchell"), Lamps("box", "\"float maxcomponentvalue\" 10")})
    EXPECT_EQ(RenderText(text, 4, Edges(true)).image.data, RenderText(text, 4, Edges(false)).image.data);
  EXPECT_NE(RenderText(Lamps("box"), 4, Edges(true)).image.data, RenderText(Lamps("box"), 4, Edges(false)).image.data);
}

// The sky behind a ball of the same brightness has no edge: with several rays for the one and a single one for the
// other the noise would be larger.
TEST(LightEdges, AreNotThoseOfABackgroundAsBrightAsWhatIsBeforeIt) {
  const std::string text =
      "Film \"rgb\" \"integer xresolution\" 24 \"integer yresolution\" 24\nLookAt 0 0 -4  0 0 0  0 1 0\n"
      "Camera \"perspective\" \"float fov\" 45\n" +
      World(4) +
      "LightSource \"infinite\" \"rgb L\" [1 1 1]\nMaterial \"diffuse\" \"rgb reflectance\" [0.8 0.8 0.8]\n"
      "Shape \"sphere\" \"float radius\" 1\n";
  EXPECT_EQ(RenderText(text, 4, Edges(true)).image.data, RenderText(text, 4, Edges(false)).image.data);
}

TEST(LightEdges, SameBytesForAnyThreadsAndCrop) {
  for (const char* integrator : {"path", "bdpt", "sppm"}) {
    RenderOverrides overrides;
    overrides.integrator = integrator;
    const Image whole = RenderText(Lamps(), 8, overrides, 1).image;
    EXPECT_EQ(whole.data, RenderText(Lamps(), 8, overrides, 3).image.data) << integrator;
    if (std::string(integrator) == "sppm") continue;  // whose photons learn from what the camera sees
    overrides.values["guide-paths"] = overrides.values["learn-lights"] = false;
    const Image unguided = RenderText(Lamps(), 8, overrides).image;
    // The second is far from the brightest lamps.
    for (const char* window : {"9,30,3,20", "0,8,14,24"}) {
      overrides.crop = window;
      const Image crop = RenderText(Lamps(), 8, overrides).image;
      for (int y = 0; y < crop.height; ++y) {
        for (int x = 0; x < crop.width; ++x)
          ASSERT_EQ(crop.At(x, y, 1), unguided.At(x + crop.offsetX, y + crop.offsetY, 1)) << x << " " << y;
      }
    }
  }
}

// A lamp that is as bright everywhere has no edges within, however bright another one is.
TEST(LightEdges, AreNotWithinALamp) {
  const std::string text =
      "Film \"rgb\" \"integer xresolution\" 32 \"integer yresolution\" 32\n"
      "LookAt 0 0 -4  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 45\n" +
      World(4) +
      "AreaLightSource \"diffuse\" \"rgb L\" [2 2 2] Shape \"bilinearmesh\" \"point3 P\" [-9 -9 0 9 "
      "-9 0 -9 9 0 9 9 0]\nAreaLightSource \"diffuse\" \"rgb L\" [1e5 1e5 1e5] Translate 0 0 -1 "
      "Shape \"sphere\" \"float radius\" 0.02\n";
  RenderOverrides overrides = Edges(true);
  overrides.integrator = "path";
  const auto rays = [&](const char* crop) {
    overrides.crop = crop;
    return RenderText(text, 4, overrides).outcome.counts.cameraRays;
  };
  EXPECT_EQ(rays("0,10,0,32"), 4u * 10 * 32);
  EXPECT_GT(rays("14,18,14,18"), 4u * 4 * 4);
}

}  // namespace
}  // namespace lampyr::test
