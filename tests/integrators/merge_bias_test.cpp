// The estimate of the bias of merging photons, where the bias is known: photons drawn with a density on a plane, and
// renders against the picture without blur.
#include "integrators/photon/merge_bias.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "integrators/photon/photon_map.h"
#include "sampling/rng.h"
#include "support/render_scene.h"

namespace lampyr::test {
namespace {

constexpr float kRadius = 0.25f;

struct Estimated {
  double bias = 0, deviation = 0;  // mean and its standard error
};

// Photons of unit flux with the irradiance `density` (1/unit²) on [-1, 1]², at most `most`, gathered at (x, 0): the
// estimate by many passes.
Estimated EstimateAt(float x, double most, const std::function<double(double x, double y)>& density) {
  constexpr int kPasses = 400;
  Rng rng(11);
  PhotonLookup lookup;
  double sum = 0, squares = 0;
  for (int pass = 0; pass < kPasses; ++pass) {
    PhotonList list;
    for (double i = 0; i < 4 * most; ++i) {
      const Point3 place(2 * rng.NextFloat() - 1, 2 * rng.NextFloat() - 1, 0);
      if (static_cast<double>(rng.NextFloat()) * most >=
          density(static_cast<double>(place.x), static_cast<double>(place.y)))
        continue;
      PathVertex vertex;
      vertex.point.position = place;
      vertex.toPrevious = Vector3(0, 0, 1);
      vertex.diffuse = vertex.specular = Color(1.0f);
      list.StartPath();
      list.Add(vertex, 1);
    }
    const PhotonMap map(std::span(&list, 1), 1);
    double bias = 0;
    const auto found = map.Find(Point3(x, 0, 0), kRadius, lookup);
    for (size_t i = 0; i < found.size(); ++i) bias += static_cast<double>(BiasFactor(lookup.distances[i], kRadius));
    bias /= static_cast<double>(kPi * kRadius * kRadius);
    sum += bias;
    squares += bias * bias;
  }
  const double mean = sum / kPasses;
  return {mean, std::sqrt((squares / kPasses - mean * mean) / (kPasses - 1))};
}

TEST(MergeBias, OfUniformLightIsNone) {
  const Estimated estimated = EstimateAt(0.1f, 1000, [](double, double) { return 1000; });
  EXPECT_NEAR(estimated.bias, 0, 3.5 * estimated.deviation);
  EXPECT_LT(estimated.deviation, 10);
}

TEST(MergeBias, OfLinearLightIsNone) {
  const Estimated estimated = EstimateAt(0.1f, 2000, [](double x, double) { return 1000 * (1 + x); });
  EXPECT_NEAR(estimated.bias, 0, 3.5 * estimated.deviation);
  EXPECT_LT(estimated.deviation, 10);
}

// E = k x²: ΔE = 2 k.
TEST(MergeBias, OfAParabolaIsThatOfTheLaplacian) {
  constexpr double k = 8000;
  const double expected = static_cast<double>(kRadius * kRadius) * 2 * k / 8;
  for (const float x : {0.0f, 0.3f}) {
    const Estimated estimated = EstimateAt(x, k, [](double own, double) { return k * own * own; });
    EXPECT_NEAR(estimated.bias, expected, 3.5 * estimated.deviation) << x;
    EXPECT_LT(estimated.deviation, 0.1 * expected) << x;
  }
}

// Beside a step the kernel of radius r reaches over it: the share of the disk beyond a line at u r from its centre is
// (acos u - u √(1 - u²)) / π. The estimate has its sign, and for the mean over both sides of the order of it.
TEST(MergeBias, OfAStepHasItsSignAndSize) {
  constexpr double k = 4000;
  const auto step = [](double x, double) { return x > 0 ? k : 0; };
  double estimates = 0, truths = 0;
  for (const float u : {-0.75f, -0.5f, -0.25f, 0.25f, 0.5f, 0.75f}) {
    const Estimated estimated = EstimateAt(u * kRadius, k, step);
    const auto distance = static_cast<double>(std::abs(u));
    const double share =
        (std::acos(distance) - distance * std::sqrt(1 - distance * distance)) / static_cast<double>(kPi);
    const double truth = u < 0 ? k * share : -k * share;
    EXPECT_GT(estimated.bias * truth, 0) << u;
    EXPECT_GT(std::abs(estimated.bias), 5 * estimated.deviation) << u;
    estimates += estimated.bias * estimated.bias;
    truths += truth * truth;
  }
  EXPECT_GT(std::sqrt(estimates / truths), 0.4);
  EXPECT_LT(std::sqrt(estimates / truths), 1.5);
}

// For a kernel on a line of half the width r, the bias of E = x² is r² / 3.
TEST(MergeBias, OnALineIsThatOfTheSecondMoment) {
  constexpr int kSteps = 100000;
  double estimate = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double x = (i + 0.5) / kSteps * static_cast<double>(kRadius);
    estimate += static_cast<double>(BiasFactorOnLine(x * x, kRadius)) * x * x / kSteps;
  }
  EXPECT_NEAR(estimate, static_cast<double>(kRadius * kRadius) / 3, 1e-5);
}

// A spot with a soft edge on a floor, seen straight from above, so that the picture is smooth.
const std::string kFloor = R"(LookAt 0 3 0  0 0 0  0 0 1
Camera "perspective" "float fov" 40
Film "rgb" "integer xresolution" 24 "integer yresolution" 24
PixelFilter "box"
Integrator "path" "integer maxdepth" 5
WorldBegin
LightSource "spot" "rgb I" [9 8 7] "point3 from" [0.3 2.2 -0.4] "point3 to" [0.1 0 0]
  "float coneangle" 24 "float conedeltaangle" 20
Material "diffuse" "rgb reflectance" [0.6 0.55 0.5]
Shape "bilinearmesh" "point3 P" [-3 0 -3  3 0 -3  -3 0 3  3 0 3]
)";
// The same light in a thin fog, and a black floor.
const std::string kFog = R"(LookAt 0 3 0  0 0 0  0 0 1
MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_s" [0.1 0.1 0.1] "rgb sigma_a" [0 0 0]
MediumInterface "" "fog"
Camera "perspective" "float fov" 40
Film "rgb" "integer xresolution" 24 "integer yresolution" 24
PixelFilter "box"
Integrator "path" "integer maxdepth" 5
WorldBegin
AttributeBegin
MediumInterface "" "fog"
LightSource "spot" "rgb I" [9 8 7] "point3 from" [-1.4 0 0] "point3 to" [0 0 0]
  "float coneangle" 24 "float conedeltaangle" 20
AttributeEnd
AttributeBegin
MediumInterface "fog" "fog"
Material "diffuse" "rgb reflectance" [0 0 0]
Shape "bilinearmesh" "point3 P" [-3 -2 -3  3 -2 -3  -3 -2 3  3 -2 3]
AttributeEnd
)";

struct BlurredRender {
  const char* name;
  const std::string& scene;
  const char* integrator;
  double radius;
  const char* setting;  // switched to `value`
  bool value;
  bool isAdaptive;
  // At the start of beams, and beside the apex of a cone, the light is not smooth: less of the bias is seen.
  double leastSlope = 0.8;
  double mostStated = 2.5;  // of the true bias; more where the noise leaves much open
};
void PrintTo(const BlurredRender& of, std::ostream* out) {
  *out << of.name;
}

struct BiasOfRender {
  double slope = 0;   // of the estimated bias over the true one, pixel by pixel
  double size = 0;    // root mean square of the true one, over the mean of the picture
  double stated = 0;  // mean of the bound that the errors have
};

BiasOfRender Measure(const BlurredRender& of) {
  constexpr int kSeeds = 12, kPasses = 32;
  RenderOverrides overrides;
  overrides.values["photons"] = int64_t{3000};
  overrides.values["radius"] = of.radius;
  overrides.values["guide-photons"] = false;
  if (of.setting) overrides.values[of.setting] = of.value;
  if (of.isAdaptive) overrides.adaptive.emplace();
  overrides.integrator = of.integrator;
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  BuiltScene built = BuildScene(ParseScene(of.scene, "test.pbrt", diagnostics), overrides, true, diagnostics);
  RenderOverrides sharp;
  sharp.integrator = "path";
  const Image reference = RenderText(of.scene, 4096, sharp).image;
  const std::unique_ptr<Integrator> integrator = MakeIntegrator(built.scene, built.settings);
  std::vector<double> estimates(reference.data.size()), truths(reference.data.size());
  BiasOfRender result;
  for (int seed = 0; seed < kSeeds; ++seed) {
    built.settings.seed = static_cast<uint64_t>(seed) + 1;
    Film film(built.settings.width, built.settings.height, built.settings.crop);
    ProgressiveRender render(built.scene, *integrator, built.settings, 1, film);
    render.AddSamples(kPasses);
    const Image image = film.Develop();
    for (size_t i = 0; i < film.Pixels(); ++i) {
      for (size_t c = 0; c < 3; ++c) {
        estimates[6 * i + c] += film.Bias(i, static_cast<int>(c)) / kSeeds;
        truths[6 * i + c] += static_cast<double>(image.data[6 * i + c] - reference.data[6 * i + c]) / kSeeds;
      }
    }
    result.stated += film.PartsOfError().bias / kSeeds;
  }
  double products = 0, squares = 0, mean = 0;
  for (size_t i = 0; i < truths.size(); ++i) {
    products += estimates[i] * truths[i];
    squares += truths[i] * truths[i];
    if (i % 6 < 3) mean += static_cast<double>(reference.data[i]);
  }
  const double count = static_cast<double>(truths.size()) / 2;
  result.slope = products / squares;
  result.size = std::sqrt(squares / count) / (mean / count);
  return result;
}

class MergeBiasOfRenders : public testing::TestWithParam<BlurredRender> {};

TEST_P(MergeBiasOfRenders, IsThatOfThePicture) {
  const BiasOfRender measured = Measure(GetParam());
  std::printf("[   info   ] %s: bias %.2f %%, slope of the estimate %.2f, stated %.2f %%\n", GetParam().name,
              100 * measured.size, measured.slope, 100 * measured.stated);
  EXPECT_GT(measured.slope, GetParam().leastSlope);
  EXPECT_LT(measured.slope, 1.2);
  EXPECT_GT(measured.stated, measured.size);
  EXPECT_LT(measured.stated, GetParam().mostStated * measured.size);
}

INSTANTIATE_TEST_SUITE_P(
    Of, MergeBiasOfRenders,
    testing::Values(BlurredRender{"sppm", kFloor, "sppm", 0.4, "direct-photons", true, false},
                    BlurredRender{"sppm_adaptive", kFloor, "sppm", 0.4, "direct-photons", true, true},
                    BlurredRender{"vcm", kFloor, "vcm", 0.4, nullptr, false, false},
                    BlurredRender{"vcm_merging_alone", kFloor, "vcm", 0.4, "connect", false, false},
                    BlurredRender{"vcm_adaptive", kFloor, "vcm", 0.4, "connect", false, true},
                    BlurredRender{"sppm_fog", kFog, "sppm", 0.15, "direct-photons", true, false, 0.7},
                    BlurredRender{"vcm_fog", kFog, "vcm", 0.15, "connect", false, false, 0.4, 4}),
    [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace lampyr::test
