// The film's sensor with every integrator: exposure, white balance, and the limit on the brightness of samples.
#include <gtest/gtest.h>

#include "base/error.h"
#include "integrators/registry.h"
#include "spectral/color_space.h"
#include "support/render_scene.h"

namespace lampyr {
namespace {

using test::RenderText;

// A warm lamp and a blue one on a matte floor, with a mirror; two layers. The box filter of one pixel: a pixel has no
// samples but its own.
std::string SceneWith(const std::string& film) {
  return R"(Camera "perspective" "float fov" 50
Sampler "independent"
PixelFilter "box"
Film "rgb" "integer xresolution" 12 "integer yresolution" 8 )" +
         film + R"(
WorldBegin
LightSource "point" "rgb I" [9 5 2] "point3 from" [-1 1 2] "string lightGroup" "warm"
AttributeBegin
Translate 1 1.2 3
AreaLightSource "diffuse" "rgb L" [1 2 8] "string lightGroup" "cold"
Shape "sphere" "float radius" 0.3
AttributeEnd
Material "diffuse" "rgb reflectance" [0.7 0.6 0.5]
Shape "trianglemesh" "point3 P" [-9 -1 0 9 -1 0 9 -1 9 -9 -1 9] "integer indices" [0 1 2 0 2 3]
Material "conductor" "float roughness" 0.3
Translate 0 -0.4 4
Shape "sphere" "float radius" 0.6
)";
}

RenderOverrides With(const std::string& integrator) {
  RenderOverrides overrides;
  overrides.integrator = integrator;
  overrides.values["light-edges"] = false;  // which a limit on samples turns off
  return overrides;
}

Color LayerAt(const Image& image, int x, int y, const std::string& layer) {
  const auto value = [&](const char* channel) {
    return image.At(x, y, static_cast<size_t>(image.ChannelIndex(layer + "." + channel)));
  };
  return {value("R"), value("G"), value("B")};
}

void ExpectNear(const Color& a, const Color& b, float tolerance) {
  EXPECT_NEAR(a.r, b.r, tolerance);
  EXPECT_NEAR(a.g, b.g, tolerance);
  EXPECT_NEAR(a.b, b.b, tolerance);
}

// The same samples: the picture, and each layer, is a linear map of the one without a white balance.
TEST(Sensor, BalancesWhatEveryIntegratorFinds) {
  const glm::dmat3 balance = WhiteBalance(3200);
  const auto balanced = [&](const Color& c) {
    const Vector3 v(balance * Vector3d(c.r, c.g, c.b));
    return Color(v.x, v.y, v.z);
  };
  for (const IntegratorType& type : IntegratorRegistry()) {
    SCOPED_TRACE(type.name);
    const Image plain = RenderText(SceneWith(""), 4, With(type.name)).image;
    const Image warm = RenderText(SceneWith("\"float whitebalance\" 3200"), 4, With(type.name)).image;
    float brightest = 0;
    for (int y = 0; y < plain.height; ++y) {
      for (int x = 0; x < plain.width; ++x) {
        brightest = std::max(brightest, plain.RgbAt(x, y).Max());
        const float tolerance = 1e-5f * (plain.RgbAt(x, y).Max() + 1e-3f);
        ExpectNear(warm.RgbAt(x, y), balanced(plain.RgbAt(x, y)), tolerance);
        for (const char* layer : {"warm", "cold"})
          ExpectNear(LayerAt(warm, x, y, layer), balanced(LayerAt(plain, x, y, layer)), tolerance);
      }
    }
    EXPECT_GT(brightest, 0);
  }
}

// A sensor that is named has the CIE observer's picture.
TEST(Sensor, NamedOnesTakeTheExposureAndTheBalance) {
  const Image observer = RenderText(SceneWith("\"float whitebalance\" 5000 \"float iso\" 200"), 2, With("path")).image;
  const Image named =
      RenderText(SceneWith("\"string sensor\" \"canon_eos_5d_mkiv\" \"float whitebalance\" 5000 \"float iso\" 200"), 2,
                 With("path"))
          .image;
  EXPECT_EQ(observer.data, named.data);
}

// pbrt-v4 limits the largest of the sensor's channels, which are X, Y and Z of the CIE observer.
TEST(Sensor, LimitsSamples) {
  const float limit = 0.4f;
  const auto limited = [&](const Color& c) {
    const Vector3 xyz(Rec709ToXyz() * Vector3d(c.r, c.g, c.b));
    return c * std::min(1.0f, limit / std::max({xyz.x, xyz.y, xyz.z, 1e-20f}));
  };
  for (const IntegratorType& type : IntegratorRegistry()) {
    SCOPED_TRACE(type.name);
    const Image plain = RenderText(SceneWith(""), 1, With(type.name)).image;
    const Image high = RenderText(SceneWith("\"float maxcomponentvalue\" 1e30"), 1, With(type.name)).image;
    EXPECT_EQ(plain.data, high.data);
    const Image low = RenderText(SceneWith("\"float maxcomponentvalue\" 0.4"), 1, With(type.name)).image;
    double before = 0, after = 0;
    for (int y = 0; y < plain.height; ++y) {
      for (int x = 0; x < plain.width; ++x) {
        const Color is = low.RgbAt(x, y), was = plain.RgbAt(x, y);
        before += static_cast<double>(was.Luminance());
        after += static_cast<double>(is.Luminance());
        if (type.name == "path") ExpectNear(is, limited(was), 1e-5f);
        ExpectNear(is, LayerAt(low, x, y, "warm") + LayerAt(low, x, y, "cold"), 1e-5f * (is.Max() + 1));
      }
    }
    EXPECT_LT(after, 0.95 * before);
  }
}

// The limit applies to what a splat adds to a pixel, whatever the number of pixels.
TEST(Sensor, LimitsSplatsAsSamplesOfAPixel) {
  const auto mean = [](const std::string& integrator, const std::string& film, const std::string& size) {
    std::string text = SceneWith(film);
    const std::string small = "\"integer xresolution\" 12 \"integer yresolution\" 8";
    text.replace(text.find(small), small.size(), size);
    const Image image = RenderText(text, 64, With(integrator)).image;
    double sum = 0;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) sum += static_cast<double>(image.RgbAt(x, y).Luminance());
    return sum / (image.width * image.height);
  };
  const std::string small = "\"integer xresolution\" 24 \"integer yresolution\" 16",
                    large = "\"integer xresolution\" 48 \"integer yresolution\" 32",
                    limit = "\"float maxcomponentvalue\" 0.4";
  const double path = mean("path", limit, large), whole = mean("path", "", large);
  for (const char* integrator : {"light", "bdpt", "vcm"}) {
    const double few = mean(integrator, limit, small), many = mean(integrator, limit, large);
    std::printf("[   info   ] %s: %.4g of few pixels, %.4g of many; path %.4g, without a limit %.4g\n", integrator, few,
                many, path, whole);
    EXPECT_NEAR(few, many, 0.05 * many) << integrator;
    EXPECT_GT(many, 0.6 * path) << integrator;  // not equal: each integrator has bright samples of its own
    EXPECT_LT(many, whole) << integrator;
  }
}

TEST(Sensor, WhiteBalanceMakesTheLightWhite) {
  // CIE illuminant A is a black body of 2856 K at (0.44757, 0.40745); D50 is daylight at (0.3457, 0.3585), D65 ours.
  const struct {
    double kelvin, x, y;
  } lights[] = {{2856, 0.44757, 0.40745}, {5003, 0.3457, 0.3585}, {6504, 0.3127, 0.3290}};
  for (const auto& light : lights) {
    const Vector3d white = WhiteBalance(light.kelvin) * XyzToRec709(XyzOfChromaticity(light.x, light.y));
    EXPECT_NEAR(white.x / white.y, 1, 0.01) << light.kelvin;
    EXPECT_NEAR(white.z / white.y, 1, 0.015) << light.kelvin;
    EXPECT_NEAR(glm::dot(white, Vector3d(0.2126390, 0.7151687, 0.0721923)), 1, 1e-3) << light.kelvin;
  }
}

TEST(Sensor, RefusesWhatIsNone) {
  EXPECT_THROW(RenderText(SceneWith("\"float whitebalance\" 30"), 1), Error);
  EXPECT_THROW(RenderText(SceneWith("\"float maxcomponentvalue\" 0"), 1), Error);
  EXPECT_THROW(RenderText(SceneWith("\"string sensor\" \"canon_eos_5x\""), 1), Error);
}

}  // namespace
}  // namespace lampyr
