// Each decision of the plan, switched by hand: the same picture within noise.
#include <gtest/gtest.h>

#include <cstdio>
#include <functional>
#include <string>
#include <vector>

#include "render/analysis/plan.h"
#include "support/replicas.h"

namespace lampyr::test {
namespace {

constexpr const char* kHead = R"(Film "rgb" "integer xresolution" 32 "integer yresolution" 24
PixelFilter "box"
)";
constexpr const char* kCamera = R"(LookAt 0 1 -3  0 0.8 0  0 1 0
Camera "perspective" "float fov" 40
)";
constexpr const char* kThings = R"(WorldBegin
Material "diffuse" "rgb reflectance" [ 0.6 0.5 0.4 ]
Shape "bilinearmesh" "point3 P" [ -1 0 -1  1 0 -1  -1 0 1  1 0 1 ]
Shape "bilinearmesh" "point3 P" [ -1 0 1  1 0 1  -1 2 1  1 2 1 ]
Shape "bilinearmesh" "point3 P" [ 1 0 -1  1 0 1  1 2 -1  1 2 1 ]
AttributeBegin Translate -0.4 0.3 0.2 Shape "sphere" "float radius" 0.3 AttributeEnd
AttributeBegin AreaLightSource "diffuse" "rgb L" [ 8 7 6 ]
Shape "bilinearmesh" "point3 P" [ -0.4 1.9 -0.4  -0.4 1.9 0.4  0.4 1.9 -0.4  0.4 1.9 0.4 ] AttributeEnd
AttributeBegin AreaLightSource "diffuse" "rgb L" [ 3 4 6 ] Translate 0.7 0.6 -0.2 Shape "sphere" "float radius" 0.12 AttributeEnd
LightSource "infinite" "rgb L" [ 0.1 0.1 0.15 ]
)";
// Its caustic is wide enough for paths from the camera, which do not see the glass itself.
constexpr const char* kGlass = R"(AttributeBegin Material "dielectric" "float eta" 1.5
Translate 0.2 2.3 -0.1 Scale 0.8 0.25 0.8 Shape "sphere" "float radius" 0.6 AttributeEnd
)";

struct Switch {
  const char* name;
  std::function<void(RenderOverrides&)> set;
  std::string head = kHead;
  std::string camera = kCamera;
  std::string more = "";
};

const Switch kSwitches[] = {
    {"path", [](RenderOverrides& o) { o.integrator = "path"; }},
    {"bdpt", [](RenderOverrides& o) { o.integrator = "bdpt"; }},
    {"vcm", [](RenderOverrides& o) { o.integrator = "vcm"; }},
    {"no merging", [](RenderOverrides& o) { o.integrator = "vcm", o.values["merge"] = false; }},
    {"no connections", [](RenderOverrides& o) { o.integrator = "vcm", o.values["connect"] = false; }},
    {"no guiding", [](RenderOverrides& o) { o.integrator = "vcm", o.values["guide-photons"] = false; }},
    {"sppm", [](RenderOverrides& o) { o.integrator = "sppm"; }},
    {"photons for direct light",
     [](RenderOverrides& o) { o.integrator = "sppm", o.values["direct-photons"] = true, o.values["photons"] = 4000; }},
    {"uniform selection", [](RenderOverrides& o) { o.values["light-sampler"] = "uniform"; }},
    {"selection by power", [](RenderOverrides& o) { o.values["light-sampler"] = "power"; }},
    {"exhaustive selection", [](RenderOverrides& o) { o.values["light-sampler"] = "exhaustive"; }},
    {"learning", [](RenderOverrides& o) { o.values["learn-always"] = true; }},
    {"several lights", [](RenderOverrides& o) { o.values["light-samples"] = 4; }},
    {"a lens", [](RenderOverrides&) {}, kHead,
     "LookAt 0 1 -3  0 0.8 0  0 1 0\nCamera \"perspective\" \"float fov\" 40 \"float lensradius\" 1e-5 "
     "\"float focaldistance\" 3\n"},
    {"motion", [](RenderOverrides&) {}, kHead, kCamera,
     "AttributeBegin ActiveTransform EndTime Translate 0 0.1 0 ActiveTransform All Translate 9 9 9\n"
     "Shape \"sphere\" \"float radius\" 0.01 AttributeEnd\n"},
};

class PlanSwitches : public testing::TestWithParam<bool> {};

TEST_P(PlanSwitches, ChangeNothingButNoise) {
  const std::string things = std::string(kThings) + (GetParam() ? kGlass : "");
  RenderOverrides planned;
  planned.values["max-depth"] = 6;
  planned.values["radius"] = 0.045;  // of smaller discs some blocks find too few photons to know their noise
  planned.integrator = "auto";
  constexpr int replicas = 8, samples = 64;
  const Replicas base = RenderReplicas(kHead + std::string(kCamera) + things, "auto", replicas, samples, planned);
  const double rate = SidakRate(1e-3, 2 * static_cast<int>(std::size(kSwitches)));
  for (const Switch& one : kSwitches) {
    RenderOverrides overrides = planned;
    overrides.seed = 1000;
    one.set(overrides);
    const std::string integrator = *overrides.integrator;
    const Replicas switched =
        RenderReplicas(one.head + one.camera + things + one.more, integrator, replicas, samples, overrides);
    const Agreement result = CompareReplicas(switched, base, 8, rate);
    std::printf("%-26s largest |z| %.2f (%.2f), chi2 %.1f (%.1f), bias %+.3f %% +- %.3f %%\n", one.name,
                result.largestZ, result.thresholdZ, result.chiSquared, result.chiSquaredThreshold, 100 * result.bias,
                196 * result.biasError);
    EXPECT_TRUE(result.Agrees()) << one.name;
    EXPECT_EQ(switched.faults, 0u) << one.name;
    EXPECT_FALSE(CompareReplicas(switched, base, 8, rate, 1.1).Agrees()) << one.name << ": too noisy";
  }
}

INSTANTIATE_TEST_SUITE_P(Of, PlanSwitches, testing::Bool(),
                         [](const auto& tested) { return tested.param ? "GlassCaustic" : "DiffuseThings"; });

ScenePlan PlanOf(const std::string& text, RenderOverrides overrides = {}) {
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  const BuiltScene built =
      BuildScene(ParseScene(text, std::string(LAMPYR_SOURCE_DIR) + "/scenes/test.pbrt", diagnostics), overrides, true,
                 diagnostics);
  return PlanFor(built.scene, built.settings);
}

std::string ChoiceOf(const ScenePlan& plan, const std::string& subject) {
  for (const PlanDecision& decision : plan.decisions) {
    if (decision.subject == subject) return decision.choice;
  }
  return "";
}

TEST(Plan, IsWhatASceneNeeds) {
  const std::string plain = kHead + std::string(kCamera) + kThings;
  EXPECT_NE(PlanOf(plain + kGlass).integrator, "path");  // bdpt and vcm are nearly equal
  EXPECT_EQ(ChoiceOf(PlanOf(plain), "lens"), "pinhole");
  EXPECT_EQ(ChoiceOf(PlanOf(plain), "motion"), "off");
  EXPECT_EQ(ChoiceOf(PlanOf(plain), "light selection"), "tree");
  EXPECT_EQ(ChoiceOf(PlanOf(plain), "light groups"), "none");
  EXPECT_EQ(ChoiceOf(PlanOf(plain), "layers"), "none");
  std::string layered = plain;
  layered.replace(layered.find("Film \"rgb\""), 10, "Film \"rgb\" \"string layers\" [ \"caustic\" ]");
  EXPECT_EQ(ChoiceOf(PlanOf(layered), "layers"), "1 layer");
  EXPECT_EQ(ChoiceOf(PlanOf(plain + "LightSource \"point\" \"string lightGroup\" \"key\"\n"), "light groups"),
            "2 layers");
  EXPECT_EQ(ChoiceOf(PlanOf(kSwitches[13].head + kSwitches[13].camera + kThings), "lens"), "sampled");
  EXPECT_EQ(ChoiceOf(PlanOf(plain + kSwitches[14].more), "motion"), "on");
  // A lamp behind a screen: only what it lights is seen.
  const std::string screen =
      "Shape \"bilinearmesh\" \"point3 P\" [ -0.6 1.7 -0.6  0.6 1.7 -0.6  -0.6 1.7 0.6  0.6 1.7 0.6 ]\n"
      "Shape \"bilinearmesh\" \"point3 P\" [ -1 2 -1  1 2 -1  -1 2 1  1 2 1 ]\n";
  const std::string lamp =
      "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [ 90 90 90 ] Translate 0 1.9 0 "
      "Shape \"sphere\" \"float radius\" 0.05 AttributeEnd\n";
  const std::string room = kHead + std::string(kCamera) +
                           "WorldBegin\nMaterial \"diffuse\" \"rgb reflectance\" [ 0.6 0.5 0.4 ]\n"
                           "Shape \"bilinearmesh\" \"point3 P\" [ -1 0 -1  1 0 -1  -1 0 1  1 0 1 ]\n";
  std::string unseen = lamp;
  unseen.replace(unseen.find("0 1.9 0"), 7, "0 2.6 0");
  EXPECT_EQ(PlanOf(room + unseen).integrator, "path");
  EXPECT_NE(PlanOf(room + lamp + screen).integrator, "path");  // bdpt and vcm are the same within a few percent
  // A caustic of a point that is seen in a mirror.
  const std::string mirror =
      "AttributeBegin Material \"conductor\" \"float roughness\" 0\n"
      "Shape \"bilinearmesh\" \"point3 P\" [ -1 0 0.9  1 0 0.9  -1 2 0.9  1 2 0.9 ] AttributeEnd\n";
  const std::string point = "LightSource \"point\" \"rgb I\" [ 3 3 3 ] \"point3 from\" [ 0.2 3.2 -0.1 ]\n";
  const std::string ofCaustic = PlanOf(room + point + kGlass + mirror).integrator;
  EXPECT_TRUE(ofCaustic == "vcm" || ofCaustic == "sppm") << ofCaustic;
}

TEST(Plan, DoesNotDependOnThreadsOrTheSeed) {
  const auto pilotOf = [](uint64_t seed, int threads) {
    Diagnostics diagnostics(Diagnostics::Mode::Collect);
    RenderOverrides overrides;
    overrides.seed = seed;
    const BuiltScene built = BuildScene(ParseScene(kHead + std::string(kCamera) + kThings + kGlass,
                                                   std::string(LAMPYR_SOURCE_DIR) + "/scenes/test.pbrt", diagnostics),
                                        overrides, true, diagnostics);
    return RunPilot(built.scene, built.settings, threads);
  };
  const RenderPilot one = pilotOf(0, 1), other = pilotOf(7, 3);
  ASSERT_GE(one.candidates.size(), 13u);
  ASSERT_EQ(one.candidates.size(), other.candidates.size());
  for (size_t i = 0; i < one.candidates.size(); ++i) {
    EXPECT_EQ(one.candidates[i].error, other.candidates[i].error);
    EXPECT_EQ(one.candidates[i].cost, other.candidates[i].cost);
    EXPECT_EQ(one.candidates[i].missing, other.candidates[i].missing);
  }
}

}  // namespace
}  // namespace lampyr::test
