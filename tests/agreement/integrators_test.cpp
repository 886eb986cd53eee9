// Path tracing and light tracing find the same light in opposite directions and share little but the scene;
// bidirectional path tracing does it in all ways in between. Where all can see it, they agree.
#include <gtest/gtest.h>

#include <regex>

#include "agreement/agreement_scenes.h"
#include "agreement/media_scenes.h"
#include "lights/light_type.h"
#include "support/replicas.h"

namespace lampyr::test {
namespace {

constexpr int kReplicas = 16;

class Integrators : public testing::TestWithParam<AgreementScene> {};

void ExpectAgreement(const char* what, const AgreementScene& scene, const Replicas& other, const Replicas& path,
                     double rate) {
  const Agreement result = CompareReplicas(other, path, scene.blockSize, rate);
  std::printf("%-5s %-20s %3d blocks, largest |z| %.2f (threshold %.2f), chi2 %.1f (%.1f), bias %+.3f %% +- %.3f %%\n",
              what, scene.name, result.blocks, result.largestZ, result.thresholdZ, result.chiSquared,
              result.chiSquaredThreshold, 100 * result.bias, 196 * result.biasError);
  EXPECT_LE(result.largestZ, result.thresholdZ) << what;
  EXPECT_LE(result.chiSquared, result.chiSquaredThreshold) << what;
  EXPECT_LE(std::abs(result.meanZ), result.meanThreshold) << what;
  EXPECT_EQ(path.faults + other.faults, 0u) << what;
  // The test must detect a picture that is 2 % too bright or too dark.
  EXPECT_FALSE(CompareReplicas(other, path, scene.blockSize, rate, 1.02).Agrees()) << what << ": too noisy";
  EXPECT_FALSE(CompareReplicas(other, path, scene.blockSize, rate, 0.98).Agrees()) << what << ": too noisy";
}

TEST_P(Integrators, Agree) {
  const AgreementScene& scene = GetParam();
  RenderOverrides overrides;
  if (scene.crop) overrides.crop = scene.crop;
  const Replicas path = RenderReplicas(scene.text, "path", kReplicas, scene.samples, overrides);
  static const int count = 2 * static_cast<int>(AgreementScenes().size());
  const double rate = SidakRate(1e-3, count);
  overrides.seed = 1000;
  ExpectAgreement("light", scene, RenderReplicas(scene.text, "light", kReplicas, scene.lightSamples, overrides), path,
                  rate);
  overrides.seed = 2000;
  ExpectAgreement("bdpt", scene, RenderReplicas(scene.text, "bdpt", kReplicas, scene.samples / 2, overrides), path,
                  rate);
}

INSTANTIATE_TEST_SUITE_P(Scenes, Integrators, testing::ValuesIn(AgreementScenes()),
                         [](const auto& info) { return std::string(info.param.name); });

class InMedia : public testing::TestWithParam<MediaScene> {};

// Against bdpt, the least noisy. Notices a difference of 1 to 3 % in the whole image, and of some 5 % in a block;
// MediaAnalytic in tests/integrators has the known answers to 0.2 %.
TEST_P(InMedia, IntegratorsAgree) {
  constexpr int kMediaReplicas = 10;
  const MediaScene& scene = GetParam();
  RenderOverrides overrides;
  const int samples = scene.samples / 4, lightSamples = scene.lightSamples * 3 / 8;
  const Replicas bdpt = RenderReplicas(scene.text, "bdpt", kMediaReplicas, samples, overrides);
  const double rate = SidakRate(1e-3, 5 * static_cast<int>(MediaScenes().size()));
  for (const char* integrator : {"path", "light", "vcm", "sppm", "auto"}) {
    const bool isLight = std::string(integrator) == "light", isPath = std::string(integrator) == "path";
    if (isLight && (!scene.lightTracerSeesAll || scene.isCameraInMedium)) continue;
    overrides.seed += 1000;
    overrides.values.clear();
    // Merging blurs: a small radius keeps the bias below the noise.
    if (!isLight && !isPath) overrides.values["radius"] = 0.01;
    // All light that is scattered twice is merged, and one photon for each pixel would be too few.
    if (std::string(integrator) == "sppm") overrides.values["radius"] = 0.02, overrides.values["photons"] = 8000;
    const bool isSppm = std::string(integrator) == "sppm";
    const int own = isLight ? lightSamples : isPath ? scene.pathFactor * samples : isSppm ? 2 * samples : samples;
    const Replicas other = RenderReplicas(scene.text, integrator, kMediaReplicas, own, overrides);
    const Agreement result = CompareReplicas(other, bdpt, scene.blockSize, rate);
    std::printf("%-5s %-20s largest |z| %.2f (%.2f), chi2 %.1f (%.1f), bias %+.3f %% +- %.3f %%\n", integrator,
                scene.name, result.largestZ, result.thresholdZ, result.chiSquared, result.chiSquaredThreshold,
                100 * result.bias, 196 * result.biasError);
    EXPECT_TRUE(result.Agrees()) << integrator;
    EXPECT_LT(result.biasError, 0.01) << integrator << ": too noisy";
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, InMedia, testing::ValuesIn(MediaScenes()),
                         [](const auto& info) { return std::string(info.param.name); });

// Strands turn their normals to the path that arrives: lamps are selected alike for paths from the camera and from
// them.
TEST(Strands, AreLitAlikeByPathsFromBothEnds) {
  std::string text = FilmWith("box", 16, 16) + "LookAt 0 0 8  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 12\n" +
                     World(1) +
                     "LightSource \"spot\" \"rgb I\" [100 100 100] \"point3 from\" [6 0 2] \"point3 to\" [0 0 0] "
                     "\"float coneangle\" 12 "
                     "\"float conedeltaangle\" 1\n"
                     "LightSource \"spot\" \"rgb I\" [100 100 100] \"point3 from\" [0.2 0.2 9] \"point3 to\" [0 0 0] "
                     "\"float coneangle\" 9 "
                     "\"float conedeltaangle\" 1\n"
                     "Material \"hair\" \"float beta_m\" 0.6 \"float beta_n\" 0.6 \"rgb reflectance\" [0.9 0.9 0.9] "
                     "\"float alpha\" 0\n";
  for (int i = -3; i <= 3; ++i) {
    const std::string x = std::to_string(0.25 * i);
    text += "Shape \"curve\" \"string type\" \"flat\" \"float width\" 0.04 \"point3 P\" [";
    for (const char* y : {"-1", "-0.3", "0.3", "1"}) text += x + " " + y + " 0 ";
    text += "]\n";
  }
  RenderOverrides overrides;
  const Replicas path = RenderReplicas(text, "path", 12, 256, overrides);
  for (const char* integrator : {"bdpt", "vcm"}) {
    overrides.seed += 1000;
    const Agreement result = CompareReplicas(RenderReplicas(text, integrator, 12, 256, overrides), path, 16, 1e-3);
    std::printf("%s: bias %+.3f %% +- %.3f %%\n", integrator, 100 * result.bias, 196 * result.biasError);
    EXPECT_LT(std::abs(result.bias), 4 * result.biasError) << integrator;
    EXPECT_LT(result.biasError, 0.008) << integrator << ": too noisy";
  }
}

// No photon is merged on hair: without connections, lamps of which no path hits anything are looked for there.
TEST(Strands, AreLitWhereNothingIsConnectedNorMerged) {
  const std::string text = FilmWith("box", 12, 12) +
                           "LookAt 0 0 -3  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 45\n" + World(3) +
                           "LightSource \"point\" \"rgb I\" [8 8 8] \"point3 from\" [1 1 -2]\n"
                           "LightSource \"distant\" \"rgb L\" [1 1 1] \"point3 from\" [-1 2 -1]\n"
                           "AttributeBegin Material \"hair\" \"rgb sigma_a\" [0.2 0.2 0.2]\n"
                           "Translate 0.4 0.3 0 Shape \"sphere\" \"float radius\" 0.4 AttributeEnd\n"
                           "AttributeBegin Material \"diffuse\" Translate 0 -1 0 Shape \"bilinearmesh\" \"point3 P\" "
                           "[-3 0 -3  3 0 -3  -3 0 3  3 0 3] AttributeEnd\n";
  RenderOverrides overrides;
  const Replicas path = RenderReplicas(text, "path", 12, 128, overrides);
  overrides.seed = 1000;
  overrides.values["connect"] = false;
  overrides.values["radius"] = 0.1;
  const Agreement result = CompareReplicas(RenderReplicas(text, "vcm", 12, 1280, overrides), path, 6, 1e-3);
  std::printf("vcm without connections: bias %+.3f %% +- %.3f %%\n", 100 * result.bias, 196 * result.biasError);
  EXPECT_TRUE(result.Agrees()) << "largest z " << result.largestZ;
  EXPECT_LT(result.biasError, 0.01) << "too noisy";
}

TEST(LightPathScenes, EveryTypeOfLightIsInOne) {
  const std::vector<AgreementScene> scenes = AgreementScenes();
  for (const LightType& type : LightRegistry()) {
    const std::regex statement(std::string("(^|\\s)") + (type.isAreaLight ? "AreaLightSource" : "LightSource") +
                               "\\s+\"" + type.name + "\"");
    EXPECT_TRUE(std::any_of(scenes.begin(), scenes.end(),
                            [&](const AgreementScene& scene) { return std::regex_search(scene.text, statement); }))
        << type.name << " has no scene in which path tracing and light tracing are compared: add one";
  }
}

// A light that sends out no paths is no part of what light tracing shows, though it is there for everyone else.
TEST(LightPath, LightsThatTraceNoPathsAreLeftOut) {
  const std::string head = FilmWith("box") + kDown + World(3);
  const std::string lamp = Square("\"rgb L\" [5 5 5] \"bool traceLightPaths\" false", 0.4);
  const std::string dark = Square("\"rgb L\" [0 0 0]", 0.4);
  const std::string bulb = "LightSource \"point\" \"rgb I\" [5 4 3] \"point3 from\" [0.8 1.2 0.4]\n";
  const Replicas path = RenderReplicas(head + bulb + dark + kThings, "path", kReplicas, 64);
  const Replicas light = RenderReplicas(head + bulb + lamp + kThings, "light", kReplicas, 128);
  EXPECT_TRUE(CompareReplicas(light, path, 8, 1e-3).Agrees());
  const Replicas all = RenderReplicas(head + bulb + lamp + kThings, "path", kReplicas, 64);
  EXPECT_FALSE(CompareReplicas(light, all, 8, 1e-3).Agrees());
}

}  // namespace
}  // namespace lampyr::test
