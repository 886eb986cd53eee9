// Light groups: the layers of a picture add up to it in every integrator, each is what the lights of its group alone
// would give, and neither the picture nor a file without groups knows that there are any.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <tuple>

#include "support/layer_of.h"
#include "support/replicas.h"
#include "support/temporary_folder.h"

namespace lampyr::test {
namespace {

constexpr const char* kIntegrators[] = {"path", "light", "bdpt", "sppm", "vcm"};

std::string Head(const std::string& filter) {
  return "Film \"rgb\" \"integer xresolution\" 24 \"integer yresolution\" 20\nPixelFilter \"" + filter + R"("
LookAt 0 1.5 4.2  0 0.75 0  0 1 0
Camera "perspective" "float fov" 42
Integrator "path" "integer maxdepth" 6
WorldBegin
)";
}

// A corner with a ball of smooth glass, a mirror, a ball of rough metal and a pane of red glass; above them is sky.
constexpr const char* kThings = R"(Material "diffuse" "rgb reflectance" [0.6 0.5 0.4]
Shape "trianglemesh" "point3 P" [-2.5 0 -2  -2.5 0 2.5  2.5 0 2.5  2.5 0 -2] "integer indices" [0 1 2 0 2 3]
AttributeBegin
Material "diffuse" "rgb reflectance" [0.4 0.5 0.6]
Shape "trianglemesh" "point3 P" [-2.5 0 -1.2  0.6 0 -1.2  0.6 1.4 -1.2  -2.5 1.4 -1.2] "integer indices" [0 1 2 0 2 3]
AttributeEnd
AttributeBegin
Material "dielectric" "float eta" 1.5
Translate -0.5 0.45 0.4 Shape "sphere" "float radius" 0.4
AttributeEnd
AttributeBegin
Material "conductor" "rgb reflectance" [0.9 0.8 0.6] "float roughness" 0.3
Translate 0.45 0.35 0.1 Shape "sphere" "float radius" 0.35
AttributeEnd
AttributeBegin
Material "conductor" "rgb reflectance" [0.9 0.9 0.9] "float roughness" 0
Translate 1.3 0.35 0.3 Shape "sphere" "float radius" 0.35
AttributeEnd
AttributeBegin
Material "thindielectric" "rgb transmittance" [0.9 0.4 0.3]
Shape "trianglemesh" "point3 P" [-2 0.3 -0.9  -1.2 0.3 -0.9  -1.2 1.9 -0.9  -2 1.9 -0.9] "integer indices" [0 1 2 0 2 3]
AttributeEnd
)";

// One light of each way to be found, in the groups "warm" and "cool" and in none. `shape`: what stays of it where it is
// dark.
struct GroupedLight {
  std::string group, before, bright, dark, after;
};

std::vector<GroupedLight> Lights() {
  const std::string quad =
      " Material \"diffuse\" \"rgb reflectance\" [0.2 0.2 0.2] Shape \"trianglemesh\" \"point3 P\" [";
  const std::string indices = "] \"integer indices\" [0 1 2 0 2 3] AttributeEnd\n";
  return {
      // The camera sees it, and its caustic.
      {"warm", "AttributeBegin AreaLightSource \"diffuse\" ", "\"rgb L\" [9 5 2]", "\"rgb L\" [0 0 0]",
       quad + "-1.1 1.8 -0.2  -0.6 1.8 -0.2  -0.6 1.9 0.2  -1.1 1.9 0.2" + indices},
      // Two instances of one lamp.
      {"cool", "ObjectBegin \"lamp\" AttributeBegin AreaLightSource \"mesh\" ", "\"rgb color\" [2 4 8]",
       "\"rgb color\" [0 0 0]",
       quad + "0.5 2 0  0.9 2 0  0.9 2 0.4  0.5 2 0.4" + indices +
           "ObjectEnd\nObjectInstance \"lamp\"\n"
           "AttributeBegin Translate -1 -0.2 -0.8 Scale 0.7 1 0.7 ObjectInstance \"lamp\" AttributeEnd\n"},
      {"",
       "AttributeBegin Translate 1.2 1.9 -0.6 Rotate -60 1 0 0 LightFilter \"barn\" \"float edge\" 0.5 "
       "LightSource \"rect\" \"float width\" 0.4 ",
       "\"rgb color\" [3 9 3]", "\"rgb color\" [0 0 0]", " AttributeEnd\n"},
      {"cool",
       "AttributeBegin LightFilter \"intmult\" \"rgb tint\" [1 0.4 1] LightSource \"point\" \"point3 from\" [-1.2 1.6 "
       "1.2] ",
       "\"rgb I\" [0.4 0.8 1.6]", "\"rgb I\" [0 0 0]", " AttributeEnd\n"},
      {"", "LightSource \"spot\" \"point3 from\" [1.5 2.2 1.8] \"point3 to\" [0.3 0 0] ", "\"rgb I\" [4 10 4]",
       "\"rgb I\" [0 0 0]", "\n"},
      {"warm", "LightSource \"distant\" \"point3 from\" [1 3 2] \"float angle\" 8 ", "\"rgb L\" [30 20 5]",
       "\"rgb L\" [0 0 0]", "\n"},
      {"cool", "LightSource \"distant\" \"point3 from\" [-2 3 1] ", "\"rgb L\" [0.1 0.2 0.5]", "\"rgb L\" [0 0 0]",
       "\n"},
      // The background is both.
      {"warm", "LightSource \"infinite\" ", "\"rgb L\" [0.3 0.15 0.05]", "\"rgb L\" [0 0 0]", "\n"},
      {"cool", "LightSource \"dome\" ", "\"rgb color\" [0.05 0.1 0.3]", "\"rgb color\" [0 0 0]", "\n"},
  };
}

const std::map<std::string, std::string> kLayers = {{"warm", "warm"}, {"cool", "cool"}, {"", "rest"}};

std::string WithGroups(const std::string& filter = "gaussian") {
  std::string text = Head(filter);
  for (const GroupedLight& light : Lights()) {
    const std::string group = light.group.empty() ? "" : " \"string lightGroup\" \"" + light.group + "\"";
    text += light.before + light.bright + group + light.after;
  }
  return text + kThings;
}

std::string WithoutGroups() {
  std::string text = Head("gaussian");
  for (const GroupedLight& light : Lights()) text += light.before + light.bright + light.after;
  return text + kThings;
}

std::string Alone(const std::string& group) {
  std::string text = Head("gaussian");
  for (const GroupedLight& light : Lights())
    text += light.before + (light.group == group ? light.bright : light.dark) + light.after;
  return text + kThings;
}

RenderOverrides With(const std::string& integrator) {
  RenderOverrides overrides;
  overrides.integrator = integrator;
  return overrides;
}

// The largest difference between the picture and the sum of its layers, in units of the last place of that sum.
double LargestDifference(const Image& image, const std::vector<std::string>& layers) {
  const Image whole = LayerOf(image, "");
  std::vector<double> sums(whole.data.size()), sizes(whole.data.size());
  for (const std::string& layer : layers) {
    const Image part = LayerOf(image, layer);
    for (size_t i = 0; i < sums.size(); ++i) {
      sums[i] += static_cast<double>(part.data[i]);
      sizes[i] += std::abs(static_cast<double>(part.data[i]));
    }
  }
  double largest = 0;
  for (size_t i = 0; i < sums.size(); ++i) {
    const double unit = sizes[i] * static_cast<double>(std::numeric_limits<float>::epsilon());
    const double difference = std::abs(static_cast<double>(whole.data[i]) - sums[i]);
    if (difference > 0) largest = std::max(largest, difference / unit);
  }
  return largest;
}

class LightGroupLayers : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Of, LightGroupLayers, testing::ValuesIn(kIntegrators),
                         [](const auto& tested) { return tested.param; });

// The channels, but for the share of splats in the variance.
std::vector<std::string> LayersIn(const Image& image) {
  std::vector<std::string> layers = image.channels;
  std::erase(layers, kSplatShareChannel);
  return layers;
}

TEST_P(LightGroupLayers, AddUpToThePicture) {
  struct Case {
    const char* filter;
    int samples;
    const char* crop;
    int lightSamples;
  };
  for (const Case& tried : {Case{"gaussian", 1, nullptr, 1}, Case{"gaussian", 16, nullptr, 4},
                            Case{"box", 7, nullptr, 1}, Case{"mitchell", 16, "5,18,3,17", 1}}) {
    RenderOverrides overrides = With(GetParam());
    if (tried.crop) overrides.crop = tried.crop;
    overrides.values["light-samples"] = tried.lightSamples;
    const Image image = RenderText(WithGroups(tried.filter), tried.samples, overrides, 2).image;
    EXPECT_EQ(LayersIn(image),
              (std::vector<std::string>{"R", "G", "B", "variance.R", "variance.G", "variance.B", "cool.R", "cool.G",
                                        "cool.B", "warm.R", "warm.G", "warm.B", "rest.R", "rest.G", "rest.B"}));
    const double difference = LargestDifference(image, {"cool", "warm", "rest"});
    std::printf("%-5s %-8s %2d samples: %.2f ulp\n", GetParam(), tried.filter, tried.samples, difference);
    EXPECT_LE(difference, 4);
    EXPECT_GT(LargestDifference(image, {"cool", "warm"}), 1e4);
  }
}

// With the options that are off by default.
TEST(LightGroups, AddUpWithAllSwitches) {
  std::vector<RenderOverrides> all;
  for (const auto& [integrator, merges, connects, direct] :
       {std::tuple{"vcm", false, true, false}, std::tuple{"vcm", true, false, false},
        std::tuple{"sppm", true, true, true}}) {
    RenderOverrides overrides = With(integrator);
    if (!merges) overrides.values["merge"] = false;
    if (!connects) overrides.values["connect"] = false;
    if (direct) overrides.values["direct-photons"] = true;
    overrides.values["learn-always"] = true;
    all.push_back(overrides);
  }
  for (const RenderOverrides& overrides : all) {
    const Image image = RenderText(WithGroups(), 8, overrides, 2).image;
    EXPECT_LE(LargestDifference(image, {"cool", "warm", "rest"}), 4) << *overrides.integrator;
    EXPECT_GT(LargestDifference(image, {"cool", "warm"}), 1e4) << *overrides.integrator;
  }
}

TEST_P(LightGroupLayers, DoNotChangeThePicture) {
  const Image with = RenderText(WithGroups(), 9, With(GetParam())).image;
  const Image without = RenderText(WithoutGroups(), 9, With(GetParam())).image;
  EXPECT_EQ(LayersIn(without), (std::vector<std::string>{"R", "G", "B", "variance.R", "variance.G", "variance.B"}));
  for (size_t c = 0; c < 6; ++c) {
    for (int y = 0; y < with.height; ++y) {
      for (int x = 0; x < with.width; ++x)
        ASSERT_EQ(with.At(x, y, c), without.At(x, y, c)) << without.channels[c] << " at " << x << ", " << y;
    }
  }
}

TEST_P(LightGroupLayers, AreTheSameForAnyThreadsAndPasses) {
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  BuiltScene built =
      BuildScene(ParseScene(WithGroups(), "test.pbrt", diagnostics), With(GetParam()), true, diagnostics);
  const std::unique_ptr<Integrator> integrator = MakeIntegrator(built.scene, built.settings);
  const auto render = [&](const std::vector<int>& passes, int threads) {
    Film film(built.settings.width, built.settings.height, built.settings.crop, built.scene.outputs->Names());
    ProgressiveRender progress(built.scene, *integrator, built.settings, threads, film);
    for (const int samples : passes) progress.AddSamples(samples);
    return film.Develop().data;
  };
  const std::vector<float> once = render({7}, 1);
  EXPECT_EQ(render({7}, 2), once);
  EXPECT_EQ(render({1, 2, 4}, 2), once);
  EXPECT_EQ(render({3, 3, 1}, 1), once);
  EXPECT_NE(render({6}, 1), once);
}

TEST_P(LightGroupLayers, OfACropAreThoseOfThePicture) {
  RenderOverrides overrides = With(GetParam());
  overrides.values["guide-photons"] = overrides.values["guide-paths"] = false;  // they learn from what the crop sees
  const Image whole = RenderText(WithGroups(), 4, overrides).image;
  overrides.crop = "5,18,3,17";
  const Image crop = RenderText(WithGroups(), 4, overrides).image;
  ASSERT_EQ(crop.channels, whole.channels);
  for (int y = 0; y < crop.height; ++y) {
    for (int x = 0; x < crop.width; ++x) {
      for (size_t c = 0; c < crop.channels.size(); ++c)
        ASSERT_EQ(crop.At(x, y, c), whole.At(x + 5, y + 3, c)) << crop.channels[c] << " at " << x << ", " << y;
    }
  }
}

// Every contribution is in the layer of its own light.
TEST_P(LightGroupLayers, AreWhatTheirLightsGiveAlone) {
  constexpr int replicas = 16, blockSize = 4;
  // Samples that suffice to distinguish 3 % of a layer from 0.
  const std::map<std::string, int> samplesOf = {{"path", 96}, {"light", 320}, {"bdpt", 96}, {"sppm", 160}, {"vcm", 64}};
  const int samples = samplesOf.at(GetParam());
  const double rate = SidakRate(1e-3, static_cast<int>(kLayers.size() * std::size(kIntegrators)));
  RenderOverrides overrides;
  const Replicas whole = RenderReplicas(WithGroups(), GetParam(), replicas, samples, overrides);
  EXPECT_EQ(whole.faults, 0u);
  for (const auto& [group, layer] : kLayers) {
    Replicas split;
    for (const Image& image : whole.images) split.images.push_back(LayerOf(image, layer));
    overrides.seed = 1000;
    const Replicas alone = RenderReplicas(Alone(group), GetParam(), replicas, samples, overrides);
    const Agreement result = CompareReplicas(split, alone, blockSize, rate);
    std::printf("%-5s %-4s %3d blocks, largest |z| %.2f (threshold %.2f), chi2 %.1f (%.1f), bias %+.3f %% +- %.3f %%\n",
                GetParam(), layer.c_str(), result.blocks, result.largestZ, result.thresholdZ, result.chiSquared,
                result.chiSquaredThreshold, 100 * result.bias, 196 * result.biasError);
    EXPECT_LE(result.largestZ, result.thresholdZ) << layer;
    EXPECT_LE(result.chiSquared, result.chiSquaredThreshold) << layer;
    EXPECT_LE(std::abs(result.meanZ), result.meanThreshold) << layer;
    EXPECT_FALSE(CompareReplicas(split, alone, blockSize, rate, 1.03).Agrees()) << layer << ": too noisy";
    EXPECT_FALSE(CompareReplicas(split, alone, blockSize, rate, 0.97).Agrees()) << layer << ": too noisy";
  }
}

TEST(LightGroups, WithoutUngroupedLightsThereIsNoRest) {
  const std::string head = Head("box");
  const std::string both = head + "LightSource \"point\" \"point3 from\" [0 2 0] \"string lightGroup\" \"a b\"\n" +
                           "LightSource \"point\" \"point3 from\" [1 2 0] \"string lightGroup\" \"Z\"\n" + kThings;
  const Image image = RenderText(both, 1, With("path")).image;
  EXPECT_EQ(std::vector<std::string>(image.channels.begin() + 6, image.channels.end()),
            (std::vector<std::string>{"Z.R", "Z.G", "Z.B", "a_b.R", "a_b.G", "a_b.B"}));
  EXPECT_LE(LargestDifference(image, {"Z", "a_b"}), 4);
}

// A sample that is dropped is dropped by all layers.
TEST(LightGroups, DroppedSamplesAreInNoLayer) {
  class Faulty final : public Integrator {
   public:
    TracedPaths Paths() const override { return TracedPaths::Camera; }
    Color Sample(const Ray*, const SampleContext& context) const override {
      context.sampler.SetDimension(PathDimensions().Of(0, dimensions::kLight));
      const float u = context.sampler.Get1D();
      const float fault = u < 0.25f ? std::numeric_limits<float>::quiet_NaN() : u < 0.5f ? -5.0f : 1.0f;
      context.layers->Add(0, Color(2.0f));
      context.layers->Add(2, Color(fault));
      return Color(2.0f) + Color(fault);
    }
  };
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  const BuiltScene built = BuildScene(ParseScene(WithGroups("box"), "test.pbrt", diagnostics), {}, true, diagnostics);
  const Faulty integrator;
  Film film(built.settings.width, built.settings.height, built.settings.crop, {"a", "b", "c"});
  ProgressiveRender render(built.scene, integrator, built.settings, 2, film);
  render.AddSamples(16);
  const auto pixels = static_cast<uint64_t>(built.settings.width) * static_cast<uint64_t>(built.settings.height);
  EXPECT_EQ(render.Outcome().counts.droppedSamples, 8 * pixels);  // of 16 stratified ones in each pixel
  const Image image = film.Develop();
  for (const auto& [layer, value] :
       {std::pair{"", 1.5f}, std::pair{"a", 1.0f}, std::pair{"b", 0.0f}, std::pair{"c", 0.5f}}) {
    for (const float pixel : LayerOf(image, layer).data) ASSERT_FLOAT_EQ(pixel, value) << layer;
  }
}

TEST(LightGroups, OfAFileComeBackByName) {
  const TemporaryFolder folder;
  const Image image = RenderText(WithGroups(), 2, With("bdpt")).image;
  WriteExr(folder.Path() / "a.exr", image, ExrPrecision::Float);
  const Image read = ReadImage(folder.Path() / "a.exr");
  EXPECT_EQ(LayersIn(read),
            (std::vector<std::string>{"R", "G", "B", "cool.R", "cool.G", "cool.B", "rest.R", "rest.G", "rest.B",
                                      "variance.R", "variance.G", "variance.B", "warm.R", "warm.G", "warm.B"}));
  for (const char* layer : {"", "cool", "warm", "rest"}) {
    EXPECT_EQ(LayerOf(read, layer).data, LayerOf(image, layer).data) << layer;
  }
}

std::string ErrorOf(const std::string& lights) {
  try {
    RenderText(Head("box") + lights, 1, With("path"));
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

TEST(LightGroups, HaveNamesThatImagesCanBear) {
  const auto point = [](const std::string& group) {
    return "LightSource \"point\" \"string lightGroup\" \"" + group + "\"\n";
  };
  for (const char* taken : {"variance", "R", "G", "B", "A"}) {
    EXPECT_NE(ErrorOf(point(taken)).find("test.pbrt:7:21: error: a light group cannot be called"), std::string::npos)
        << ErrorOf(point(taken));
  }
  EXPECT_NE(ErrorOf(point("rest")).find("layer of the lights that are in no light group"), std::string::npos);
  EXPECT_NE(ErrorOf(point(std::string(201, 'x'))).find("200 bytes"), std::string::npos);
  EXPECT_NE(ErrorOf(point("a.b") + point("a b")).find("would both be the layer \"a_b\""), std::string::npos);
  for (const std::string& fine : {std::string("r"), std::string("Variance"), std::string("key-1"),
                                  std::string("Schlüssel"), std::string("a.b"), std::string(200, 'x')})
    EXPECT_EQ(ErrorOf(point(fine)), "") << fine;
}

}  // namespace
}  // namespace lampyr::test
