// Photons that are aimed where they have been of use: the same picture as ever, much sooner where few of them get to
// what the camera sees, and nothing else elsewhere.
#include <gtest/gtest.h>

#include <cmath>
#include <ctime>
#include <fstream>
#include <string>

#include "support/replicas.h"

namespace lampyr::test {
namespace {

std::string WindowScene() {
  std::ifstream file(std::string(LAMPYR_SOURCE_DIR) + "/scenes/window.pbrt");
  return {std::istreambuf_iterator<char>(file), {}};
}

// Without pane and glass, so that path tracing can do it, and on a smaller meadow: what photons bring by way of a large
// one is rare and much, and its mean over few pictures far from normal.
std::string OpenWindowScene() {
  std::string text = WindowScene();
  const auto replace = [&](const std::string& from, const std::string& to) {
    const size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    text.replace(at, from.size(), to);
  };
  replace("Material \"dielectric\" \"float eta\" 1.52", "Material \"interface\"");
  replace("Material \"dielectric\" \"float eta\" 1.5", "Material \"diffuse\" \"rgb reflectance\" [ 0.8 0.7 0.6 ]");
  replace("[ -50 -50 0  50 -50 0  -50 50 0  50 50 0 ]", "[ -6 -6 0  6 -6 0  -6 6 0  6 6 0 ]");
  replace("Translate 3.5 11 1.2", "Translate 2.5 5 1.2");
  replace("Translate -7.5 6 -0.4", "Translate -4.5 -1 -0.4");
  // Something smooth, unseen: without, vcm does not guide.
  text += "Material \"conductor\" \"float roughness\" 0\nTranslate 0 0 -1 Shape \"disk\" \"float radius\" 0.1\n";
  return text;
}

constexpr const char* kBox = R"(LookAt 0 1 -3  0 1 0  0 1 0
Camera "perspective" "float fov" 40
Film "rgb" "integer xresolution" 32 "integer yresolution" 32
Integrator "vcm" "integer maxdepth" 6
WorldBegin
Material "diffuse" "rgb reflectance" [ 0.6 0.6 0.6 ]
Shape "bilinearmesh" "point3 P" [ -1 0 -1  1 0 -1  -1 0 1  1 0 1 ]
Shape "bilinearmesh" "point3 P" [ -1 2 -1  1 2 -1  -1 2 1  1 2 1 ]
Shape "bilinearmesh" "point3 P" [ -1 0 1  1 0 1  -1 2 1  1 2 1 ]
Shape "bilinearmesh" "point3 P" [ -1 0 -1  -1 0 1  -1 2 -1  -1 2 1 ]
Shape "bilinearmesh" "point3 P" [ 1 0 -1  1 0 1  1 2 -1  1 2 1 ]
AttributeBegin AreaLightSource "diffuse" "rgb L" [ 5 5 5 ]
Shape "bilinearmesh" "point3 P" [ -0.3 1.99 -0.3  -0.3 1.99 0.3  0.3 1.99 -0.3  0.3 1.99 0.3 ] AttributeEnd
)";

RenderOverrides Small(const char* integrator, bool guides, uint64_t seed = 0, int width = 64) {
  RenderOverrides overrides;
  overrides.integrator = integrator;
  overrides.width = width;
  overrides.height = width * 9 / 16;
  overrides.values["guide-photons"] = guides;
  overrides.seed = seed;
  return overrides;
}

TEST(PhotonGuiding, AgreesWithPathTracing) {
  const std::string text = OpenWindowScene();
  const Replicas path = RenderReplicas(text, "path", 16, 256, Small("path", false, 1000));
  for (const char* integrator : {"vcm", "sppm"}) {
    RenderOverrides overrides = Small(integrator, true);
    overrides.values["radius"] = 0.02;
    overrides.values["photons"] = 10000;
    EXPECT_GT(RenderText(text, 32, overrides).outcome.photons->guideComponents, 0u) << integrator;
    // Few photons of sppm come through the window, and a block of 16 pictures may have none of the brightest.
    const int replicas = integrator == std::string("sppm") ? 64 : 16;
    const Replicas guided = RenderReplicas(text, integrator, replicas, 32, overrides);
    const Agreement result = CompareReplicas(guided, path, 9, 5e-4);
    std::printf("%s: %d blocks, largest |z| %.2f (threshold %.2f), chi2 %.1f (%.1f), bias %+.3f %% +- %.3f %%\n",
                integrator, result.blocks, result.largestZ, result.thresholdZ, result.chiSquared,
                result.chiSquaredThreshold, 100 * result.bias, 196 * result.biasError);
    EXPECT_TRUE(result.Agrees()) << integrator;
    EXPECT_EQ(guided.faults + path.faults, 0u);
    EXPECT_FALSE(CompareReplicas(guided, path, 9, 5e-4, 1.1).Agrees()) << "too noisy";
  }
}

struct GuidingEfficiency {
  double squaredError = 0, seconds = 0;
};

GuidingEfficiency Measure(const std::string& text, const char* integrator, bool guides, const Image& reference) {
  GuidingEfficiency measured;
  constexpr int seeds = 2;
  for (uint64_t seed = 1; seed <= seeds; ++seed) {
    const std::clock_t start = std::clock();
    const Rendered rendered = RenderText(text, 128, Small(integrator, guides, seed, reference.width));
    measured.seconds += static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC / seeds;
    EXPECT_EQ(rendered.outcome.photons->guideComponents > 0, guides);
    for (int y = 0; y < reference.height; ++y) {
      for (int x = 0; x < reference.width; ++x) {
        for (size_t c = 0; c < 3; ++c) {
          const auto difference = static_cast<double>(rendered.image.At(x, y, c) - reference.At(x, y, c));
          const double scale = static_cast<double>(reference.At(x, y, c)) + 1e-2;
          measured.squaredError +=
              difference * difference / (scale * scale * seeds * 3 * reference.width * reference.height);
        }
      }
    }
  }
  return measured;
}

double GainOf(const std::string& text, const char* integrator, const Image& reference) {
  const GuidingEfficiency without = Measure(text, integrator, false, reference),
                          with = Measure(text, integrator, true, reference);
  const double gain = without.squaredError * without.seconds / (with.squaredError * with.seconds);
  std::printf("%s: relative squared error %.3g without, %.3g with guiding; time x %.2f; efficiency x %.1f\n",
              integrator, without.squaredError, with.squaredError, with.seconds / without.seconds, gain);
  return gain;
}

// Guided camera paths would take the weight from photons, so that a guide of these would seem useless.
TEST(PhotonGuiding, IsNotHiddenByGuidedPaths) {
  for (const uint64_t seed : {1, 2}) {
    const Rendered rendered = RenderText(WindowScene(), 64, Small("vcm", true, seed));
    EXPECT_GT(rendered.outcome.photons->guideComponents, 0u) << seed;
    EXPECT_GT(rendered.outcome.photons->guideGain, 100) << seed;
  }
}

// A hundred by a hundred metres of ground in the sun, and a window of one: ten times the efficiency at least.
TEST(PhotonGuiding, PaysBehindAWindow) {
  const Image reference = RenderText(WindowScene(), 1024, Small("vcm", true, 99)).image;
  EXPECT_GT(GainOf(WindowScene(), "vcm", reference), 10);
  EXPECT_GT(GainOf(WindowScene(), "sppm", reference), 2);  // few, large photons make its error: 3.6 to 14
}

bool IsSame(const Image& a, const Image& b) {
  return a.data == b.data;
}

TEST(PhotonGuiding, TheSameForAnyThreadsAndPasses) {
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  const BuiltScene built =
      BuildScene(ParseScene(WindowScene(), "test.pbrt", diagnostics), Small("sppm", true), true, diagnostics);
  const Rendered one = RenderBuilt(built, 20, 1), two = RenderBuilt(built, 20, 2);
  EXPECT_GT(one.outcome.photons->guideComponents, 0);
  EXPECT_TRUE(IsSame(one.image, two.image));
  const std::unique_ptr<Integrator> integrator = MakeIntegrator(built.scene, built.settings);
  Film film(built.settings.width, built.settings.height, built.settings.crop);
  ProgressiveRender render(built.scene, *integrator, built.settings, 2, film);
  for (const int count : {1, 4, 2, 12, 1}) render.AddSamples(count);
  EXPECT_TRUE(IsSame(one.image, film.Develop()));
}

TEST(PhotonGuiding, NothingIsAimedWhereEverythingIsOfUse) {
  const auto render = [](bool guides) {
    RenderOverrides overrides = Small("vcm", guides);
    overrides.values["connect"] = false;      // with connections it would not be tried, since nothing is smooth
    overrides.values["guide-paths"] = false;  // paths are recorded when that is settled
    return RenderText(kBox, 32, overrides);
  };
  const Rendered with = render(true), without = render(false);
  EXPECT_EQ(with.outcome.photons->guideComponents, 0);
  std::printf("closed box: guiding promised x %.2f\n", with.outcome.photons->guideGain);
  EXPECT_TRUE(IsSame(with.image, without.image));
}

// Photons have the opacity of the place where they start as a factor, however their direction was chosen.
TEST(PhotonGuiding, KnowsTheCutOutsOfALamp) {
  for (const char* shape : {"Shape \"disk\" \"float radius\" 0.5",
                            "Shape \"bilinearmesh\" \"point3 P\" [-0.4 -0.4 0  0.4 -0.4 0  -0.4 0.4 0  0.4 0.4 0]"}) {
    const std::string text = std::string(R"(LookAt 0 -4 2  0 0 0  0 0 1
Camera "perspective" "float fov" 40
Film "rgb" "integer xresolution" 24 "integer yresolution" 24
Integrator "path" "integer maxdepth" 4
WorldBegin
Shape "disk" "float radius" 20
Translate 0 0 2
AreaLightSource "diffuse" "rgb L" [ 5 5 5 ] "bool twosided" true
)") + shape + " \"float alpha\" 0.25\n";
    RenderOverrides overrides;
    overrides.values["direct-photons"] = true;
    overrides.integrator = "sppm";
    EXPECT_GT(RenderText(text, 64, overrides).outcome.photons->guideComponents, 0u);
    const Replicas photons = RenderReplicas(text, "sppm", 16, 64, overrides);
    const Agreement result = CompareReplicas(photons, RenderReplicas(text, "path", 16, 64, {}), 24, 0.02);
    EXPECT_TRUE(result.Agrees()) << shape << ": off by " << result.bias;
    EXPECT_LT(result.biasError, 0.02);
  }
}

// One of fifty lamps makes the caustic that is seen in the mirror.
TEST(PhotonGuiding, FiftyLampsDoNotStarveTheOneThatMatters) {
  std::string text = R"(LookAt 0 3.5 -5  0 0.3 0.6  0 1 0
Camera "perspective" "float fov" 20
Film "rgb" "integer xresolution" 64 "integer yresolution" 36
Integrator "vcm" "integer maxdepth" 8
WorldBegin
Material "diffuse" "rgb reflectance" [0.5 0.5 0.5]
Shape "bilinearmesh" "point3 P" [-20 0 -20  20 0 -20  -20 0 20  20 0 20]
Material "conductor" "rgb reflectance" [0.9 0.9 0.9]
Shape "bilinearmesh" "point3 P" [-2 0 3  2 0 3  -2 2.5 3  2 2.5 3]
Material "dielectric" "float eta" 1.5
AttributeBegin Translate 0.2 0.45 1.2 Shape "sphere" "float radius" 0.4 AttributeEnd
)";
  for (int i = 0; i < 50; ++i) {
    const double angle = 0.7 * i, distance = i == 0 ? 0.0 : 7 + 0.25 * i;
    text += "LightSource \"point\" \"rgb I\" [2 1.8 1.6] \"point3 from\" [" +
            std::to_string(0.5 + distance * std::cos(angle)) + " 3 " +
            std::to_string(1.5 + distance * std::sin(angle)) + "]\n";
  }
  const Image reference = RenderText(text, 768, Small("vcm", true, 99, 128)).image;
  EXPECT_GT(GainOf(text, "sppm", reference), 2);
}

}  // namespace
}  // namespace lampyr::test
