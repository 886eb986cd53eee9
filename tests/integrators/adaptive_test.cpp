// Adaptive sampling in every integrator that follows camera paths: its picture is unbiased, it states its variance, and
// it pays.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "support/replicas.h"

namespace lampyr::test {
namespace {

// A lamp behind glass and a bright corner: some of the picture is hardly noisy, some is very much so.
constexpr const char* kScene = R"(LookAt 0 2.2 3  0 0.4 0  0 1 0
Film "rgb" "integer xresolution" 24 "integer yresolution" 24
Camera "perspective" "float fov" 42
Integrator "path" "integer maxdepth" 6
WorldBegin
LightSource "infinite" "rgb L" [0.05 0.05 0.1]
AttributeBegin
AreaLightSource "diffuse" "rgb L" [30 25 20]
Translate 1.2 1.4 -0.6 Shape "sphere" "float radius" 0.08
AttributeEnd
Material "diffuse" "rgb reflectance" [0.6 0.5 0.4]
Shape "trianglemesh" "point3 P" [-3 0 -3  -3 0 3  3 0 3  3 0 -3] "integer indices" [0 1 2 0 2 3]
AttributeBegin
Material "dielectric" "float eta" 1.5
Translate 0 0.6 0 Shape "sphere" "float radius" 0.5
AttributeEnd
)";

class Adaptive : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(With, Adaptive, testing::Values("path", "bdpt", "vcm", "sppm", "auto"),
                         [](const auto& info) { return info.param; });

RenderOverrides Adaptively() {
  RenderOverrides overrides;
  overrides.adaptive.emplace();
  return overrides;
}

// 20 seeds. With 400, path has -0.06 % ± 0.23 %, bdpt 0.10 % ± 0.12 %, auto 0.14 % ± 0.09 %.
TEST_P(Adaptive, IsUnbiased) {
  constexpr int kSeeds = 20, kSamples = 32;
  const Replicas adaptive = RenderReplicas(kScene, GetParam(), kSeeds, kSamples, Adaptively());
  RenderOverrides others;
  others.seed = 1000;
  const Replicas uniform = RenderReplicas(kScene, GetParam(), 2 * kSeeds, kSamples, others);
  const Agreement agreement = CompareReplicas(adaptive, uniform, 6, 1e-3);
  EXPECT_TRUE(agreement.Agrees()) << "largest z " << agreement.largestZ << " of " << agreement.thresholdZ << ", mean "
                                  << agreement.meanZ << ", χ² " << agreement.chiSquared << " of "
                                  << agreement.chiSquaredThreshold;
  std::printf("[   info   ] %s: %.2f %% ± %.2f %%\n", GetParam().c_str(), 100 * agreement.bias,
              100 * agreement.biasError);
  EXPECT_EQ(adaptive.faults, 0u);
}

// Photons share the time of their pass. The times of all passes are stratified, and not those of each stage alone, with
// which the streak of the lamp has ten times the variance.
TEST(AdaptiveSampling, OfWhatMovesIsNotNoisierWithPhotons) {
  constexpr const char* kMoving = R"(LookAt 0 2 -4  0 0.3 0  0 1 0
Film "rgb" "integer xresolution" 12 "integer yresolution" 12
PixelFilter "box"
Camera "perspective" "float fov" 50
Integrator "vcm" "integer maxdepth" 3 "float radius" 0.05 "float alpha" 1
WorldBegin
AttributeBegin
ActiveTransform StartTime Translate -1.5 0.6 0 ActiveTransform EndTime Translate 1.5 0.6 0 ActiveTransform All
AreaLightSource "diffuse" "rgb L" [6 5 4] Material "diffuse" "rgb reflectance" [0 0 0]
Shape "sphere" "float radius" 0.1
AttributeEnd
Material "diffuse" "rgb reflectance" [0.6 0.5 0.4]
Shape "trianglemesh" "point3 P" [-5 0 -5  5 0 -5  5 0 5  -5 0 5] "integer indices" [0 1 2 0 2 3]
)";
  const auto variance = [&](const RenderOverrides& overrides) {
    const Replicas replicas = RenderReplicas(kMoving, "vcm", 16, 64, overrides);
    double sum = 0;
    for (int y = 0; y < 12; ++y) {
      for (int x = 0; x < 12; ++x)
        sum += replicas_internal::MomentsOf(replicas_internal::Means(replicas, 1, x, y, x + 1, y + 1)).variance;
    }
    return sum;
  };
  const double adaptive = variance(Adaptively()), uniform = variance({});
  std::printf("[   info   ] variance, adaptive over uniform: %.2f\n", adaptive / uniform);
  EXPECT_LT(adaptive, 2.5 * uniform);
}

// Weights of filters with negative lobes do not have one sign: stages of one sample in a pixel are no ratio by
// themselves.
TEST(AdaptiveSampling, IsUnbiasedWithNegativeWeights) {
  std::string text = kScene;
  text.replace(text.find("Camera"), 6, "PixelFilter \"mitchell\"\nCamera");
  RenderOverrides uniform, adaptive = Adaptively();
  uniform.seed = 1000;
  for (const char* integrator : {"path", "bdpt"}) {
    const Agreement agreement = CompareReplicas(RenderReplicas(text, integrator, 24, 16, adaptive),
                                                RenderReplicas(text, integrator, 48, 16, uniform), 12, 1e-3);
    EXPECT_TRUE(agreement.Agrees()) << integrator << ": " << agreement.bias << " ± " << agreement.biasError;
    std::printf("[   info   ] %s: %.2f %% ± %.2f %%\n", integrator, 100 * agreement.bias, 100 * agreement.biasError);
  }
}

// The samples of a crop are divided among its pixels; light paths of the rest go on.
TEST(AdaptiveSampling, ACropAgrees) {
  RenderOverrides uniform, adaptive = Adaptively();
  uniform.crop = adaptive.crop = "4,20,5,17";
  uniform.seed = 1000;
  for (const char* integrator : {"path", "bdpt", "vcm", "sppm"}) {
    const Agreement agreement = CompareReplicas(RenderReplicas(kScene, integrator, 24, 16, adaptive),
                                                RenderReplicas(kScene, integrator, 48, 16, uniform), 6, 1e-3);
    EXPECT_TRUE(agreement.Agrees()) << integrator << ": " << agreement.bias << " ± " << agreement.biasError;
    Diagnostics diagnostics(Diagnostics::Mode::Collect);
    adaptive.integrator = integrator;
    const BuiltScene built = BuildScene(ParseScene(kScene, "test.pbrt", diagnostics), adaptive, true, diagnostics);
    EXPECT_EQ(RenderBuilt(built, 13, 3).image.data, RenderBuilt(built, 13, 1).image.data) << integrator;
  }
}

// Mean and variance of the green channel of each pixel over the replicas.
struct PixelMoments {
  double mean = 0, variance = 0;
};
std::vector<PixelMoments> MomentsOfPixels(const Replicas& replicas) {
  const Image& first = replicas.images[0];
  const double n = static_cast<double>(replicas.images.size());
  std::vector<PixelMoments> moments;
  for (int y = 0; y < first.height; ++y) {
    for (int x = 0; x < first.width; ++x) {
      double sum = 0, squares = 0;
      for (const Image& image : replicas.images) {
        const auto value = static_cast<double>(image.At(x, y, 1));
        sum += value;
        squares += value * value;
      }
      moments.push_back({sum / n, std::max(squares - sum * sum / n, 0.0) / (n - 1)});
    }
  }
  return moments;
}

// Sums over pixels of the variance as it is, and as it is stated.
std::pair<double, double> VarianceOf(const Replicas& replicas) {
  const size_t variance = static_cast<size_t>(replicas.images[0].ChannelIndex("variance.G"));
  const double n = static_cast<double>(replicas.images.size());
  double measured = 0, stated = 0;
  for (const PixelMoments& pixel : MomentsOfPixels(replicas)) measured += pixel.variance;
  for (const Image& image : replicas.images) {
    for (size_t i = variance; i < image.data.size(); i += image.channels.size())
      stated += static_cast<double>(image.data[i]) / n;
  }
  return {measured, stated};
}

// With independent samples, whose variance is not overstated as that of stratified ones is. Rare bright samples make
// most of it: fewer replicas would not do.
TEST_P(Adaptive, StatesItsVariance) {
  RenderOverrides overrides = Adaptively();
  overrides.sampler = "independent";
  const auto [measured, stated] = VarianceOf(RenderReplicas(kScene, GetParam(), 120, 64, overrides));
  EXPECT_NEAR(stated / measured, 1, 0.25);
  std::printf("[   info   ] %s: stated %.2f of the variance\n", GetParam().c_str(), stated / measured);
}

// Sky in two thirds of the picture, without noise; penumbras below it.
constexpr const char* kPenumbras = R"(LookAt 0 1 4  0 1.4 0  0 1 0
Film "rgb" "integer xresolution" 32 "integer yresolution" 32
PixelFilter "box"
Camera "perspective" "float fov" 60
Integrator "path" "integer maxdepth" 3
WorldBegin
LightSource "infinite" "rgb L" [0.5 0.5 0.5]
AttributeBegin
AreaLightSource "diffuse" "rgb L" [3 3 3]
Shape "trianglemesh" "point3 P" [-4 5 -4  4 5 -4  4 5 4  -4 5 4] "integer indices" [0 1 2 0 2 3]
AttributeEnd
Material "diffuse" "rgb reflectance" [0.5 0.5 0.5]
Shape "trianglemesh" "point3 P" [-9 0 -9  -9 0 4  9 0 4  9 0 -9] "integer indices" [0 1 2 0 2 3]
AttributeBegin Translate -0.7 0.3 0 Shape "sphere" "float radius" 0.3 AttributeEnd
AttributeBegin Translate 0.7 0.3 0 Shape "sphere" "float radius" 0.3 AttributeEnd
)";

// The error that 95 % of the pixels are below, as it is, over seeds.
TEST(AdaptiveSampling, Pays) {
  const auto error = [](const RenderOverrides& overrides) {
    std::vector<double> errors;
    for (const PixelMoments& pixel : MomentsOfPixels(RenderReplicas(kPenumbras, "path", 24, 64, overrides)))
      errors.push_back(std::sqrt(pixel.variance) / pixel.mean);
    std::sort(errors.begin(), errors.end());
    return errors[errors.size() * 95 / 100];
  };
  const double gain = std::pow(error({}) / error(Adaptively()), 2);
  std::printf("[   info   ] samples for the same error of 95 %% of the pixels: %.2f x fewer\n", gain);
  EXPECT_GT(gain, 1.15);
}

// A film after a stage whose left half has no noise.
Film HalfNoisy(const SampleStage& stage, int width, int height) {
  Film film(width, height, {0, 0, width, height});
  film.MakeAdaptive(false);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (uint32_t i = 0; i < stage.before; ++i)
        film.Pixel(x, y).Add(Color(x < width / 2 || i % 2 == 0 ? 2.0f : 0.5f), 1);
    }
  }
  film.CountPasses(stage.before);
  film.EndStage();
  return film;
}

TEST(AdaptiveSampling, EachPassHasAsManySamplesAsPixels) {
  constexpr int kWidth = 60, kHeight = 12, kPixels = kWidth * kHeight;
  const SampleStage stage = StageOf(16, 0, 5);
  EXPECT_EQ(stage.first, 16u);
  EXPECT_EQ(stage.passes, 16u);
  const Film film = HalfNoisy(stage, kWidth, kHeight);
  const SampleAllocation allocation(stage, film, {});
  std::vector<uint32_t> counts(kPixels, 0);
  for (uint32_t pass = 0; pass < stage.passes; ++pass) {
    uint64_t slot = 0;
    for (size_t pixel = 0; pixel < kPixels; ++pixel) {
      const uint32_t count = allocation.Count(pixel, pass);
      if (pass == 0) {
        EXPECT_EQ(count, 1u);
      }
      for (uint32_t k = 0; k < count; ++k, ++slot) EXPECT_EQ(allocation.PixelOf(slot, pass), pixel);
      counts[pixel] += count;
    }
    EXPECT_EQ(slot, static_cast<uint64_t>(kPixels));
  }
  const std::vector<double> wanted = WantedSamples(film, stage, {});
  EXPECT_NEAR(std::accumulate(wanted.begin(), wanted.end(), 0.0), 16 * kPixels, 1e-6 * 16 * kPixels);
  for (size_t pixel = 0; pixel < kPixels; ++pixel) {
    const auto x = static_cast<int>(pixel % kWidth);
    if (x < kWidth / 4) {
      EXPECT_LT(counts[pixel], 12u) << pixel;
    } else if (x > kWidth * 3 / 4) {
      EXPECT_GT(counts[pixel], 18u) << pixel;
    }
    EXPECT_NEAR(counts[pixel], wanted[pixel], 1);
  }
}

TEST(AdaptiveSampling, StagesHaveNumbersOfTheirOwn) {
  std::vector<uint64_t> seeds;
  uint32_t last = 1;
  for (uint32_t pass = 0; pass < 1000; ++pass) {
    const SampleStage stage = StageOf(pass, 0, 7);
    EXPECT_LE(stage.before, pass);
    EXPECT_LT(pass, stage.before + stage.passes);
    if (stage.first == last) continue;
    last = stage.first;
    seeds.push_back(stage.seed);
    // Another part of a render.
    seeds.push_back(StageOf(pass, 5000, 7).seed);
  }
  EXPECT_EQ(seeds[0], 7u) << "the first stage is that of a render that is not adaptive";
  std::sort(seeds.begin(), seeds.end());
  EXPECT_EQ(std::adjacent_find(seeds.begin(), seeds.end()), seeds.end());
}

// One bright sample tells nothing of the pixels around it: their numbers of samples hardly change.
TEST(AdaptiveSampling, OneSampleDoesNotDecide) {
  constexpr int kSide = 40;
  const SampleStage stage = StageOf(16, 0, 5);
  Film film(kSide, kSide, {0, 0, kSide, kSide});
  film.MakeAdaptive(false);
  for (int i = 0; i < kSide * kSide; ++i) {
    for (int k = 0; k < 16; ++k)
      film.Pixel(i % kSide, i / kSide).Add(Color(i == 820 && k == 3 ? 1e3f : k % 2 == 0 ? 1.0f : 3.0f), 1);
  }
  film.CountPasses(16);
  film.EndStage();
  const std::vector<double> wanted = WantedSamples(film, stage, {});
  const auto [least, most] = std::minmax_element(wanted.begin(), wanted.end());
  EXPECT_LT(*most, 20);
  EXPECT_GE(*least, 12);
  std::printf("[   info   ] at most %.1f samples, at least %.1f, 16 on average\n", *most, *least);
}

// Edges are one pixel wide. Samples go to their noise, which a mean over neighbours would halve, and by their own
// luminance, which is not that of the surfaces beside them.
TEST(AdaptiveSampling, NoiseOfALineIsThatOfItsPixels) {
  constexpr int kSide = 40, kLine = 20, kSamples = 64;
  const SampleStage stage = StageOf(kSamples, 0, 5);
  Film film(kSide, kSide, {0, 0, kSide, kSide});
  film.MakeAdaptive(false);
  for (int i = 0; i < kSide * kSide; ++i) {
    const bool isLine = i % kSide == kLine;
    for (int k = 0; k < kSamples; ++k) {
      const float deviation = k % 2 == 0 ? 0.5f : -0.5f;
      film.Pixel(i % kSide, i / kSide).Add(Color(isLine ? 1 + deviation : 2 + deviation), 1);
    }
  }
  film.CountPasses(kSamples);
  film.EndStage();
  AdaptiveSettings all;
  all.share = 1;
  const std::vector<double> wanted = WantedSamples(film, stage, all);
  const auto of = [&](int x) { return wanted[static_cast<size_t>(kSide / 2 * kSide + x)]; };
  const double line = of(kLine), beside = of(kLine - 1), far = of(kLine - 10);
  std::printf("[   info   ] on the line %.0f, beside it %.0f, elsewhere %.0f\n", line, beside, far);
  // Four times the relative variance of elsewhere, with an equal number of samples so far.
  EXPECT_GT(line, 5 * far);
  EXPECT_GT(line, 2 * beside);
}

}  // namespace
}  // namespace lampyr::test
