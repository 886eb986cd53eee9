// Changes that must not affect the picture: threads, passes, crops, the scene's scale and place.
#include <gtest/gtest.h>

#include "support/render_scene.h"

namespace lampyr::test {
namespace {

// `place` stands in front of everything, `unit` is a length.
std::string Scene(double scale, const std::string& offset = "0 0 0") {
  const std::string s = std::to_string(scale);
  const std::string lightScale = std::to_string(scale * scale);
  return R"(Film "rgb" "integer xresolution" 40 "integer yresolution" 24
PixelFilter "gaussian"
Scale 1 1 1
LookAt 0 1 3.2  0 0.5 0  0 1 0
Scale )" +
         std::to_string(1 / scale) + " " + std::to_string(1 / scale) + " " + std::to_string(1 / scale) + R"(
Translate )" +
         [&] {
           std::string negative;
           std::istringstream stream(offset);
           for (double v; stream >> v;) negative += std::to_string(-v) + " ";
           return negative;
         }() +
         R"(
Camera "perspective" "float fov" 40 "float lensradius" 0.02 "float focaldistance" 3
Integrator "path" "integer maxdepth" 6
WorldBegin
Translate )" +
         offset + "\nScale " + s + " " + s + " " + s + R"(
LightSource "point" "rgb I" [)" +
         lightScale + " " + lightScale + " " + lightScale + R"(] "point3 from" [1 2 1]
LightSource "infinite" "rgb L" [0.2 0.3 0.4]
AttributeBegin
AreaLightSource "diffuse" "rgb L" [6 5 4]
Translate -1 1.5 0
Shape "sphere" "float radius" 0.2
AttributeEnd
Material "diffuse" "rgb reflectance" [0.5 0.4 0.3]
Shape "trianglemesh" "point3 P" [-5 0 -5 -5 0 5 5 0 5 5 0 -5] "integer indices" [0 1 2 0 2 3]
Material "dielectric" "float eta" 1.5
AttributeBegin Translate 0.5 0.4 0.2 Shape "sphere" "float radius" 0.4 AttributeEnd
Material "conductor" "float roughness" 0.2
AttributeBegin Translate -0.5 0.4 0 Shape "sphere" "float radius" 0.4 AttributeEnd
)";
}

// By each integrator that finds all of this light.
class Invariance : public testing::TestWithParam<const char*> {
 protected:
  static Rendered Render(const std::string& text, int samplesPerPixel, RenderOverrides overrides = {},
                         int threads = 1) {
    overrides.integrator = GetParam();
    return RenderText(text, samplesPerPixel, overrides, threads);
  }
};
INSTANTIATE_TEST_SUITE_P(Of, Invariance, testing::Values("path", "bdpt", "sppm", "vcm"),
                         [](const auto& info) { return info.param; });

TEST_P(Invariance, SameBytesForAnyNumberOfThreads) {
  const Image one = Render(Scene(1), 16, {}, 1).image;
  for (const int threads : {2, 3, 4}) EXPECT_EQ(one.data, Render(Scene(1), 16, {}, threads).image.data) << threads;
}

TEST_P(Invariance, SeedsDiffer) {
  RenderOverrides other;
  other.seed = 7;
  EXPECT_NE(Render(Scene(1), 4).image.data, Render(Scene(1), 4, other).image.data);
}

TEST_P(Invariance, CroppedRenderIsCropOfRender) {
  RenderOverrides overrides;
  overrides.values["guide-paths"] = false;  // learns from what the crop sees
  const Image whole = Render(Scene(1), 8, overrides).image;
  overrides.crop = "9,30,3,20";
  const Image crop = Render(Scene(1), 8, overrides).image;
  ASSERT_EQ(crop.width, 21);
  ASSERT_EQ(crop.height, 17);
  for (int y = 0; y < crop.height; ++y) {
    for (int x = 0; x < crop.width; ++x) {
      for (size_t c = 0; c < 3; ++c) ASSERT_EQ(crop.At(x, y, c), whole.At(x + 9, y + 3, c)) << x << " " << y;
    }
  }
}

// Mean relative difference of pixels; the random numbers are the same, so only rounding differs.
double Difference(const Image& a, const Image& b) {
  double sum = 0, total = 0;
  for (int y = 0; y < a.height; ++y) {
    for (int x = 0; x < a.width; ++x) {
      sum += std::abs(static_cast<double>(a.At(x, y, 1) - b.At(x, y, 1)));
      total += static_cast<double>(b.At(x, y, 1));
    }
  }
  return sum / total;
}

TEST_P(Invariance, ScaleOfTheSceneDoesNotMatter) {
  const Image reference = Render(Scene(1), 64).image;
  for (const double scale : {1e-3, 1e3}) {
    const Rendered scaled = Render(Scene(scale), 64);
    EXPECT_LT(Difference(scaled.image, reference), 0.02) << scale;
    EXPECT_NEAR(MeanOf(scaled.image).mean, MeanOf(reference).mean, 0.004 * MeanOf(reference).mean) << scale;
    EXPECT_EQ(scaled.outcome.counts.droppedSamples, 0u);
    EXPECT_EQ(scaled.rejectedRays, 0u);
  }
}

TEST_P(Invariance, PlaceOfTheSceneDoesNotMatter) {
  const Image reference = Render(Scene(1), 64).image;
  for (const char* offset : {"100 -50 20", "100000 0 0", "-40000 80000 33333"}) {
    const Rendered moved = Render(Scene(1, offset), 64);
    EXPECT_LT(Difference(moved.image, reference), 0.02) << offset;
    EXPECT_NEAR(MeanOf(moved.image).mean, MeanOf(reference).mean, 0.004 * MeanOf(reference).mean) << offset;
  }
}

}  // namespace
}  // namespace lampyr::test
