// The selection of lights changes the noise of a picture and nothing else; for real lights it is a distribution that
// leaves out no light that contributes.
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <random>

#include "agreement/agreement_scenes.h"
#include "sampling/rng.h"
#include "sampling/warp.h"
#include "support/replicas.h"
#include "support/selection_noise.h"

namespace lampyr::test {
namespace {

BuiltScene Build(const std::string& text, const std::string& selection, int samples = 1) {
  RenderOverrides overrides;
  overrides.values["light-samples"] = samples;
  overrides.values["light-sampler"] = selection;
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  return BuildScene(ParseScene(text, std::string(LAMPYR_SOURCE_DIR) + "/scenes/test.pbrt", diagnostics), overrides,
                    true, diagnostics);
}

// A courtyard with lamps of all kinds, and sky and sun over it.
std::string ManyLights() {
  std::string text = FilmWith("box", 24, 24) + "LookAt 0 5 6  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 50\n" +
                     World(4) +
                     R"(LightSource "infinite" "rgb L" [0.03 0.04 0.06]
LightSource "distant" "rgb L" [0.1 0.09 0.08] "point3 from" [1 2 0.5]
)";
  std::mt19937 generator(5);
  std::uniform_real_distribution<double> uniform(0, 1);
  const auto number = [&](double low, double high) {
    return std::to_string(low + (high - low) * uniform(generator)) + " ";
  };
  for (int i = 0; i < 24; ++i) {
    const std::string place = number(-3, 3) + number(0.3, 2) + number(-3, 3);
    const std::string color = number(0.05, 0.4) + number(0.05, 0.4) + number(0.05, 0.4);
    text += "AttributeBegin\nTranslate " + place + "Rotate " + number(0, 360) + number(-1, 1) + number(-1, 1) + "0.3\n";
    const std::string area = "AreaLightSource \"diffuse\" \"rgb L\" [" + color + "] \"float scale\" 20\n" +
                             "Material \"diffuse\" \"rgb reflectance\" [0.2 0.2 0.2]\n";
    switch (i % 6) {
      case 0:
        text += "LightSource \"point\" \"rgb I\" [" + color + "]\n";
        break;
      case 1:
        text += "LightSource \"spot\" \"rgb I\" [" + color + "] \"float scale\" 4 \"float coneangle\" 35\n";
        break;
      case 2:
        text += area + "Shape \"sphere\" \"float radius\" 0.06\n";
        break;
      case 3:
        text += area + "Shape \"disk\" \"float radius\" 0.1\n";
        break;
      case 4:  // five triangles, each an emitter of its own
        text +=
            area +
            "Shape \"trianglemesh\" \"point3 P\" [0 0 0  0.3 0 0  0.3 0.2 0  0 0.3 0.1  -0.2 0.1 0.2  -0.1 -0.2 0.1] "
            "\"integer indices\" [0 1 2  0 2 3  0 3 4  0 4 5  0 5 1]\n";
        break;
      default:
        text +=
            "AreaLightSource \"diffuse\" \"rgb L\" [" + color +
            "] \"float scale\" 10 \"bool twosided\" true\nMaterial \"diffuse\"\nShape \"bilinearmesh\" \"point3 P\" "
            "[-0.1 -0.1 0  0.1 -0.1 0  -0.1 0.1 0  0.1 0.1 0.05]\n";
    }
    text += "AttributeEnd\n";
  }
  return text + R"(Material "diffuse" "rgb reflectance" [0.5 0.5 0.5]
Shape "trianglemesh" "point3 P" [-4 0 -4  -4 0 4  4 0 4  4 0 -4] "integer indices" [0 1 2 0 2 3]
Material "diffusetransmission" "rgb reflectance" [0.4 0.3 0.3] "rgb transmittance" [0.3 0.3 0.4]
Shape "trianglemesh" "point3 P" [-1 0 -1  1 0 -1.5  1 1.4 -1.5  -1 1.4 -1] "integer indices" [0 1 2 0 2 3]
)";
}

std::vector<AgreementScene> AllScenes() {
  std::vector<AgreementScene> scenes = AgreementScenes();
  static const std::string many = ManyLights();
  AgreementScene added{};
  added.name = "many";
  added.text = many;
  scenes.push_back(added);
  return scenes;
}

Receiver RandomReceiver(const BoundingSphere& sphere, Rng& rng) {
  constexpr float sizes[] = {1, 1, 1, 10, 1e6f};
  const float size = 2 * sphere.radius * sizes[rng.NextUint32() % 5];
  const Point3 cube = Point3(rng.NextFloat(), rng.NextFloat(), rng.NextFloat()) - 0.5f;
  Receiver receiver{sphere.center + size * cube, SampleUniformSphere(rng.NextPoint2()), rng.NextUint32() % 4 == 0};
  if (rng.NextUint32() % 8 == 0) receiver.normal = Normal3(0.0f);
  return receiver;
}

class Selection : public testing::TestWithParam<std::tuple<AgreementScene, const char*>> {};

TEST_P(Selection, IsADistributionThatLeavesNothingOut) {
  const auto& [scene, name] = GetParam();
  const BuiltScene built = Build(scene.text, name);
  const LightingServices& lighting = *built.scene.lighting;
  const std::vector<PlacedLight>& lights = lighting.Lights();
  Rng rng(1);
  int contributing = 0;
  for (int r = 0; r < 200; ++r) {
    const Receiver receiver = RandomReceiver(lighting.SceneSphere(), rng);
    const float time = rng.NextFloat();
    double sum = 0;
    for (uint32_t i = 0; i < lights.size(); ++i) {
      LightContext context;
      const LightTransform moved = lights[i].motion ? lights[i].At(time) : lights[i].transform;
      context.transform = &moved;
      context.scene = lighting.SceneSphere();
      context.time = time;
      for (int patch = 0; patch < lights[i].light->PatchCount(); ++patch) {
        const float probability = lighting.SelectionProbability(receiver, i, patch).value;
        if (patch == 0 || lighting.SelectsPatches(receiver)) sum += static_cast<double>(probability);
        context.u = rng.NextPoint2();
        context.patch = lights[i].light->PatchCount() > 1 ? patch : kAnyPatch;
        const auto sample = lights[i].light->GenerateSamples(context, receiver.position);
        if (!sample || (sample->diffuse + sample->specular).IsBlack()) continue;
        const float cosine = glm::dot(sample->direction, receiver.normal);
        const bool isLit = LengthSquared(receiver.normal) == 0 || receiver.isTransmissive || cosine > 0;
        if (!isLit) continue;
        ++contributing;
        EXPECT_GT(probability, 0) << "light " << i << ", patch " << patch;
      }
    }
    EXPECT_NEAR(sum, 1, 1e-4);
    const DirectSample direct = SampleOneLight(lighting, receiver, rng.NextFloat(), rng.NextPoint2(), time, true);
    if (!direct) continue;
    const int patch = direct.sample->patchIndex;
    EXPECT_EQ(direct.selection.value, lighting.SelectionProbability(receiver, direct.light, patch).value);
    // Photons come from the light as a whole, however it was selected here.
    const PlacedLight& placed = lights[direct.light];
    if (placed.light->Kind() != LightKind::Area) continue;
    const LightTransform moved = placed.motion ? placed.At(time) : placed.transform;
    LightContext context;
    context.transform = &moved;
    context.scene = lighting.SceneSphere();
    context.time = time;
    context.bidirectional = true;
    LightHit hit;
    hit.direction = direct.sample->direction;
    hit.distance = direct.sample->distance;
    hit.position = direct.sample->position;
    hit.normal = direct.sample->normal;
    hit.uv = Point2(direct.sample->uvw.x, direct.sample->uvw.y);
    hit.patchIndex = patch;
    const auto whole = placed.light->EvaluateSamples(context, hit, receiver.position);
    if (whole && !whole->pdfEmit.IsZero()) {
      EXPECT_NEAR(direct.sample->pdfEmit.value / whole->pdfEmit.value, 1, 1e-2);
    }
  }
  EXPECT_GT(contributing, 0);
}

INSTANTIATE_TEST_SUITE_P(Scenes, Selection,
                         testing::Combine(testing::ValuesIn(AllScenes()), testing::Values("tree", "exhaustive")),
                         [](const auto& info) {
                           return std::string(std::get<0>(info.param).name) + "_" + std::get<1>(info.param);
                         });

// The expected number of each light's samples at a receiver is its share; together they are all samples.
TEST_P(Selection, CountsSeveralSamples) {
  const auto& [scene, name] = GetParam();
  const BuiltScene built = Build(scene.text, name, 5);
  const LightingServices& lighting = *built.scene.lighting;
  Rng rng(2);
  for (int r = 0; r < 40; ++r) {
    const Receiver receiver = RandomReceiver(lighting.SceneSphere(), rng);
    LightChoices choices;
    lighting.SelectLights(receiver, rng.NextFloat(), choices);
    ASSERT_GE(choices.count, 1);
    ASSERT_LE(choices.count, 5);
    double sum = 0;
    for (uint32_t i = 0; i < lighting.Lights().size(); ++i) {
      const int patches = lighting.SelectsPatches(receiver) ? lighting.Lights()[i].light->PatchCount() : 1;
      for (int patch = 0; patch < patches; ++patch)
        sum += static_cast<double>(lighting.SelectionProbability(receiver, i, patch).value);
    }
    EXPECT_NEAR(sum, choices.count, 5e-4);
    for (int k = 0; k < choices.count; ++k) {
      const SelectedLight& chosen = choices.of[k];
      EXPECT_EQ(chosen.probability.value, lighting.SelectionProbability(receiver, chosen.light, chosen.patch).value);
    }
  }
}

// Lights with counts of their own are chosen that often at each receiver, the others as before; a mesh by its triangles
// where the others are.
TEST(FixedSampleCounts, AreThoseOfTheLights) {
  const std::string lamp =
      "\nShape \"trianglemesh\" \"point3 P\" [0 1 0 0.2 1 0 0 1.2 0 0.2 1.2 0.1] \"integer indices\" [0 1 2 1 3 2 0 1 "
      "3]\n";
  const auto area = [&](const std::string& count) {
    return "AttributeBegin\nAreaLightSource \"diffuse\" \"rgb L\" [2 2 2] " + count + lamp + "AttributeEnd\n";
  };
  const auto count = [](int n) { return "\"integer fixedSampleCount\" " + std::to_string(n) + " "; };
  const std::string point = "LightSource \"point\" \"point3 from\" [0.3 0.5 0.2] ";
  const std::string head = FilmWith("box", 8, 8) + World(4);
  const struct {
    std::string lights;
    size_t count;
    int most = LightChoices::kMost;  // of a light
  } cases[] = {
      {area(count(3)) + point + count(2) + "\n" + area("") + point + "\n", 4},
      {area(count(4)), 1},
      {point + count(5) + "\n" + area(count(1)), 2},
      {"LightSource \"infinite\" " + count(2) + "\n" + area("") + point + "\n", 3},
      {point + count(40) + "\n" + area(count(2)) + point + "\n", 3, 13},  // 16 at most, one of them for the last
  };
  for (const auto& one : cases) {
    for (const char* name : {"uniform", "power", "tree", "exhaustive"}) {
      for (const int others : {1, 4}) {
        const BuiltScene built = Build(head + one.lights, name, others);
        const LightingServices& lighting = *built.scene.lighting;
        ASSERT_EQ(lighting.Lights().size(), one.count);
        int fixed = 0;
        for (const PlacedLight& placed : lighting.Lights()) fixed += placed.light->Settings().fixedSampleCount > 0;
        Rng rng(3);
        for (int r = 0; r < 20; ++r) {
          const Receiver receiver = RandomReceiver(lighting.SceneSphere(), rng);
          std::vector<int> chosen(one.count);
          LightChoices choices;
          lighting.SelectLights(receiver, rng.NextFloat(), choices);
          int ofOthers = 0;
          for (int k = 0; k < choices.count; ++k) {
            const SelectedLight& choice = choices.of[k];
            ++chosen[choice.light];
            if (lighting.Lights()[choice.light].light->Settings().fixedSampleCount == 0) ++ofOthers;
            EXPECT_EQ(choice.probability.value,
                      lighting.SelectionProbability(receiver, choice.light, choice.patch).value);
          }
          EXPECT_LE(choices.count, LightChoices::kMost);
          EXPECT_EQ(ofOthers > 0, fixed < static_cast<int>(one.count));
          EXPECT_LE(ofOthers, others);
          double ofTheOthers = 0;
          for (uint32_t i = 0; i < lighting.Lights().size(); ++i) {
            const Light& light = *lighting.Lights()[i].light;
            const int patches = lighting.SelectsPatches(receiver) ? light.PatchCount() : 1;
            double expected = 0;
            for (int patch = 0; patch < patches; ++patch)
              expected += static_cast<double>(lighting.SelectionProbability(receiver, i, patch).value);
            const int wanted = std::min(light.Settings().fixedSampleCount, one.most);
            if (wanted == 0) {
              ofTheOthers += expected;
              continue;
            }
            EXPECT_EQ(chosen[i], wanted) << name;
            EXPECT_NEAR(expected, wanted, 1e-5) << name;
          }
          EXPECT_NEAR(ofTheOthers, ofOthers, 5e-4);
        }
      }
    }
  }
}

// In a room with a ball of haze: on surfaces the counts hold, and along rays in the haze lights are selected as
// without.
class FixedSampleCountsIn : public testing::TestWithParam<const char*> {};

TEST_P(FixedSampleCountsIn, ChangeTheNoiseAlone) {
  const auto text = [](const std::string& ofMesh, const std::string& ofPoint) {
    return FilmWith("box", 16, 16) +
           "MakeNamedMedium \"haze\" \"string type\" \"homogeneous\" \"rgb sigma_s\" [0.8 0.8 0.8] \"rgb sigma_a\" "
           "[0.2 0.2 0.2]\nLookAt 0 0 0.9  0 -0.2 -1  0 1 0\nCamera \"perspective\" \"float fov\" 80\n" +
           World(3) + kRoom +
           "AttributeBegin Material \"interface\" MediumInterface \"haze\" \"\" Translate -0.1 -0.3 -0.3 Shape "
           "\"sphere\" \"float radius\" 0.45 AttributeEnd\nAttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [6 5 "
           "4] " +
           ofMesh +
           "Translate 0.3 0.6 -0.3 Shape \"trianglemesh\" \"point3 P\" [-0.2 0 -0.2 0.2 0 -0.2 -0.2 0 0.2 0.2 0.1 0.2] "
           "\"integer indices\" [0 1 2 1 3 2 0 3 1] AttributeEnd\nLightSource \"point\" \"rgb I\" [0.2 0.1 0.1] "
           "\"point3 from\" [0.5 -0.3 0.1]\nLightSource \"point\" \"rgb I\" [0.7 0.8 1] \"point3 from\" [-0.4 0.5 "
           "0.2] " +
           ofPoint + "\n";
  };
  static const Replicas without = RenderReplicas(text("", ""), "path", 16, 256);
  RenderOverrides overrides;
  overrides.seed = 500;
  // Photons blur the corners of the room otherwise.
  overrides.values["radius"] = GetParam() == std::string("sppm") ? 0.05 : 0.01;
  const Replicas with = RenderReplicas(text("\"integer fixedSampleCount\" 3 ", "\"integer fixedSampleCount\" 2 "),
                                       GetParam(), 16, 96, overrides);
  const double rate = SidakRate(1e-3, 4);
  const Agreement result = CompareReplicas(with, without, 6, rate);
  std::printf("%s: %d blocks, largest |z| %.2f (threshold %.2f), chi2 %.1f (%.1f), bias %+.3f %% +- %.3f %%\n",
              GetParam(), result.blocks, result.largestZ, result.thresholdZ, result.chiSquared,
              result.chiSquaredThreshold, 100 * result.bias, 196 * result.biasError);
  EXPECT_TRUE(result.Agrees());
  EXPECT_EQ(with.faults, 0u);
  EXPECT_FALSE(CompareReplicas(with, without, 6, rate, 1.05).Agrees()) << "too noisy";
}

INSTANTIATE_TEST_SUITE_P(Of, FixedSampleCountsIn, testing::Values("path", "bdpt", "sppm", "vcm"),
                         [](const auto& tested) { return std::string(tested.param); });

// Counts above the limit are reduced, with a warning.
TEST(FixedSampleCounts, SaysWhichAreLess) {
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  const std::string point = "LightSource \"point\" \"integer fixedSampleCount\" 9\n";
  BuildScene(ParseScene(FilmWith("box", 8, 8) + World(4) + point + point, "test.pbrt", diagnostics), {}, true,
             diagnostics);
  int said = 0;
  for (const std::string& warning : diagnostics.Warnings())
    said += warning.find("\"fixedSampleCount\" 9: the light has 8") != std::string::npos;
  EXPECT_EQ(said, 2);
}

// A scene that is larger or smaller, and its lights with it, is lit by the same choices.
TEST(SelectionScale, ChangesNoProbability) {
  const auto build = [](const std::string& scale) {
    std::string text = FilmWith("box", 8, 8) + World(4) + "LightSource \"infinite\" \"rgb L\" [0.3 0.3 0.3]\nScale " +
                       scale + " " + scale + " " + scale + "\n";
    Rng rng(7);
    for (int i = 0; i < 60; ++i) {
      const Point3 p = 4.0f * (Point3(rng.NextFloat(), rng.NextFloat(), rng.NextFloat()) - 0.5f);
      text += "AttributeBegin\nTranslate " + std::to_string(p.x) + " " + std::to_string(p.y) + " " +
              std::to_string(p.z) + "\nRotate " + std::to_string(360 * rng.NextFloat()) + " 1 0.3 0.2\n" +
              "AreaLightSource \"diffuse\" \"rgb L\" [2 2 2]\n" +
              (i % 3 == 0 ? "Shape \"sphere\" \"float radius\" 0.05\n"
                          : "Shape \"trianglemesh\" \"point3 P\" [0 0 0 0.2 0 0 0 0.2 0 0.2 0.2 0.1] "
                            "\"integer indices\" [0 1 2 1 3 2]\n") +
              "AttributeEnd\n";
    }
    return Build(text, "tree");
  };
  const BuiltScene one = build("1");
  for (const char* scale : {"1e-3", "1e3"}) {
    const BuiltScene scaled = build(scale);
    const BoundingSphere from = one.scene.lighting->SceneSphere(), to = scaled.scene.lighting->SceneSphere();
    const float factor = std::stof(scale);
    Rng rng(3);
    double largest = 0;
    for (int r = 0; r < 200; ++r) {
      const Receiver receiver = RandomReceiver(from, rng);
      Receiver moved = receiver;
      moved.position = to.center + factor * (receiver.position - from.center);
      for (uint32_t i = 0; i < one.scene.lighting->Lights().size(); ++i) {
        for (int patch = 0; patch < one.scene.lighting->Lights()[i].light->PatchCount(); ++patch) {
          const float a = one.scene.lighting->SelectionProbability(receiver, i, patch).value;
          const float b = scaled.scene.lighting->SelectionProbability(moved, i, patch).value;
          largest = std::max(largest, static_cast<double>(std::abs(a - b)));
        }
      }
    }
    std::printf("scaled by %s: probabilities differ by %.1e at most\n", scale, largest);
    EXPECT_LT(largest, 2e-4);
  }
}

class SelectionAgreement : public testing::TestWithParam<std::tuple<const char*, const char*>> {};

TEST_P(SelectionAgreement, ChangesTheNoiseAlone) {
  const auto& [integrator, selection] = GetParam();
  const std::string text = ManyLights();
  static const Replicas uniform = [&] {
    RenderOverrides overrides;
    overrides.values["light-sampler"] = "uniform";
    return RenderReplicas(text, "path", 16, 256, overrides);
  }();
  RenderOverrides overrides;
  overrides.values["light-sampler"] = selection;
  overrides.seed = 500;
  const Replicas other = RenderReplicas(text, integrator, 16, 64, overrides);
  const double rate = SidakRate(1e-3, 7);
  const Agreement result = CompareReplicas(other, uniform, 6, rate);
  std::printf("%s, %s: %d blocks, largest |z| %.2f (threshold %.2f), chi2 %.1f (%.1f), bias %+.3f %% +- %.3f %%\n",
              integrator, selection, result.blocks, result.largestZ, result.thresholdZ, result.chiSquared,
              result.chiSquaredThreshold, 100 * result.bias, 196 * result.biasError);
  EXPECT_TRUE(result.Agrees());
  EXPECT_EQ(other.faults, 0u);
  EXPECT_FALSE(CompareReplicas(other, uniform, 6, rate, 1.03).Agrees()) << "too noisy";
  EXPECT_FALSE(CompareReplicas(other, uniform, 6, rate, 0.97).Agrees()) << "too noisy";
}

INSTANTIATE_TEST_SUITE_P(Ways, SelectionAgreement,
                         testing::Combine(testing::Values("path", "bdpt"),
                                          testing::Values("power", "tree", "exhaustive")),
                         [](const auto& info) {
                           return std::string(std::get<0>(info.param)) + "_" + std::get<1>(info.param);
                         });

// On scenes with hundreds and thousands of lights, every way to select them against the tree.
// Lights are selected as the settings of a render say, not as those say with which its scene was built: variants of a
// comparison share a scene.
TEST(Selection, IsThatOfTheRender) {
  const BuiltScene built = Build(ManyLights(), "tree");
  for (const char* integrator : {"path", "bdpt", "vcm", "sppm"}) {
    SCOPED_TRACE(integrator);
    const auto picture = [&](const BuiltScene& scene, const std::string& selection, int64_t samples) {
      BuiltScene variant = scene;
      variant.settings.integrator = integrator;
      variant.settings.values.Set("light-sampler", selection);
      variant.settings.values.Set("light-samples", samples);
      return RenderBuilt(variant, 2, 2).image.data;
    };
    const std::vector<float> one = picture(built, "tree", 1);
    for (const auto& [selection, samples] : {std::pair("tree", 4), std::pair("power", 1), std::pair("uniform", 3)}) {
      const std::vector<float> other = picture(built, selection, samples);
      EXPECT_NE(other, one) << selection;
      EXPECT_EQ(other, picture(Build(ManyLights(), selection, samples), selection, samples)) << selection;
    }
  }
}

struct ManyLightCase {
  const char *scene, *integrator, *selection;
};

class ManyLightScenes : public testing::TestWithParam<ManyLightCase> {};

TEST_P(ManyLightScenes, AgreeWhateverSelects) {
  const ManyLightCase& one = GetParam();
  const bool isPeer = one.scene == std::string("lights600");
  const std::filesystem::path folder =
      isPeer ? std::filesystem::path(LAMPYR_SHARED_DATA) / "peer" : std::filesystem::path(LAMPYR_SOURCE_DIR) / "scenes";
  const std::filesystem::path file = folder / (std::string(one.scene) + ".pbrt");
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "the scene is not here: " << file;
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  const SceneDescription description = ReadScene(file, diagnostics);
  RenderOverrides overrides;
  overrides.width = overrides.height = 32;
  overrides.values["light-sampler"] = "tree";
  const int more = isPeer ? 4 : 1;  // edges of lights that are seen are what is noisy there, and a sample costs little
  static std::map<std::string, Replicas> references;
  if (!references.count(one.scene)) {
    overrides.seed = 1000;
    references[one.scene] = RenderReplicas(description, "path", 8, more * 128, overrides);
  }
  overrides.seed = 0;
  overrides.values["light-sampler"] = one.selection;
  if (one.selection == std::string("split")) {
    overrides.values["light-sampler"] = "tree";
    overrides.values["light-samples"] = 4;
  }
  const Replicas replicas = RenderReplicas(description, one.integrator, 8, more * 48, overrides);
  const double rate = SidakRate(1e-3, 21);
  const Agreement result = CompareReplicas(replicas, references[one.scene], 16, rate);
  std::printf("%s, %s, %s: %d blocks, largest |z| %.2f (threshold %.2f), chi2 %.1f (%.1f), bias %+.2f %% +- %.2f %%\n",
              one.scene, one.integrator, one.selection, result.blocks, result.largestZ, result.thresholdZ,
              result.chiSquared, result.chiSquaredThreshold, 100 * result.bias, 196 * result.biasError);
  EXPECT_TRUE(result.Agrees());
  EXPECT_EQ(replicas.faults, 0u);
  EXPECT_FALSE(CompareReplicas(replicas, references[one.scene], 16, rate, 1.1).Agrees()) << "too noisy";
}

std::vector<ManyLightCase> ManyLightCases() {
  std::vector<ManyLightCase> cases;
  for (const char* scene : {"lights600", "lights-1000", "rooms"}) {
    for (const char* selection : {"uniform", "power", "split"}) cases.push_back({scene, "path", selection});
    for (const char* selection : {"uniform", "power", "tree", "split"}) cases.push_back({scene, "bdpt", selection});
  }
  return cases;
}

INSTANTIATE_TEST_SUITE_P(Cases, ManyLightScenes, testing::ValuesIn(ManyLightCases()), [](const auto& info) {
  std::string name = std::string(info.param.scene) + "_" + info.param.integrator + "_" + info.param.selection;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

// The purpose of the tree: its variance comes near to that of evaluating every light, and its efficiency is far above
// that of `power`. Only the efficiency depends on the machine; it is twice the required one.
TEST(SelectionNoiseOf, TheTreeIsNearTheLimitAndFarFromPower) {
  const std::string shared = std::string(LAMPYR_SHARED_DATA) + "/peer/lights600.pbrt";
  const struct {
    std::string file;
    int samplesPerPixel;
    double gain;
    bool againstAll;
  } cases[] = {{shared, 32, 2, true},
               {std::string(LAMPYR_SOURCE_DIR) + "/scenes/lights-1000.pbrt", 16, 1, true},
               {std::string(LAMPYR_SOURCE_DIR) + "/scenes/rooms.pbrt", 16, 4, false}};
  for (const auto& one : cases) {
    if (!std::filesystem::exists(one.file)) {
      std::printf("the scene is not here, and its case is skipped: %s\n", one.file.c_str());
      continue;
    }
    Diagnostics diagnostics(Diagnostics::Mode::Collect);
    const SceneDescription description = ReadScene(one.file, diagnostics);
    RenderOverrides overrides;
    overrides.width = overrides.height = 64;
    const std::vector<bool> mask = SeesNoLight(description, overrides);
    const auto measure = [&](const char* integrator, const char* selection) {
      return MeasureSelection(description, mask, integrator, selection, one.samplesPerPixel, 8, overrides);
    };
    const SelectionNoise power = measure("path", "power"), tree = measure("path", "tree");
    const SelectionNoise bdptPower = measure("bdpt", "power"), bdptTree = measure("bdpt", "tree");
    std::printf("%s: the tree has %.1f x the efficiency of power with path, %.1f x with bdpt\n", one.file.c_str(),
                tree.Efficiency() / power.Efficiency(), bdptTree.Efficiency() / bdptPower.Efficiency());
    EXPECT_GT(tree.Efficiency(), one.gain * power.Efficiency()) << one.file;
    EXPECT_GT(bdptTree.Efficiency(), bdptPower.Efficiency()) << one.file;
    if (!one.againstAll) continue;
    const SelectionNoise all = measure("path", "exhaustive");
    std::printf("  and %.2f x the variance of looking at every light\n", tree.meanSquaredError / all.meanSquaredError);
    EXPECT_LT(tree.meanSquaredError, 1.3 * all.meanSquaredError) << one.file;
  }
}

}  // namespace
}  // namespace lampyr::test
