// Shadow rays that are traced by chance, or not at all.
#include "integrators/walk/shadow_roulette.h"

#include <gtest/gtest.h>

#include "support/render_scene.h"
#include "support/replicas.h"

namespace lampyr::test {
namespace {

const std::string kScene = R"(LookAt 0 1 -2.9  0 1 0  0 1 0
Camera "perspective" "float fov" 40
Film "rgb" "integer xresolution" 24 "integer yresolution" 24
Integrator "path" "integer maxdepth" 6
WorldBegin
Material "diffuse" "rgb reflectance" [ 0.7 0.6 0.5 ]
Shape "bilinearmesh" "point3 P" [ -1 0 -1  1 0 -1  -1 0 1  1 0 1 ]
Shape "bilinearmesh" "point3 P" [ -1 2 -1  1 2 -1  -1 2 1  1 2 1 ]
Shape "bilinearmesh" "point3 P" [ -1 0 1  1 0 1  -1 2 1  1 2 1 ]
Shape "bilinearmesh" "point3 P" [ -1 0 -1  -1 0 1  -1 2 -1  -1 2 1 ]
Shape "bilinearmesh" "point3 P" [ 1 0 -1  1 0 1  1 2 -1  1 2 1 ]
AttributeBegin Translate 0.3 0.4 0.2 Shape "sphere" "float radius" 0.4 AttributeEnd
AttributeBegin AreaLightSource "diffuse" "rgb L" [ 9 8 7 ]
Shape "bilinearmesh" "point3 P" [ -0.3 1.99 -0.3  -0.3 1.99 0.3  0.3 1.99 -0.3  0.3 1.99 0.3 ] AttributeEnd
LightSource "point" "rgb I" [ 0.02 0.05 0.2 ] "point3 from" [ -0.6 0.5 0.4 ]
)";

Rendered RenderWith(const char* integrator, double roulette, double threshold) {
  RenderOverrides overrides;
  overrides.integrator = integrator;
  overrides.values["shadow-roulette"] = roulette;
  overrides.values["shadow-threshold"] = threshold;
  overrides.values["guide-paths"] = false;  // what paths learn depends on what they find
  return RenderText(kScene, 64, overrides);
}

// By far more roulette than is usual, so that it would be seen.
TEST(ShadowRoulette, LeavesTheMeanAlone) {
  for (const char* integrator : {"path", "bdpt", "vcm", "sppm"}) {
    RenderOverrides all, some;
    all.values["shadow-roulette"] = 0;
    some.values["shadow-roulette"] = 1;
    some.seed = 1000;
    const int samples = std::string(integrator) == "path" ? 64 : 32;
    const Replicas traced = RenderReplicas(kScene, integrator, 12, samples, all);
    const Replicas byChance = RenderReplicas(kScene, integrator, 12, samples, some);
    const Agreement result = CompareReplicas(byChance, traced, 8, 2.5e-4);
    std::printf("%-5s largest |z| %.2f (%.2f), bias %+.3f %% +- %.3f %%\n", integrator, result.largestZ,
                result.thresholdZ, 100 * result.bias, 196 * result.biasError);
    EXPECT_TRUE(result.Agrees()) << integrator;
    EXPECT_FALSE(CompareReplicas(byChance, traced, 8, 2.5e-4, 1.03).Agrees()) << integrator << ": too noisy";
  }
}

TEST(ShadowRoulette, TracesFewerRaysAndAddsLittleNoise) {
  for (const char* integrator : {"path", "bdpt"}) {
    const Rendered all = RenderWith(integrator, 0, 0), usual = RenderWith(integrator, 0.05, 0);
    EXPECT_LT(usual.outcome.counts.shadowRays, 0.98 * static_cast<double>(all.outcome.counts.shadowRays)) << integrator;
    EXPECT_LT(usual.outcome.relativeError, 1.02 * all.outcome.relativeError) << integrator;
  }
}

// The bias of a threshold is negative, and at most the threshold for each omitted ray.
TEST(ShadowRoulette, AThresholdIsABiasThatHasABound) {
  for (const char* integrator : {"path", "bdpt"}) {
    const Rendered all = RenderWith(integrator, 0, 0);
    const double threshold = 0.01;
    const Rendered less = RenderWith(integrator, 0, threshold);
    const auto left = static_cast<double>(all.outcome.counts.shadowRays - less.outcome.counts.shadowRays);
    EXPECT_GT(left, 0.02 * static_cast<double>(all.outcome.counts.shadowRays)) << integrator;
    double lost = 0, total = 0;
    for (int y = 0; y < 24; ++y) {
      for (int x = 0; x < 24; ++x) {
        EXPECT_LE(less.image.At(x, y, 1), all.image.At(x, y, 1) * 1.00001f);
        lost += static_cast<double>(all.image.At(x, y, 1) - less.image.At(x, y, 1)) * 64;
        total += static_cast<double>(all.image.At(x, y, 1)) * 64;
      }
    }
    EXPECT_GT(lost, 1e-4 * total) << integrator;
    EXPECT_LE(lost, threshold * left) << integrator;
  }
}

// In the image's units: of a film that is twice as sensitive, twice as much.
TEST(ShadowRoulette, TheThresholdIsOfTheImage) {
  std::string sensitive = kScene;
  const std::string size = "\"integer yresolution\" 24";
  sensitive.replace(sensitive.find(size), size.size(), size + " \"float iso\" 200");
  for (const char* integrator : {"path", "bdpt", "sppm"}) {
    const auto rays = [&](const std::string& text, double threshold) {
      RenderOverrides overrides;
      overrides.integrator = integrator;
      overrides.values["shadow-threshold"] = threshold;
      return RenderText(text, 8, overrides).outcome.counts.shadowRays;
    };
    EXPECT_EQ(rays(kScene, 0.01), rays(sensitive, 0.02)) << integrator;
    EXPECT_LT(rays(kScene, 0.01), rays(sensitive, 0.01)) << integrator;
  }
}

TEST(ShadowRoulette, WorthIsOneInTheMean) {
  const ShadowRays rays{0.5f, 0};
  for (const float value : {0.01f, 0.1f, 0.3f, 0.49f, 0.5f, 3.0f}) {
    double sum = 0;
    constexpr int count = 200000;
    for (uint64_t i = 0; i < count; ++i)
      sum += static_cast<double>(rays.SurvivalWeight(Color(value), Color(1.0f), i)) / count;
    const double p = std::min(static_cast<double>(value) / 0.5, 1.0);
    EXPECT_NEAR(sum, 1, 4.5 * std::sqrt((1 / p - 1) / count) + 1e-6) << value;
  }
  EXPECT_EQ(rays.SurvivalWeight(Color(1e-9f), Color(0.0f), 3), 1) << "nothing has been gathered to compare with";
}

}  // namespace
}  // namespace lampyr::test
