// Light that participating media emit: light tracing and photon mapping, whose paths start in the media, against path
// tracing, which gathers the emission along camera rays.
#include <gtest/gtest.h>

#include "agreement/agreement_scenes.h"
#include "support/replicas.h"

namespace lampyr::test {
namespace {

constexpr int kReplicas = 8;

const std::string kView = "LookAt 0 0 0.9  0 -0.2 -1  0 1 0\nCamera \"perspective\" \"float fov\" 80\n";
const std::string kBall =
    "AttributeBegin Material \"interface\" MediumInterface \"fire\" \"\" Translate 0.1 -0.3 -0.3 Shape \"sphere\" "
    "\"float radius\" 0.4 AttributeEnd\n";
const std::string kLamp =
    "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [1 1 3] Translate -0.5 0.6 -0.3 Shape \"sphere\" \"float "
    "radius\" 0.15 AttributeEnd\n";
const std::string kMetal =
    "AttributeBegin Material \"conductor\" \"rgb reflectance\" [0.8 0.8 0.8] \"float roughness\" 0.3 Translate -0.6 "
    "-0.7 -0.2 Shape \"sphere\" \"float radius\" 0.25 AttributeEnd\n";

// Behind the ball.
const std::string kWall =
    "Material \"diffuse\" \"rgb reflectance\" [0.6 0.6 0.5] Shape \"trianglemesh\" \"point3 P\" [-3 -3 -1  3 -3 -1  3 "
    "3 "
    "-1  -3 3 -1] \"integer indices\" [0 1 2 0 2 3]\n";

std::string Homogeneous(const std::string& name, const std::string& coefficients) {
  return "MakeNamedMedium \"" + name + "\" \"string type\" \"homogeneous\" " + coefficients + "\n";
}

// A grid in a box whose boundary cuts a part of it off.
const std::string kGrid = R"(AttributeBegin Translate 0 -0.3 -0.3 Rotate 30 1 2 3 Translate -0.4 -0.4 -0.4
MakeNamedMedium "fire" "string type" "uniformgrid" "integer nx" 3 "integer ny" 2 "integer nz" 2
"float density" [0 1 2  5 0 0  0 0 0.5  1 0 3] "float Lescale" [1 0 3  1 1 1  2 2 0  1 4 1] "point3 p1" [0.8 0.8 0.8]
"rgb Le" [2 1.2 0.4] "rgb sigma_a" [0.5 1 1.5] "rgb sigma_s" [2 2 1] "float g" 0.4
AttributeEnd
)";

std::vector<AgreementScene> GlowingScenes() {
  const std::string room = FilmWith("box") + kView + World(4) + kRoom;
  std::vector<AgreementScene> scenes;
  scenes.push_back(
      {"ball", room + Homogeneous("fire", "\"rgb sigma_s\" [1 1 1] \"rgb sigma_a\" [2 2 2] \"rgb Le\" [1 0.6 0.3]") +
                   kBall + kMetal});
  scenes.push_back({"grid_and_lamp", room + kGrid + kBall + kMetal + kLamp});
  // A clear glow that does not scatter, in a thin fog that does not glow, beside a point light.
  scenes.push_back(
      {"clear_flame", FilmWith("gaussian") + kView + World(3) +
                          Homogeneous("fire", "\"rgb sigma_s\" [0 0 0] \"rgb sigma_a\" [0.5 1 2] \"rgb Le\" [3 2 1]") +
                          Homogeneous("haze", "\"rgb sigma_s\" [2 2 2] \"rgb sigma_a\" [0.1 0.1 0.1]") + kRoom + kBall +
                          "AttributeBegin Material \"interface\" MediumInterface \"haze\" \"\" Translate -0.5 0.4 -0.5 "
                          "Shape \"sphere\" \"float radius\" 0.35 AttributeEnd\n"
                          "LightSource \"point\" \"rgb I\" [0.2 0.2 0.4] \"point3 from\" [0.4 0.7 0.3]\n"});
  // Seen through a pane of coloured glass, in which nothing is mirrored towards the camera.
  scenes.push_back(
      {"behind_coloured_glass",
       FilmWith("box") + kView + World(3) +
           Homogeneous("fire", "\"rgb sigma_s\" [0.5 0.5 0.5] \"rgb sigma_a\" [0.5 1 2] \"rgb Le\" [3 2 1]") + kWall +
           kBall +
           "Material \"thindielectric\" \"rgb transmittance\" [0.9 0.2 0.5] Shape \"trianglemesh\" \"point3 P\" [-0.9 "
           "-0.9 0.4  0.9 -0.9 0.4  0.9 0.9 0.4  -0.9 0.9 0.4] \"integer indices\" [0 1 2 0 2 3]\n"});
  return scenes;
}

void ExpectAgreement(const std::string& what, const Replicas& other, const Replicas& path) {
  const Agreement result = CompareReplicas(other, path, 8, 1e-4);
  std::printf("%-20s %3d blocks, largest |z| %.2f (threshold %.2f), chi2 %.1f (%.1f), bias %+.3f %% +- %.3f %%\n",
              what.c_str(), result.blocks, result.largestZ, result.thresholdZ, result.chiSquared,
              result.chiSquaredThreshold, 100 * result.bias, 196 * result.biasError);
  EXPECT_TRUE(result.Agrees()) << what;
  EXPECT_EQ(path.faults + other.faults, 0u) << what;
  EXPECT_FALSE(CompareReplicas(other, path, 8, 1e-4, 1.03).Agrees()) << what << ": too noisy";
  EXPECT_FALSE(CompareReplicas(other, path, 8, 1e-4, 0.97).Agrees()) << what << ": too noisy";
}

class GlowingMediaScenes : public testing::TestWithParam<AgreementScene> {};

TEST_P(GlowingMediaScenes, AreTheSameFromBothEnds) {
  const AgreementScene& scene = GetParam();
  const Replicas path = RenderReplicas(scene.text, "path", kReplicas, 64);
  RenderOverrides overrides;
  overrides.seed = 1000;
  ExpectAgreement("light", RenderReplicas(scene.text, "light", kReplicas, 64, overrides), path);
  overrides.values["radius"] = 0.01;
  overrides.seed = 2000;
  ExpectAgreement("sppm", RenderReplicas(scene.text, "sppm", kReplicas, 128, overrides), path);
  overrides.seed = 3000;
  overrides.values["radius"] = 0.02;
  overrides.values["direct-photons"] = true;
  ExpectAgreement("sppm, direct photons", RenderReplicas(scene.text, "sppm", kReplicas, 192, overrides), path);
}

INSTANTIATE_TEST_SUITE_P(Media, GlowingMediaScenes, testing::ValuesIn(GlowingScenes()),
                         [](const auto& info) { return std::string(info.param.name); });

// A sheet that stops light bounds no medium, whatever its sides say.
TEST(GlowingMedia, AreNotBoundedByOpaqueSheets) {
  const std::string scene =
      FilmWith("box") + "LookAt 0 0 -2  0 0 0  0 1 0\n" +
      Homogeneous("fire", "\"rgb sigma_s\" [0 0 0] \"rgb sigma_a\" [0.1 0.1 0.1] \"rgb Le\" [1 1 1]") +
      "MediumInterface \"\" \"fire\"\nCamera \"perspective\" \"float fov\" 50\n" + World(2) +
      "Material \"diffuse\" \"rgb reflectance\" [0.8 0.8 0.8] Shape \"bilinearmesh\" \"point3 P\" [-2 -2 1  2 -2 1  -2 "
      "2 1  "
      "2 2 1]\nShape \"bilinearmesh\" \"point3 P\" [-2 -2 -1  -2 2 -1  -2 -2 1  -2 2 1]\n";
  const Replicas path = RenderReplicas(scene, "path", kReplicas, 64);
  RenderOverrides overrides;
  overrides.seed = 1000;
  overrides.values["radius"] = 0.02;
  const Agreement sppm = CompareReplicas(RenderReplicas(scene, "sppm", kReplicas, 64, overrides), path, 32, 1e-4);
  EXPECT_LT(std::abs(sppm.bias), 4 * sppm.biasError);
  EXPECT_LT(sppm.biasError, 0.004);
  // The camera is in the medium, so that light tracing is noisy.
  overrides.values.clear();
  const Agreement light = CompareReplicas(RenderReplicas(scene, "light", kReplicas, 64, overrides), path, 32, 1e-4);
  EXPECT_LT(std::abs(light.bias), 4 * light.biasError);
  EXPECT_LT(light.biasError, 0.04);
  std::printf("bias %+.3f %% +- %.3f %%, light %+.3f %% +- %.3f %%\n", 100 * sppm.bias, 100 * sppm.biasError,
              100 * light.bias, 100 * light.biasError);
}

// The glow is in the layer of what is in no light group, and the lamp's light in its own.
TEST(GlowingMedia, IsInNoLightGroup) {
  const std::string lamp = "AttributeBegin AreaLightSource \"diffuse\" \"string lightGroup\" \"lamp\"";
  const std::string scene = FilmWith("box", 24, 24) + kView + World(3) + kRoom + kGrid + kBall + lamp +
                            kLamp.substr(kLamp.find(" \"rgb L\""));
  const Replicas path = RenderReplicas(scene, "path", kReplicas, 64);
  for (const char* integrator : {"light", "sppm"}) {
    RenderOverrides overrides;
    overrides.seed = 1000;
    overrides.values["radius"] = 0.02;
    const Replicas other = RenderReplicas(scene, integrator, kReplicas, 128, overrides);
    for (const char* layer : {"rest.G", "lamp.G"}) {
      const int channel = path.images[0].ChannelIndex(layer);
      ASSERT_GE(channel, 0) << layer;
      const auto momentsOf = [&](const Replicas& replicas) {
        return replicas_internal::MomentsOf(
            replicas_internal::Means(replicas, static_cast<size_t>(channel), 0, 0, 24, 24));
      };
      const auto a = momentsOf(other), b = momentsOf(path);
      std::printf("%s %s: %.4f and %.4f\n", integrator, layer, a.mean, b.mean);
      EXPECT_LT(std::abs(replicas_internal::Deviate(a, b, kReplicas)), 4) << integrator << " " << layer;
      EXPECT_LT(std::sqrt(a.variance + b.variance), 0.02 * b.mean) << "too noisy to say anything";
    }
  }
}

// In an enclosure of radiance 1, filled with a medium of the same radiance, all is of radiance 1.
TEST(GlowingMedia, FurnaceOfPhotonMapping) {
  const std::string scene = FilmWith("box", 24, 24) + kView + World(40) +
                            Homogeneous("hot",
                                        "\"rgb sigma_s\" [0.3 0.6 0] \"rgb sigma_a\" [0.4 0.2 0.7] \"rgb Le\" "
                                        "[1 1 1]") +
                            "AttributeBegin Material \"interface\" MediumInterface \"hot\" \"\" Translate 0 0 -0.4 "
                            "Shape \"sphere\" \"float radius\" 0.5 AttributeEnd\n"
                            "AreaLightSource \"diffuse\" \"rgb L\" [0.6 0.6 0.6] \"bool twosided\" true\n"
                            "Material \"diffuse\" \"rgb reflectance\" [0.4 0.4 0.4]\n" +
                            kRoom.substr(kRoom.find("Shape"));
  RenderOverrides overrides;
  overrides.values["radius"] = 0.02;
  const Replicas sppm = RenderReplicas(scene, "sppm", kReplicas, 288, overrides);
  EXPECT_EQ(sppm.faults, 0u);
  for (size_t c = 0; c < 3; ++c) {
    const auto moments = replicas_internal::MomentsOf(replicas_internal::Means(sppm, c, 0, 0, 24, 24));
    const double error = std::sqrt(moments.variance);
    std::printf("furnace: %.5f +- %.5f\n", moments.mean, error);
    EXPECT_LT(error, 0.003) << "too noisy to say anything";
    EXPECT_LT(std::abs(moments.mean - 1), 5 * error) << c;
  }
}

}  // namespace
}  // namespace lampyr::test
