// Light filters and linking act on the edge between a light and what it shines on, whichever technique made the edge:
// all integrators agree, wherever a filter is bound, enabled or turned inside out.
#include <gtest/gtest.h>

#include "agreement/agreement_scenes.h"
#include "lights/filters/filter_type.h"
#include "support/replicas.h"

namespace lampyr::test {
namespace {

constexpr int kReplicas = 12;

struct FilterScene {
  const char* name;
  std::string text;
  int samples = 32;
  bool lightTracingSeesAll = true;
};

void PrintTo(const FilterScene& scene, std::ostream* stream) {
  *stream << scene.name;
}

std::string Filter(const std::string& type, const std::string& parameters) {
  return "LightFilter \"" + type + "\" " + parameters + "\n";
}

// A light that shines down, with what comes before it in its scope.
std::string Lamp(const std::string& place, const std::string& filters, const std::string& light) {
  return "AttributeBegin Translate " + place + " Rotate -90 1 0 0\n" + filters + "LightSource " + light +
         "\nAttributeEnd\n";
}

const std::string kHead = FilmWith("gaussian", 24, 24) + kDown + World(3);
const std::string kImage = "\"string filename\" \"data/wood.png\" ";

std::vector<FilterScene> FilterScenes() {
  std::vector<FilterScene> scenes;
  // Functions of the emitted ray.
  scenes.push_back(
      {"rays",
       kHead +
           Lamp("-0.6 1.6 0",
                Filter("barn",
                       "\"float width\" 0.8 \"float height\" 0.7 \"float edge\" 0.3 \"float left\" 0.2 "
                       "\"float radius\" 0.2 \"float specular\" 0.5"),
                "\"rect\" \"float width\" 0.4 \"float height\" 0.3 \"float intensity\" 14") +
           Lamp("0.7 1.7 0.2",
                Filter("gobo", kImage + "\"float width\" 1.2 \"float height\" 1.4 \"rgb fill\" [0.1 0.1 0.4] "
                                        "\"float blur\" 0.1 \"rgb tint\" [2 1 1]"),
                "\"point\" \"rgb I\" [4 4 4]") +
           Lamp("0 0 0", Filter("intmult", "\"float saturation\" 0.3 \"float exposure\" 0.5 \"rgb tint\" [1 0.5 1]"),
                "\"dome\" \"string texture:file\" \"data/sky-evening.hdr\" \"float intensity\" 0.2") +
           kThings});
  // Functions of what is lit.
  scenes.push_back(
      {"receivers",
       kHead +
           Lamp("-0.6 1.6 0", "Translate 0 0 -1.3 " + Filter("blocker", "\"float radius\" 0.4 \"float edge\" 0.5"),
                "\"point\" \"rgb I\" [4 3 2]") +
           Lamp("0.6 1.5 0.3",
                Filter("ramp",
                       "\"string mode\" \"angle\" \"float end\" 50 \"float knots\" [0 0.5 1] "
                       "\"rgb colors\" [1 0.2 0.2  1 1 0.3  0.2 0.4 1]"),
                "\"disk\" \"float radius\" 0.2 \"float intensity\" 12") +
           "AttributeBegin Translate 0.2 0.3 0 " +
           Filter("rod",
                  "\"float width\" 1.2 \"float depth\" 0.8 \"float right\" 0.4 \"float edge\" 0.3 \"float "
                  "radius\" 0.1 \"rgb color\" [0.3 1.6 0.5] \"bool invert\" true") +
           "AreaLightSource \"diffuse\" \"rgb L\" [5 5 5] Translate -0.2 1.2 -0.5 Shape \"sphere\" \"float "
           "radius\" 0.15 AttributeEnd\n" +
           Lamp("-0.3 1.4 0.9",
                Filter("cookie", kImage + "\"float width\" 0.7 \"float height\" 0.7 \"bool tile\" true"),
                "\"sphere\" \"float radius\" 0.2 \"float intensity\" 6") +
           kThings});
  // Several at once, in all modes, on lights at infinity, on a mesh, and on an instance.
  const std::string parts =
      Filter("ramp", "\"string name\" \"near\" \"float end\" 2.2 \"string combineMode\" \"max\"") +
      Filter("gobo", "\"string name\" \"leaves\" " + kImage + "\"string combineMode\" \"max\" \"bool invert\" true") +
      Filter("barn",
             "\"string name\" \"slot\" \"float width\" 3 \"float height\" 1.5 \"float edge\" 1 \"string combineMode\" "
             "\"screen\" \"float density\" 0.6") +
      Filter("intmult", "\"string name\" \"warm\" \"rgb tint\" [1.3 1 0.6]") +
      Filter("blocker", "\"string name\" \"off\" \"float radius\" 9 \"float density\" 0");
  scenes.push_back(
      {"combined", kHead + "AttributeBegin Translate 0 1.8 0 Rotate -90 1 0 0\n" + parts +
                       Filter("combiner",
                              "\"string name\" \"all\" \"string filters\" [ \"near\" \"leaves\" \"slot\" "
                              "\"warm, off\" ]") +
                       "LightSource \"distant\" \"rgb L\" [2 2 2] \"point3 from\" [0.2 0.1 1] \"point3 to\" [0 0 0]\n" +
                       Filter("combiner", "\"string filters\" [ \"all\" \"leaves\" ] \"string mode\" \"min\"") +
                       "LightSource \"distant\" \"float angle\" 30 \"point3 from\" [-0.2 0.3 1] \"point3 to\" [0 0 0]\n"
                       "AttributeEnd\nObjectBegin \"lamp\" " +
                       Square("\"rgb L\" [6 6 6]", 0.3) + "ObjectEnd\nAttributeBegin Translate 0.6 0.1 -0.3\n" +
                       Filter("ramp", "\"float begin\" 0.4 \"float end\" 1.6") +
                       "LightSource \"infinite\" \"rgb L\" [0.2 0.3 0.5]\nObjectInstance \"lamp\" AttributeEnd\n" +
                       kThings});
  // Groups of filters, and of lights. A surface that is not lit by any light is lit by what others scatter.
  scenes.push_back(
      {"linked",
       kHead +
           Lamp("-0.5 1.6 0.2",
                "Translate 0 0 -1.4 " + Filter("blocker",
                                               "\"float radius\" 0.7 \"float edge\" 0.4 \"string "
                                               "linkingGroups\" \"blockers, others\""),
                "\"rect\" \"float width\" 0.3 \"float height\" 0.3 \"float intensity\" 20 \"string lightGroup\" "
                "\"keys\"") +
           Lamp("0.8 1.4 0.3", "", "\"point\" \"rgb I\" [1 2 4] \"string name\" \"bulb\"") + "AttributeBegin " +
           Square("\"rgb L\" [4 2 1] \"string lightGroup\" \"rims\"", 0.5) +
           "AttributeEnd\nLightSource \"infinite\" \"rgb L\" [0.1 0.1 0.1]\n" + kGround +
           R"(AttributeBegin
Attribute "lightfilter" "string subset" [ "blockers" ]
Attribute "lighting" "string excludesubset" [ "rims" ]
Material "diffuse" "rgb reflectance" [0.3 0.6 0.8]
Translate -0.5 0.35 0 Shape "sphere" "float radius" 0.35
AttributeEnd
AttributeBegin
Attribute "lighting" "string subset" "bulb,keys"
Material "conductor" "rgb reflectance" [0.9 0.8 0.6] "float roughness" 0.4
Translate 0.45 0.3 0.2 Shape "sphere" "float radius" 0.3
Attribute "lighting" "string subset" "rims" "string excludesubset" "rims"
Material "diffuse" "rgb reflectance" [0.7 0.7 0.7]
Translate -0.6 0 0.8 Shape "sphere" "float radius" 0.2
AttributeEnd
)"});
  // Lights found in a mirror, and straight: the mirror's light is filtered, what the camera sees of the lamp is not.
  scenes.push_back(
      {"mirror",
       FilmWith("gaussian", 24, 24) + kSeesLamp + World(4) + "AttributeBegin Translate 0 1.3 0 " +
           Filter("rod", "\"float width\" 9 \"float height\" 9 \"float depth\" 9 \"rgb color\" [0.9 0.5 0.2]") +
           "AreaLightSource \"diffuse\" \"rgb L\" [2 1.6 1.2] Shape \"sphere\" \"float radius\" 0.4 AttributeEnd\n" +
           "AttributeBegin Rotate -90 1 0 0 " + Filter("intmult", "\"rgb tint\" [0.2 0.5 1] \"float saturation\" 1.5") +
           "LightSource \"dome\" \"string texture:file\" \"data/sky-evening.hdr\" \"float intensity\" 0.3 "
           "AttributeEnd\nAttributeBegin Material \"conductor\" \"rgb reflectance\" [0.9 0.9 0.9] \"float "
           "roughness\" 0 Translate 0.3 0.4 0.9 Shape \"sphere\" \"float radius\" 0.35 AttributeEnd\n" +
           kThings,
       96, false});
  // A slide that is drawn through the beam, and doors that turn, while the shutter is open.
  scenes.push_back(
      {"moving",
       kHead +
           "AttributeBegin Translate -0.4 1.6 0 Rotate -90 1 0 0\nAttributeBegin ActiveTransform EndTime "
           "Translate 0.6 0 0 ActiveTransform All\n" +
           Filter("gobo", "\"string name\" \"slide\" " + kImage + "\"bool tile\" true") +
           "ActiveTransform EndTime Rotate 60 0 0 1 ActiveTransform All\n" +
           Filter("barn", "\"string name\" \"doors\" \"float width\" 1.2 \"float height\" 0.5 \"float edge\" 0.4") +
           "AttributeEnd\n" + Filter("combiner", "\"string filters\" \"slide,doors\"") +
           "LightSource \"rect\" \"float width\" 0.3 \"float height\" 0.3 \"float intensity\" 40\nAttributeEnd\n" +
           kThings});
  return scenes;
}

class Filters : public testing::TestWithParam<FilterScene> {};

TEST_P(Filters, AreTheSameForAllTechniques) {
  const FilterScene& scene = GetParam();
  const Replicas path = RenderReplicas(scene.text, "path", kReplicas, 2 * scene.samples);
  static const double rate = SidakRate(1e-3, 5 * static_cast<int>(FilterScenes().size()));
  uint64_t seed = 0;
  // sppm in both ways, where photons are many enough: gathered for what comes straight from lights, too.
  for (const char* name : {"light", "bdpt", "vcm", "sppm", "sppm, all photons"}) {
    const std::string integrator = std::string(name).substr(0, std::string(name).find(','));
    if (!scene.lightTracingSeesAll && integrator == "light") continue;
    if (integrator != name && std::string(scene.name) != "receivers") continue;
    RenderOverrides overrides;
    overrides.seed = seed += 1000;
    overrides.values["radius"] = 0.01;
    overrides.values["photons"] = 6000;
    overrides.values["direct-photons"] = integrator != name;
    const int samples = integrator == "light" ? 4 * scene.samples : scene.samples;
    const Replicas other = RenderReplicas(scene.text, integrator, kReplicas, samples, overrides);
    const Agreement result = CompareReplicas(other, path, 8, rate);
    std::printf("%-17s %-10s largest |z| %.2f (%.2f), chi2 %.1f (%.1f), bias %+.3f %% +- %.3f %%\n", name, scene.name,
                result.largestZ, result.thresholdZ, result.chiSquared, result.chiSquaredThreshold, 100 * result.bias,
                196 * result.biasError);
    EXPECT_TRUE(result.Agrees()) << name;
    EXPECT_EQ(other.faults + path.faults, 0u);
    EXPECT_FALSE(CompareReplicas(other, path, 8, rate, 1.04).Agrees()) << name << ": too noisy";
  }
}

INSTANTIATE_TEST_SUITE_P(Of, Filters, testing::ValuesIn(FilterScenes()),
                         [](const auto& info) { return std::string(info.param.name); });

TEST(FilterScenes, EveryTypeOfFilterIsInOne) {
  std::string all;
  for (const FilterScene& scene : FilterScenes()) all += scene.text;
  for (const FilterType& type : FilterRegistry())
    EXPECT_NE(all.find("LightFilter \"" + type.name + "\""), std::string::npos) << type.name;
}

bool IsSame(const Image& a, const Image& b) {
  return a.data == b.data;
}

RenderOverrides By(const char* integrator) {
  RenderOverrides overrides;
  overrides.integrator = integrator;
  return overrides;
}

// Nothing is left of a filter that does nothing.
TEST(FilterScenes, OfDensityZeroIsBitIdenticalToNone) {
  const std::string parts[] = {"barn", "blocker", "intmult", "ramp", "rod", "gobo", "cookie"};
  for (const char* integrator : {"path", "light", "bdpt", "sppm", "vcm"}) {
    const auto render = [&](const std::string& filters) {
      return RenderText(kHead + Lamp("-0.6 1.6 0", filters, "\"rect\" \"float intensity\" 6") +
                            Lamp("0.6 1.6 0", filters, "\"point\" \"rgb I\" [1 2 3]") + kThings,
                        4, By(integrator))
          .image;
    };
    const Image none = render("");
    std::string all, names;
    for (const std::string& type : parts) {
      const std::string image = type == "gobo" || type == "cookie" ? "\"string filename\" \"" LAMPYR_SOURCE_DIR
                                                                     "/scenes/data/wood.png\" "
                                                                   : "";
      const std::string filter = Filter(type, image + "\"float density\" 0 \"string name\" \"" + type + "\"");
      EXPECT_TRUE(IsSame(none, render(filter))) << integrator << " " << type;
      EXPECT_TRUE(IsSame(none, render(Filter(type, image) + Filter("none", "")))) << integrator << " " << type;
      all += filter;
      names += (names.empty() ? "" : ",") + type;
    }
    EXPECT_TRUE(IsSame(none, render(all + Filter("combiner", "\"string filters\" \"" + names + "\""))));
    EXPECT_FALSE(IsSame(none, render(Filter("blocker", "\"float radius\" 1"))));
    // A filter in a group to which nothing subscribes.
    EXPECT_TRUE(IsSame(none, render(Filter("blocker", "\"float radius\" 1 \"string linkingGroups\" \"nobody\""))));
  }
}

// A block of the picture in which a thing is seen.
Color MeanOver(const Image& image, int x0, int y0, int x1, int y1) {
  Color sum;
  for (int y = y0; y < y1; ++y) {
    for (int x = x0; x < x1; ++x) sum += image.RgbAt(x, y);
  }
  return sum / static_cast<float>((x1 - x0) * (y1 - y0));
}

// Two spheres side by side under one light, at −x and +x, and how bright each is against a scene without the filter.
struct TwoSpheres {
  double left = 0, right = 0;
};
TwoSpheres Brightness(const std::string& filters, const std::string& onLeft, const std::string& onRight) {
  const auto render = [&](const std::string& before) {
    const std::string text =
        "LookAt 0 4 0.01  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 40\n" + FilmWith("box", 32, 32) +
        World(1) + before + "LightSource \"point\" \"rgb I\" [9 9 9] \"point3 from\" [0 4 0]\nMaterial \"diffuse\"\n" +
        "AttributeBegin " + onLeft + " Translate -0.7 0 0 Shape \"sphere\" \"float radius\" 0.6 AttributeEnd\n" +
        "AttributeBegin " + onRight + " Translate 0.7 0 0 Shape \"sphere\" \"float radius\" 0.6 AttributeEnd\n";
    return RenderText(text, 16, By("path")).image;
  };
  const Image with = render(filters), without = render("");
  const auto ratio = [&](int x0, int x1) {
    return static_cast<double>(MeanOver(with, x0, 12, x1, 20).Average() / MeanOver(without, x0, 12, x1, 20).Average());
  };
  return {ratio(19, 26), ratio(6, 13)};  // +x is on the left of the picture
}

// "Attribute lightfilter" turns on the filters of a group for the sphere that subscribes.
TEST(FilterScenes, ABlockerIsSubscribedByOneSphere) {
  const std::string filter =
      Filter("blocker", "\"string name\" \"blocker\" \"float radius\" 9 \"string linkingGroups\" [ \"blockers\" ]");
  const TwoSpheres one = Brightness(filter, "Attribute \"lightfilter\" \"string subset\" [ \"blockers\" ]", "");
  EXPECT_EQ(one.left, 0);
  EXPECT_EQ(one.right, 1);
  const TwoSpheres lists =
      Brightness(Filter("blocker", "\"float radius\" 9 \"string linkingGroups\" \"some, blockers\""), "",
                 "Attribute \"lightfilter\" \"string subset\" \" others,blockers , more\"");
  EXPECT_EQ(lists.left, 1);
  EXPECT_EQ(lists.right, 0);
}

// Three filters; the second is off on the right sphere, which does not subscribe to it.
TEST(FilterScenes, ACombinerLeavesOutWhatIsDisabled) {
  const std::string filters =
      Filter("intmult", "\"string name\" \"a\" \"float intensity\" 0.5") +
      Filter("intmult", "\"string name\" \"b\" \"float intensity\" 0.25 \"string linkingGroups\" \"left\"") +
      Filter("intmult", "\"string name\" \"c\" \"float intensity\" 3") +
      Filter("combiner", "\"string filters\" [ \"a\" \"b\" \"c\" ]");
  const std::string left = "Attribute \"lightfilter\" \"string subset\" \"left\"";
  const TwoSpheres product = Brightness(filters, left, "");
  EXPECT_NEAR(product.left, 0.375, 1e-6);
  EXPECT_NEAR(product.right, 1.5, 1e-6);
  const std::string before = filters.substr(0, filters.find("LightFilter \"combiner\""));
  const auto mode = [&](const char* name) {
    return Brightness(
        before + Filter("combiner", "\"string filters\" \"a,b,c\" \"string mode\" \"" + std::string(name) + "\""), left,
        "");
  };
  EXPECT_NEAR(mode("min").left, 0.25, 1e-6);
  EXPECT_NEAR(mode("min").right, 0.5, 1e-6);
  EXPECT_NEAR(mode("max").left, 3, 1e-5);
  EXPECT_NEAR(mode("screen").right, 1 - 0.5 * -2, 1e-5);
}

// A light without a filter that says how much it lets through keeps its chance to be selected.
TEST(FilterScenes, NoLightIsCulledByAFilterThatSaysNothing) {
  const std::string lights =
      Lamp("-0.6 1.6 0", Filter("ramp", "\"float end\" 1 \"float knots\" 0 \"rgb colors\" [ 1e4 1e4 1e4 ]"),
           "\"point\" \"rgb I\" [1e-4 1e-4 1e-4]") +
      Lamp("0.6 1.6 0", Filter("intmult", "\"float intensity\" 0"), "\"point\" \"rgb I\" [1 2 3]") + kThings;
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  for (const char* selection : {"power", "tree", "exhaustive", "uniform"}) {
    RenderOverrides overrides = By("path");
    overrides.values["light-sampler"] = selection;
    const BuiltScene built =
        BuildScene(ParseScene(kHead + lights, "test.pbrt", diagnostics), overrides, true, diagnostics);
    const Receiver receiver{Point3(0.0f), Normal3(0, 1, 0)};
    const double ramped = static_cast<double>(built.scene.lighting->SelectionProbability(receiver, 0, 0).value);
    EXPECT_GT(ramped, 0) << selection;
    // intmult says 0: hardly anything is spent on it.
    const double dark = static_cast<double>(built.scene.lighting->SelectionProbability(receiver, 1, 0).value);
    if (std::string(selection) != "uniform") {
      EXPECT_LT(dark, 0.2) << selection;
    }
  }
}

// The number of groups is unlimited, and no sample is spent on a light that is not linked.
TEST(Linking, HundredsOfGroupsOfLights) {
  std::string text = kHead;
  constexpr int groups = 300;
  for (int i = 0; i < groups; ++i) {
    const std::string name = "\"group" + std::to_string(i) + "\"";
    text += "LightSource \"point\" \"string lightGroup\" " + name + " \"rgb I\" [1 1 1] \"point3 from\" [ 0 " +
            std::to_string(2 + 0.01 * i) + " 0 ]\n";
    text += "AttributeBegin Attribute \"lighting\" \"string subset\" [ " + name + " ] Translate " +
            std::to_string(0.1 * i) + " 0 0 Shape \"sphere\" \"float radius\" 0.04 AttributeEnd\n";
  }
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  const BuiltScene built = BuildScene(ParseScene(text, "test.pbrt", diagnostics), By("path"), true, diagnostics);
  const LightingServices& lighting = *built.scene.lighting;
  EXPECT_EQ(lighting.Linking().ClassCount(), groups + 1u);
  for (uint32_t i = 0; i < groups; ++i) {
    Receiver receiver{Point3(0.0f), Normal3(0, 1, 0)};
    receiver.link = i + 1;
    for (uint32_t light = 0; light < groups; ++light)
      EXPECT_EQ(lighting.SelectionProbability(receiver, light, kAnyPatch).value, light == i ? 1.0f : 0.0f);
    receiver.link = 0;
    EXPECT_GT(lighting.SelectionProbability(receiver, i, kAnyPatch).value, 0);
  }
}

}  // namespace
}  // namespace lampyr::test
