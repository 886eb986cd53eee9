// --target-error keeps its promise: a render that stops at an estimated error is really within it, also where the error
// is made by a few bright paths that most samples miss.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "render/analysis/unseen_samples.h"
#include "support/render_scene.h"

namespace lampyr {
namespace {

constexpr int kSeeds = 20;

struct Promise {
  const char* name;
  std::string text;
  double targetError;
  int referenceSamples;  // of bdpt
};

void PrintTo(const Promise& promise, std::ostream* stream) {
  *stream << promise.name;
}

BuiltScene Build(const std::string& text, const std::string& integrator) {
  RenderOverrides overrides;
  overrides.integrator = integrator;
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  return BuildScene(ParseScene(text, "test.pbrt", diagnostics), overrides, true, diagnostics);
}

// Root of the mean square error of the luminance over its mean.
double TrueError(const Image& image, const Image& reference) {
  double squares = 0, mean = 0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const double truth = static_cast<double>(reference.RgbAt(x, y).Luminance());
      squares += std::pow(static_cast<double>(image.RgbAt(x, y).Luminance()) - truth, 2);
      mean += truth;
    }
  }
  const double pixels = static_cast<double>(image.width) * image.height;
  return std::sqrt(squares / pixels) / (mean / pixels);
}

const std::string kStart = R"(LookAt 0 2.2 2.6  0 0.3 0  0 1 0
Film "rgb" "integer xresolution" 24 "integer yresolution" 24
Camera "perspective" "float fov" 42
Integrator "path" "integer maxdepth" 6
WorldBegin
Material "diffuse" "rgb reflectance" [0.6 0.5 0.4]
Shape "trianglemesh" "point3 P" [-2.5 0 -2.5  -2.5 0 2.5  2.5 0 2.5  2.5 0 -2.5] "integer indices" [0 1 2 0 2 3]
)";
const std::string kGlassBall = R"(AttributeBegin
Material "dielectric" "float eta" 1.5
Translate 0 0.6 0 Shape "sphere" "float radius" 0.5
AttributeEnd
)";
const std::string kMirrorBall = R"(AttributeBegin
Material "conductor" "rgb reflectance" [0.9 0.9 0.9] "float roughness" 0
Translate 0 0.6 0 Shape "sphere" "float radius" 0.5
AttributeEnd
LightSource "infinite" "rgb L" [0.2 0.3 0.4]
)";
std::string Lamp(const std::string& radiance, const std::string& radius) {
  return "AttributeBegin\nAreaLightSource \"diffuse\" \"rgb L\" [" + radiance +
         "]\nTranslate 0.8 2 0.2 Shape \"sphere\" \"float radius\" " + radius + "\nAttributeEnd\n";
}

// A ball of the material in the middle of a large plain.
double UnseenSampleOf(const std::string& material, double radius, const std::string& light) {
  const std::string plain =
      "Shape \"trianglemesh\" \"point3 P\" [-50 0 -50  -50 0 50  50 0 50  50 0 -50] \"integer indices\" [0 1 2 0 2 "
      "3]\n";
  const BuiltScene built = Build(kStart + plain + "AttributeBegin\nMaterial " + material +
                                     "\nTranslate 0 0.3 0 Shape \"sphere\" \"float radius\" " + std::to_string(radius) +
                                     "\nAttributeEnd\n" + light,
                                 "path");
  return LargestUnseenSample(built.scene, built.settings);
}

TEST(UnseenSamples, AreAsBrightAsWhatFallsOnSomethingSmooth) {
  const std::string lamp = Lamp("30 30 30", "0.2");
  EXPECT_NEAR(UnseenSampleOf("\"dielectric\"", 0.3, lamp), 30, 1e-3);
  EXPECT_NEAR(UnseenSampleOf("\"conductor\" \"float roughness\" 0.01", 0.3, lamp), 30,
              1e-3);  // not a delta, but nearly
  EXPECT_EQ(UnseenSampleOf("\"conductor\" \"float roughness\" 0.5", 0.3, lamp), 0);
  EXPECT_EQ(UnseenSampleOf("\"diffuse\"", 0.3, lamp), 0);
  // A marble that hardly any photon meets is met from the camera; a point is never hit at all.
  EXPECT_NEAR(UnseenSampleOf("\"dielectric\"", 0.05, "LightSource \"infinite\" \"rgb L\" [2 2 2]\n"), 2, 1e-3);
  EXPECT_EQ(UnseenSampleOf("\"dielectric\"", 0.3, "LightSource \"point\" \"rgb I\" [2 2 2] \"point3 from\" [0 3 0]\n"),
            0);
}

// The film limits samples.
TEST(UnseenSamples, AreLimitedAsSamplesAre) {
  std::string text = kStart;
  const std::string film = "Film \"rgb\"";
  ASSERT_NE(text.find(film), std::string::npos);
  text.replace(text.find(film), film.size(), film + " \"float maxcomponentvalue\" 5");
  const BuiltScene built =
      Build(text + Lamp("30 30 30", "0.2") + "Material \"dielectric\" Shape \"sphere\" \"float radius\" 0.3\n", "path");
  // The limit is on the sensor's own channels: somewhat less of linear sRGB.
  const double largest = LargestUnseenSample(built.scene, built.settings);
  EXPECT_LE(largest, 5);
  EXPECT_GT(largest, 4);
}

class TargetError : public testing::TestWithParam<std::tuple<Promise, const char*>> {};

TEST_P(TargetError, HoldsForNineteenOfTwentySeeds) {
  const auto& [promise, integrator] = GetParam();
  const Image reference = test::RenderBuilt(Build(promise.text, "bdpt"), promise.referenceSamples, 1).image;
  BuiltScene built = Build(promise.text, integrator);
  const std::unique_ptr<Integrator> chosen = MakeIntegrator(built.scene, built.settings);
  StopConditions stop;
  stop.samplesPerPixel = 1 << 20;
  stop.relativeError = promise.targetError;
  stop.largestSample = LargestUnseenSample(built.scene, built.settings);
  int kept = 0, samples = 0;
  double largest = 0, mean = 0;
  for (int seed = 0; seed < kSeeds; ++seed) {
    built.settings.seed = 1000 + static_cast<uint64_t>(seed);
    Film film(built.settings.width, built.settings.height, built.settings.crop);
    const RenderOutcome outcome =
        Render(built.scene, *chosen, built.settings, stop, 2, film, [](const RenderOutcome&, double) {});
    EXPECT_LE(outcome.relativeError, promise.targetError);
    const double error = TrueError(film.Develop(), reference);
    kept += error <= promise.targetError;
    largest = std::max(largest, error);
    mean += error / kSeeds;
    samples = std::max(samples, outcome.samplesPerPixel);
  }
  std::printf("%s, %s at %.2g: kept in %d of %d, error %.3g in the mean, at most %.3g, at most %d spp\n", promise.name,
              integrator, promise.targetError, kept, kSeeds, mean, largest, samples);
  EXPECT_GE(kept, 19);
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, TargetError,
    testing::Combine(testing::Values(Promise{"matte", kStart + Lamp("30 28 26", "0.2"), 0.02, 1024},
                                     Promise{"caustic", kStart + kGlassBall + Lamp("30 28 26", "0.2"), 0.45, 4096},
                                     Promise{"mirror", kStart + kMirrorBall + Lamp("30 28 26", "0.2"), 0.5, 2048}),
                     testing::Values("path", "bdpt")),
    [](const auto& info) { return std::string(std::get<0>(info.param).name) + "_" + std::get<1>(info.param); });

}  // namespace
}  // namespace lampyr
