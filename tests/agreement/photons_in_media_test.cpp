// sppm gathers photons in media: light that camera paths cannot find there, and none twice or not at all, whatever the
// phase function, the group of the light, its links, and where its photons are aimed.
#include <gtest/gtest.h>

#include "agreement/agreement_scenes.h"
#include "support/replicas.h"

namespace lampyr::test {
namespace {

constexpr int kReplicas = 10;
constexpr int kComparisons = 12;  // of this file, for the family-wise rate

std::string Homogeneous(const std::string& name, const std::string& scattering, const std::string& absorption,
                        double g) {
  return "MakeNamedMedium \"" + name + "\" \"string type\" \"homogeneous\" \"rgb sigma_s\" [" + scattering +
         "] \"rgb sigma_a\" [" + absorption + "] \"float g\" " + std::to_string(g) + "\n";
}

RenderOverrides OfRadius(double radius, uint64_t seed = 5000) {
  RenderOverrides overrides;
  overrides.seed = seed;
  overrides.values["radius"] = radius;
  return overrides;
}

Agreement Compare(const std::string& what, const Replicas& tested, const Replicas& reference, int blockSize = 8) {
  const Agreement result = CompareReplicas(tested, reference, blockSize, SidakRate(1e-3, kComparisons));
  std::printf("%-24s %3d blocks, largest |z| %.2f (threshold %.2f), chi2 %.1f (%.1f), bias %+.3f %% +- %.3f %%\n",
              what.c_str(), result.blocks, result.largestZ, result.thresholdZ, result.chiSquared,
              result.chiSquaredThreshold, 100 * result.bias, 196 * result.biasError);
  EXPECT_EQ(tested.faults + reference.faults, 0u) << what;
  return result;
}

void ExpectAgreement(const std::string& what, const Replicas& tested, const Replicas& reference) {
  const Agreement result = Compare(what, tested, reference);
  EXPECT_TRUE(result.Agrees()) << what;
  EXPECT_LT(result.biasError, 0.01) << what << ": too noisy";
}

// A spotlight through a ball of smooth glass into thin fog: its focus is a needle of light that hangs in the air.
// Neither next-event estimation nor a camera path comes to the light through the glass.
const std::string kNeedle =
    FilmWith("box", 32, 32) + Homogeneous("fog", "0.12 0.12 0.12", "0.02 0.02 0.02", 0.3) +
    "LookAt 0 0 4  0 -0.2 0  0 1 0\nMediumInterface \"\" \"fog\"\nCamera \"perspective\" "
    "\"float fov\" 40\n" +
    World(5) +
    "LightSource \"spot\" \"rgb I\" [8 7 6] \"point3 from\" [-1.2 1.2 0] \"point3 to\" "
    "[-0.3 0.2 0] \"float coneangle\" 22\n"
    "AttributeBegin MediumInterface \"\" \"fog\" Material \"dielectric\" \"float eta\" 1.5 "
    "Translate -0.3 0.2 0 Shape \"sphere\" \"float radius\" 0.35 AttributeEnd\n"
    "MediumInterface \"fog\" Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5] Shape \"trianglemesh\" \"point3 "
    "P\" [-4 -1.2 -4  4 -1.2 -4  4 -1.2 4  -4 -1.2 4] \"integer indices\" [0 1 2 0 2 3]\n";

TEST(PhotonsInMedia, FocusOfAGlassBallInFog) {
  const Replicas vcm = RenderReplicas(kNeedle, "vcm", kReplicas, 128, OfRadius(0.02));
  const Replicas sppm = RenderReplicas(kNeedle, "sppm", kReplicas, 192, OfRadius(0.02, 6000));
  ExpectAgreement("needle, sppm and vcm", sppm, vcm);
  RenderOverrides overrides;
  overrides.seed = 7000;
  const Agreement path =
      Compare("needle, path and vcm", RenderReplicas(kNeedle, "path", kReplicas, 128, overrides), vcm);
  EXPECT_FALSE(path.Agrees());
  EXPECT_LT(path.bias, -0.05) << "path tracing finds what it cannot";
}

// A room full of fog with a lamp and a point of light.
std::string FoggyRoom(double g, const std::string& lights, int depth = 4) {
  return FilmWith("box", 24, 24) + "LookAt 0 0 0.9  0 -0.2 -1  0 1 0\n" +
         Homogeneous("fog", "0.5 0.5 0.5", "0.1 0.1 0.1", g) +
         "MediumInterface \"\" \"fog\"\nCamera \"perspective\" \"float fov\" 80\n" + World(depth) + kRoom + lights;
}
std::string Bulb(const std::string& radiance, const std::string& place, const std::string& group = "") {
  return "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [" + radiance + "] " +
         (group.empty() ? "" : "\"string lightGroup\" \"" + group + "\" ") + "Translate " + place +
         " Shape \"sphere\" \"float radius\" 0.15 AttributeEnd\n";
}

// The threshold of narrow lobes, 4 / sr, is within these phase functions, or all of them is below.
class Narrowness : public testing::TestWithParam<double> {};

TEST_P(Narrowness, DirectionsAreFollowedOrGathered) {
  const std::string text = FoggyRoom(GetParam(), Bulb("6 5 4", "0.3 0.6 -0.3"));
  const Replicas bdpt = RenderReplicas(text, "bdpt", kReplicas, 64);
  const std::string name = "g " + std::to_string(GetParam());
  RenderOverrides overrides = OfRadius(0.02);
  overrides.values["photons"] = 4000;
  ExpectAgreement(name + ", sppm", RenderReplicas(text, "sppm", kReplicas, 96, overrides), bdpt);
  overrides.values["direct-photons"] = true;
  ExpectAgreement(name + ", direct photons", RenderReplicas(text, "sppm", kReplicas, 96, overrides), bdpt);
}

INSTANTIATE_TEST_SUITE_P(Phases, Narrowness, testing::Values(0.0, 0.85, -0.92),
                         [](const auto& info) { return "Asymmetry" + std::to_string(info.index); });

// Each layer is the light of its group alone, in fog as well.
TEST(PhotonsInMedia, AreInTheLayersOfTheirLights) {
  const std::string text =
      FoggyRoom(0.3, Bulb("6 5 4", "0.4 0.6 -0.3", "warm") + Bulb("2 3 6", "-0.5 -0.5 -0.4", "cool"));
  const Replicas bdpt = RenderReplicas(text, "bdpt", kReplicas, 64);
  const Replicas sppm = RenderReplicas(text, "sppm", kReplicas, 96, OfRadius(0.02));
  for (const char* layer : {"warm.G", "cool.G"}) {
    const int channel = bdpt.images[0].ChannelIndex(layer);
    ASSERT_GE(channel, 0) << layer;
    const auto momentsOf = [&](const Replicas& replicas) {
      return replicas_internal::MomentsOf(
          replicas_internal::Means(replicas, static_cast<size_t>(channel), 0, 0, 24, 24));
    };
    const auto a = momentsOf(sppm), b = momentsOf(bdpt);
    std::printf("%s: %.4f and %.4f\n", layer, a.mean, b.mean);
    EXPECT_LT(std::abs(replicas_internal::Deviate(a, b, kReplicas)), 4) << layer;
    EXPECT_LT(std::sqrt(a.variance + b.variance), 0.01 * b.mean) << "too noisy to say anything";
  }
}

// Surfaces that a light does not shine on send none of its light into the fog, and filters act on what photons bring.
TEST(PhotonsInMedia, ObeyLinksAndFilters) {
  const std::string head = FilmWith("box", 24, 24) + "LookAt 0 0 0.9  0 -0.2 -1  0 1 0\n" +
                           Homogeneous("fog", "0.5 0.5 0.5", "0.1 0.1 0.1", 0.3) +
                           "MediumInterface \"\" \"fog\"\nCamera \"perspective\" \"float fov\" 80\n" + World(4);
  const std::string lights =
      "LightSource \"point\" \"rgb I\" [2 1 0.5] \"point3 from\" [-0.4 0.5 0] \"string name\" \"bulb\"\n"
      "AttributeBegin LightFilter \"intmult\" \"float intensity\" 3 LightSource \"point\" \"rgb I\" [0.1 0.2 0.4] "
      "\"point3 from\" [0.5 -0.4 -0.2] AttributeEnd\n";
  const std::string dark = head + lights + "Attribute \"lighting\" \"string excludesubset\" [ \"bulb\" ]\n" + kRoom;
  const Replicas bdpt = RenderReplicas(dark, "bdpt", kReplicas, 64);
  ExpectAgreement("links and filters", RenderReplicas(dark, "sppm", kReplicas, 128, OfRadius(0.01)), bdpt);
  const Replicas lit = RenderReplicas(head + lights + kRoom, "sppm", 2, 32, OfRadius(0.01));
  EXPECT_GT(replicas_internal::MomentsOf(replicas_internal::Means(lit, 0, 0, 0, 24, 24)).mean,
            1.2 * replicas_internal::MomentsOf(replicas_internal::Means(bdpt, 0, 0, 0, 24, 24)).mean);
}

// A ball of mist over a small part of a wide ground in the sun: photons are aimed at it, and the picture is the same.
TEST(PhotonsInMedia, MayBeGuided) {
  const std::string text =
      FilmWith("box", 24, 24) + "LookAt 0 2.6 1.4  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 24\n" + World(4) +
      Homogeneous("mist", "2 2 2", "0.1 0.1 0.1", 0.2) +
      "LightSource \"distant\" \"rgb L\" [3 3 2.5] \"point3 from\" [1 2 0.5] \"point3 to\" [0 0 0]\n"
      "AttributeBegin Material \"interface\" MediumInterface \"mist\" \"\" Translate 0 0.7 0 Shape \"sphere\" \"float "
      "radius\" 0.4 AttributeEnd\n"
      "Material \"diffuse\" \"rgb reflectance\" [0.7 0.6 0.5] Shape \"bilinearmesh\" \"point3 P\" [-12 0 -12  -12 0 12 "
      " 12 0 -12  12 0 12]\n";
  const Replicas path = RenderReplicas(text, "path", kReplicas, 128);
  RenderOverrides overrides = OfRadius(0.02);
  overrides.values["photons"] = 16000;
  overrides.integrator = "sppm";
  EXPECT_GT(RenderText(text, 8, overrides).outcome.photons->guideComponents, 0);
  ExpectAgreement("guided", RenderReplicas(text, "sppm", kReplicas, 48, overrides), path);
}

// Milk whose mean free path is a tenth of the photons' radius: camera paths find its light, unblurred.
TEST(PhotonsInMedia, AreNotGatheredInDenseMedia) {
  const std::string text = FilmWith("box", 24, 24) +
                           "LookAt 0 0 3  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 30\n" + World(12) +
                           Homogeneous("milk", "100 100 100", "2 5 20", 0.2) +
                           "LightSource \"distant\" \"rgb L\" [3 3 3] \"point3 from\" [1 1 1] \"point3 to\" [0 0 0]\n"
                           "AttributeBegin Material \"interface\" MediumInterface \"milk\" \"\" Shape \"sphere\" "
                           "\"float radius\" 0.6 AttributeEnd\n";
  const Replicas path = RenderReplicas(text, "path", kReplicas, 48);
  ExpectAgreement("dense", RenderReplicas(text, "sppm", kReplicas, 48, OfRadius(0.1)), path);
  RenderOverrides overrides = OfRadius(0.1);
  overrides.integrator = "sppm";
  EXPECT_EQ(RenderText(text, 2, overrides).outcome.photons->photons, 0u) << "photons are stored that nobody gathers";
}

}  // namespace
}  // namespace lampyr::test
