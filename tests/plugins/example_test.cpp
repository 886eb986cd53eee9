// Results of the example plugin: the ring against formulas and between integrators, the iris by hand.
#include <gtest/gtest.h>

#include <cmath>

#include "lights/plugin/plugin_loader.h"
#include "plugins/plugins_fixture.h"
#include "sampling/rng.h"
#include "support/filter_agreement.h"
#include "support/replicas.h"

namespace lampyr::test {
namespace {

const TypeRegistry& Types() {
  static const TypeRegistry types = [] {
    TypeRegistry registry;
    registry.Add(LoadPlugin(RingPlugin()));
    return registry;
  }();
  return types;
}

ParameterList ParametersOf(const std::string& text) {
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  return ParseScene("WorldBegin\nLightSource \"any\" " + text, "test.pbrt", diagnostics).lights.at(0).light.parameters;
}

TEST(Ring, IsOneOfTheTypes) {
  ASSERT_NE(Types().FindLight("ring", false), nullptr);
  EXPECT_EQ(Types().FindLight("ring", true), nullptr);
  EXPECT_EQ(TypeRegistry::BuiltIn().FindLight("ring", false), nullptr);
  EXPECT_EQ(Types().FindLight("rect", false), FindLightType("rect", false));
  EXPECT_EQ(Types().FindFilter("intmult"), FindFilterType("intmult"));
  EXPECT_EQ(Types().Lights().size(), LightRegistry().size() + 1);
  EXPECT_EQ(Types().Filters().size(), FilterRegistry().size() + 1);
}

// An Error that the plugin's own code throws is an Error here, with its place.
TEST(Ring, ThrowsErrorsThatAreCaughtAsSuch) {
  const LightType& type = *Types().FindLight("ring", false);
  const ParameterList parameters = ParametersOf("\"float innerRadius\" 2");
  try {
    MakeLight(type, parameters, LightBuildContext());
    FAIL() << "it was made";
  } catch (const Error& error) {
    EXPECT_EQ(typeid(error), typeid(Error));
    EXPECT_EQ(error.Where().ToString(), "test.pbrt:2:19");
    EXPECT_NE(error.Text().find("innerRadius must be less"), std::string::npos);
  }
}

// A disk of radius r at distance d on its axis gives πL r² / (r² + d²); a ring is the difference of two.
TEST(Ring, GivesTheIrradianceThatItShould) {
  const double inner = 0.4, outer = 1.1, d = 0.7, L = 2.5;
  const auto light = MakeLight(
      *Types().FindLight("ring", false),
      ParametersOf("\"float innerRadius\" 0.4 \"float outerRadius\" 1.1 \"float intensity\" 2.5"), LightBuildContext());
  const LightTransform inPlace;
  LightContext context;
  context.transform = &inPlace;
  Rng rng(1);
  double sum = 0;
  constexpr int n = 200000;
  for (int i = 0; i < n; ++i) {
    context.u = rng.NextPoint2();
    const auto sample = light->GenerateSamples(context, Point3(0, 0, static_cast<float>(-d)));
    ASSERT_TRUE(sample);
    sum += static_cast<double>(sample->diffuse.g * sample->direction.z / sample->pdfDirect.value);
  }
  const auto part = [&](double r) { return r * r / (r * r + d * d); };
  const double expected = static_cast<double>(kPi) * L * (part(outer) - part(inner));
  EXPECT_NEAR(sum / n, expected, 5e-3 * expected);
  EXPECT_FALSE(light->GenerateSamples(context, Point3(0, 0, 1)));  // its back is dark
}

Replicas RenderRing(const std::string& text, const std::string& integrator, int samples, uint64_t seed,
                    RenderOverrides overrides = {}) {
  constexpr int kReplicas = 16;
  overrides.integrator = integrator;
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  BuiltScene built = BuildScene(ParseScene(text, std::string(LAMPYR_SOURCE_DIR) + "/scenes/test.pbrt", diagnostics),
                                overrides, true, diagnostics, Types());
  Replicas replicas;
  for (int i = 0; i < kReplicas; ++i) {
    built.settings.seed = seed + static_cast<uint64_t>(i);
    const Rendered rendered = RenderBuilt(built, samples, 1);
    replicas.images.push_back(rendered.image);
    replicas.faults += rendered.outcome.counts.droppedSamples + rendered.rejectedRays;
  }
  return replicas;
}

// Textured, mirrored and squeezed, through an iris, before the camera and above a ground with matte and metal on it.
TEST(Ring, IsTheSameToAllIntegrators) {
  const std::string scene = R"(Film "rgb" "integer xresolution" 24 "integer yresolution" 24
PixelFilter "box"
LookAt 0 1.1 3.2  0 0.6 0  0 1 0
Camera "perspective" "float fov" 40
Integrator "path" "integer maxdepth" 3
WorldBegin
AttributeBegin
Translate 0.2 1.1 -0.3 Scale -1 0.6 1 Rotate 25 1 0 0 Rotate 180 0 1 0
LightFilter "iris" "float angle" 75 "float density" 0.8
LightSource "ring" "float outerRadius" 0.6 "float intensity" 6 "bool twoSided" true "string texture:file" "data/screen.png"
AttributeEnd
Material "diffuse" "rgb reflectance" [0.6 0.5 0.4]
Shape "trianglemesh" "point3 P" [-2.5 0 -2.5  -2.5 0 2.5  2.5 0 2.5  2.5 0 -2.5] "integer indices" [0 1 2 0 2 3]
Shape "trianglemesh" "point3 P" [-2.5 0 -1.2  2.5 0 -1.2  2.5 3 -1.2  -2.5 3 -1.2] "integer indices" [0 1 2 0 2 3]
Material "conductor" "rgb reflectance" [0.9 0.8 0.6] "float roughness" 0.4
Translate 0.45 0.3 0.4 Shape "sphere" "float radius" 0.3
)";
  const Replicas path = RenderRing(scene, "path", 96, 0);
  constexpr double rate = 1e-3 / 3;
  const auto expectAgreement = [&](const char* what, const Replicas& other) {
    const Agreement result = CompareReplicas(other, path, 8, rate);
    std::printf("%-5s largest |z| %.2f (threshold %.2f), chi2 %.1f (%.1f), bias %+.3f %% +- %.3f %%\n", what,
                result.largestZ, result.thresholdZ, result.chiSquared, result.chiSquaredThreshold, 100 * result.bias,
                196 * result.biasError);
    EXPECT_TRUE(result.Agrees()) << what;
    EXPECT_EQ(path.faults + other.faults, 0u) << what;
    // The test must detect a picture that is 2 % too bright or too dark.
    EXPECT_FALSE(CompareReplicas(other, path, 8, rate, 1.02).Agrees()) << what << ": too noisy";
    EXPECT_FALSE(CompareReplicas(other, path, 8, rate, 0.98).Agrees()) << what << ": too noisy";
  };
  expectAgreement("light", RenderRing(scene, "light", 96, 1000));
  expectAgreement("bdpt", RenderRing(scene, "bdpt", 48, 2000));
  // Photons blur within a radius: a small one leaves what is to be seen of it below the noise.
  RenderOverrides sharp;
  sharp.values["radius"] = 0.01;
  expectAgreement("vcm", RenderRing(scene, "vcm", 48, 3000, sharp));
}

// One light of 1 for diffuse and specular lobes, seen along a direction.
struct Filtered {
  float diffuse, specular;
};
Filtered Filter(const LightFilter& filter, const Vector3& toLight) {
  const Point3 receiver(0.3f, -2, 0.5f);
  const Vector3 direction = glm::normalize(toLight);
  const float distance = 4;
  const PdfSolidAngle pdf(1);
  Color diffuse(1.0f), specular(1.0f);
  FilterSamples samples;
  samples.count = 1;
  samples.receiver = &receiver;
  samples.toLight = &direction;
  samples.distance = &distance;
  samples.pdfDirect = &pdf;
  samples.diffuse = &diffuse;
  samples.specular = &specular;
  filter.Filter(FilterContext(), samples);
  return {diffuse.g, specular.g};
}

Vector3 AtDegrees(double degrees) {
  const double angle = degrees * static_cast<double>(kPi) / 180;
  return Vector3(Vector3d(std::sin(angle), 0, std::cos(angle)));
}

// The light leaves along -toLight: towards -z where toLight is +z.
TEST(Iris, FadesFromItsAxisOn) {
  const auto filter = MakeFilter(*Types().FindFilter("iris"),
                                 ParametersOf("\"float angle\" 40 \"float softness\" 0.5 \"float specular\" 0.5"),
                                 FilterBuildContext());
  for (const auto& [degrees, factor] : {std::pair(0.0, 1.0), std::pair(19.0, 1.0), std::pair(30.0, 0.5),
                                        std::pair(25.0, 1 - 0.15625), std::pair(41.0, 0.0), std::pair(170.0, 0.0)}) {
    const Filtered filtered = Filter(*filter, AtDegrees(degrees));
    EXPECT_NEAR(static_cast<double>(filtered.diffuse), factor, 1e-5) << degrees;
    EXPECT_NEAR(static_cast<double>(filtered.specular), 0.5 + 0.5 * factor, 1e-5) << degrees;
  }
}

TEST(Iris, IsPlacedAndInverted) {
  FilterBuildContext build;
  const Transform turned = Transform::Rotate(90, {0, 1, 0});  // its +z is +x now
  build.transform = {turned.ToAffine(), turned.Inverse().ToAffine()};
  const auto filter =
      MakeFilter(*Types().FindFilter("iris"), ParametersOf("\"float softness\" 0 \"bool invert\" true"), build);
  EXPECT_EQ(Filter(*filter, {1, 0, 0}).diffuse, 0.0f);
  EXPECT_EQ(Filter(*filter, {0, 0, 1}).diffuse, 1.0f);
}

TEST(Iris, IsTheSameToAllIntegrators) {
  ExpectFilterAgreement(*Types().FindFilter("iris"), Types(), 1);
}

TEST(Iris, HasItsParametersChecked) {
  const FilterType& type = *Types().FindFilter("iris");
  EXPECT_THROW(MakeFilter(type, ParametersOf("\"float angel\" 40"), FilterBuildContext()), Error);
  EXPECT_THROW(MakeFilter(type, ParametersOf("\"float angle\" 200"), FilterBuildContext()), Error);
}

// The factories of a plugin are made safe, whoever calls them.
TEST(Filters, ThatThrowAreErrors) {
  const Plugin plugin = LoadPlugin(FaultyPlugin("behaviour"));
  ASSERT_EQ(plugin.filters.size(), 1u);
  try {
    MakeFilter(plugin.filters[0], ParametersOf(""), FilterBuildContext());
    FAIL() << "it was made";
  } catch (const Error& error) {
    EXPECT_NE(error.Text().find("expected a filter, found something thrown that is no exception"), std::string::npos)
        << error.Text();
  }
}

// A plugin that cannot be added leaves nothing behind.
TEST(Registry, IsAsItWasWhereANameIsTaken) {
  TypeRegistry registry;
  EXPECT_THROW(registry.Add(LoadPlugin(FaultyPlugin("taken_name"))), Error);
  EXPECT_TRUE(registry.Plugins().empty());
  EXPECT_EQ(registry.FindLight("fresh", false), nullptr);
  Plugin twice = LoadPlugin(RingPlugin());
  twice.lights.push_back(twice.lights[0]);
  EXPECT_THROW(registry.Add(twice), Error);
}

}  // namespace
}  // namespace lampyr::test
