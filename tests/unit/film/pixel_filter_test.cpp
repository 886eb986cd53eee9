// Reconstruction filters: samples against values, weights of mean 1, moments, pbrt-v4's shapes.
#include "film/pixel_filter.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "sampling/sampler.h"

namespace lampyr {
namespace {

using Kind = PixelFilterSettings::Kind;

double Double(float v) {
  return static_cast<double>(v);
}

PixelFilterSettings Settings(Kind kind, float radiusX, float radiusY) {
  PixelFilterSettings settings;
  settings.kind = kind;
  settings.radiusX = radiusX;
  settings.radiusY = radiusY;
  return settings;
}

std::vector<PixelFilterSettings> AllSettings() {
  return {Settings(Kind::Box, 0.5f, 0.5f), Settings(Kind::Box, 1.2f, 0.3f),      Settings(Kind::Triangle, 2, 2),
          Settings(Kind::Triangle, 1, 3),  Settings(Kind::Gaussian, 1.5f, 1.5f), Settings(Kind::Gaussian, 2, 0.7f),
          Settings(Kind::Mitchell, 2, 2),  Settings(Kind::Mitchell, 1.5f, 3),    Settings(Kind::Sinc, 4, 4),
          Settings(Kind::Sinc, 2.5f, 3)};
}

TEST(PixelFilter, ValuesIntegrateToOne) {
  for (const PixelFilterSettings& settings : AllSettings()) {
    const PixelFilter filter(settings);
    constexpr int kSteps = 600;
    double sum = 0;
    for (int i = 0; i < kSteps * kSteps; ++i) {
      const float x = settings.radiusX * (2 * (static_cast<float>(i % kSteps) + 0.5f) / kSteps - 1);
      const float y = settings.radiusY * (2 * (static_cast<float>(i / kSteps) + 0.5f) / kSteps - 1);
      sum += Double(filter.Evaluate({x, y}));
    }
    sum *= 4 * Double(settings.radiusX) * Double(settings.radiusY) / (kSteps * kSteps);
    EXPECT_NEAR(sum, 1, 1e-4) << static_cast<int>(settings.kind);
    EXPECT_EQ(filter.Evaluate({settings.radiusX * 1.001f, 0}), 0.0f);
    EXPECT_EQ(filter.Evaluate({0, settings.radiusY * -1.001f}), 0.0f);
  }
}

// A splat of value 1 at a random place adds the filter's value there to a pixel; so many samples, of which each has
// its weight alone, have the same variance.
TEST(PixelFilter, SplatsAreWorthTheirSquares) {
  for (const PixelFilterSettings& settings : AllSettings()) {
    const PixelFilter filter(settings);
    constexpr uint32_t kCount = 1u << 18;
    Sampler sampler(SamplerKind::Sobol, 1);
    double splats = 0, samples = 0;
    for (uint32_t i = 0; i < kCount; ++i) {
      sampler.StartPixelSample(0, 0, i);
      const Point2 u = sampler.Get2D();
      const float value = filter.Evaluate({settings.radiusX * (2 * u.x - 1), settings.radiusY * (2 * u.y - 1)});
      splats += Double(value) * Double(value) / kCount;
      const float weight = filter.Sample(u).weight;
      samples += Double(weight) * Double(weight) / kCount;
    }
    splats *= 4 * Double(settings.radiusX) * Double(settings.radiusY);
    EXPECT_NEAR(filter.SplatCount() * splats / samples, 1, 5e-3) << static_cast<int>(settings.kind);
    EXPECT_NEAR(filter.SquaredWeight() / samples, 1, 5e-3) << static_cast<int>(settings.kind);
  }
}

// Weighted samples reproduce integrals against the filter: weight's mean, moments, and a block histogram.
TEST(PixelFilter, SamplesFollowTheFilter) {
  constexpr uint32_t kCount = 1u << 18;
  constexpr int kBlocks = 12, kSub = 40;
  for (const PixelFilterSettings& settings : AllSettings()) {
    const PixelFilter filter(settings);
    std::vector<double> sampled(kBlocks * kBlocks), expected(kBlocks * kBlocks);
    double mean = 0, meanX = 0, squareX = 0, squareY = 0, expectedX = 0, expectedY = 0;
    Sampler sampler(SamplerKind::Sobol, 1);
    for (uint32_t i = 0; i < kCount; ++i) {
      sampler.StartPixelSample(0, 0, i);
      const PixelFilter::Offset o = filter.Sample(sampler.Get2D());
      const double x = Double(o.offset.x / settings.radiusX), y = Double(o.offset.y / settings.radiusY);
      ASSERT_TRUE(std::abs(x) <= 1 && std::abs(y) <= 1);
      const double w = Double(o.weight) / kCount;
      if (settings.kind <= Kind::Gaussian) {
        ASSERT_EQ(o.weight, 1.0f);
      }
      mean += w;
      meanX += w * x;
      squareX += w * x * x;
      squareY += w * y * y;
      const int bx = std::min(static_cast<int>((x + 1) / 2 * kBlocks), kBlocks - 1);
      const int by = std::min(static_cast<int>((y + 1) / 2 * kBlocks), kBlocks - 1);
      sampled[static_cast<size_t>(by * kBlocks + bx)] += w;
    }
    constexpr int kSteps = kBlocks * kSub;
    for (int i = 0; i < kSteps * kSteps; ++i) {
      const int column = i % kSteps, row = i / kSteps;
      const double x = 2 * (column + 0.5) / kSteps - 1, y = 2 * (row + 0.5) / kSteps - 1;
      const Vector2 offset(settings.radiusX * static_cast<float>(x), settings.radiusY * static_cast<float>(y));
      const double w =
          Double(filter.Evaluate(offset)) * 4 * Double(settings.radiusX * settings.radiusY) / (kSteps * kSteps);
      expected[static_cast<size_t>(row / kSub * kBlocks + column / kSub)] += w;
      expectedX += w * x * x;
      expectedY += w * y * y;
    }
    EXPECT_NEAR(mean, 1, 1e-3) << static_cast<int>(settings.kind);
    EXPECT_NEAR(meanX, 0, 1e-3);
    EXPECT_NEAR(squareX, expectedX, 1e-3);
    EXPECT_NEAR(squareY, expectedY, 1e-3);
    for (size_t i = 0; i < sampled.size(); ++i)
      EXPECT_NEAR(sampled[i], expected[i], 5e-4) << static_cast<int>(settings.kind);
  }
}

TEST(PixelFilter, ShapesAreThoseOfPbrt) {
  const auto ratio = [](const PixelFilterSettings& settings, float x) {
    const PixelFilter filter(settings);
    return Double(filter.Evaluate({x, 0})) / Double(filter.Evaluate({0, 0}));
  };
  const auto gaussian = [](double x) { return std::exp(-2 * x * x) - std::exp(-2 * 1.5 * 1.5); };
  EXPECT_NEAR(ratio(Settings(Kind::Gaussian, 1.5f, 1.5f), 0.7f), gaussian(0.7) / gaussian(0), 1e-6);
  EXPECT_NEAR(ratio(Settings(Kind::Triangle, 2, 2), 0.5f), 0.75, 1e-6);
  // Mitchell with B = C = 1/3 and radius 2: 8/9 at 0 and 1/18 at 1.
  EXPECT_NEAR(ratio(Settings(Kind::Mitchell, 2, 2), 1.0f), (1.0 / 18) / (8.0 / 9), 1e-6);
  const double pi = 3.14159265358979323846;
  EXPECT_NEAR(ratio(Settings(Kind::Sinc, 4, 4), 1.5f),
              std::sin(1.5 * pi) / (1.5 * pi) * std::sin(0.5 * pi) / (0.5 * pi), 1e-6);
}

// exp(-r²/2σ²) is 0 there.
TEST(PixelFilter, AGaussianMayBeFarNarrowerThanItsRadius) {
  for (const float sigma : {0.079f, 0.03f, 0.01f}) {
    PixelFilterSettings settings = Settings(Kind::Gaussian, 3, 3);
    settings.sigma = sigma;
    const PixelFilter filter(settings);
    const double peak = 1 / (2 * 3.14159265358979 * std::pow(static_cast<double>(sigma), 2));
    EXPECT_NEAR(static_cast<double>(filter.Evaluate({0, 0})), peak, 1e-3 * peak);
    double squares = 0;
    constexpr int n = 4096;
    for (int i = 0; i < n; ++i)
      squares += std::pow(static_cast<double>(filter.Sample({(static_cast<float>(i) + 0.5f) / n, 0.5f}).offset.x), 2);
    EXPECT_NEAR(std::sqrt(squares / n), static_cast<double>(sigma), 0.01 * static_cast<double>(sigma));
  }
}

TEST(PixelFilter, SettingsThatMakeNoFilterAreErrors) {
  EXPECT_THROW(PixelFilter(Settings(Kind::Box, 0, 1)), Error);
  EXPECT_THROW(PixelFilter(Settings(Kind::Gaussian, 1, -1)), Error);
  EXPECT_THROW(PixelFilter(Settings(Kind::Sinc, kInfinity, 1)), Error);
  PixelFilterSettings settings;
  settings.sigma = 0;
  EXPECT_THROW(PixelFilter{settings}, Error);
  settings.sigma = 100;  // nearly a parabola
  EXPECT_NEAR(PixelFilter(settings).Evaluate({0, 0}), Sqr(0.5f), 1e-3f);
}

}  // namespace
}  // namespace lampyr
