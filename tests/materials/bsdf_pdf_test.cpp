// Sampling against densities: for every model and direction, the histogram of samples, the value and the densities that
// Sample reports, and the reverse densities.
#include <gtest/gtest.h>

#include "materials/model_table.h"
#include "support/chi_squared.h"

namespace lampyr::testing {
namespace {

bool Near(float a, float b, float tolerance) {
  return std::abs(a - b) <= tolerance * std::max(std::abs(a), std::abs(b));
}
bool Near(const Color& a, const Color& b, float tolerance) {
  return Near(a.r, b.r, tolerance) && Near(a.g, b.g, tolerance) && Near(a.b, b.b, tolerance);
}

TEST(ChiSquared, TailMatchesTables) {
  EXPECT_NEAR(ChiSquaredTail(3.841459, 1), 0.05, 1e-6);
  EXPECT_NEAR(ChiSquaredTail(124.3421, 100), 0.05, 1e-6);
  EXPECT_NEAR(ChiSquaredTail(9.210340, 2), 0.01, 1e-7);
}

TEST(ChiSquared, FindsAWrongDensity) {
  Rng rng(1);
  const auto draw = [&]() -> std::optional<Vector3> { return SampleCosineHemisphere(rng.NextPoint2()); };
  const auto right = [](const Vector3& v) { return std::max(0.0, static_cast<double>(v.z)) / 3.14159265358979; };
  const auto wrong = [](const Vector3& v) {
    return v.z > 0 ? (0.9 * static_cast<double>(v.z) + 0.05) / 3.14159265358979 : 0.0;
  };
  EXPECT_GT(ChiSquaredTestDirections(draw, right).pValue, 1e-3);
  EXPECT_LT(ChiSquaredTestDirections(draw, wrong).pValue, 1e-6);
}

TEST(BsdfPdf, SampledDirectionsFollowTheDensity) {
  ModelTables tables;
  const auto models = AllModels(tables);
  const auto directions = LocalDirections();
  const double level = SidakLevel(static_cast<int>(models.size() * directions.size()));
  int cases = 0;
  for (const TestModel& model : models) {
    const Bsdf bsdf = MakeBsdf(model.model);
    if (bsdf.IsDelta()) continue;
    for (const Vector3& local : directions) {
      const Frame& frame = bsdf.ShadingFrame();
      const Vector3 wo = frame.ToWorld(local);
      Rng rng(42 + static_cast<uint64_t>(cases));
      const auto result = ChiSquaredTestDirections(
          [&]() -> std::optional<Vector3> {
            const float uLobe = rng.NextFloat();
            const auto sample = bsdf.Sample(wo, uLobe, rng.NextPoint2(), TransportMode::Radiance);
            if (!sample || sample.isDelta) return std::nullopt;
            return frame.ToLocal(sample.wi);
          },
          [&](const Vector3& wi) {
            return static_cast<double>(bsdf.Evaluate(wo, frame.ToWorld(wi), TransportMode::Radiance).pdfForward.value);
          });
      EXPECT_GT(result.pValue, level) << model.name << " from z = " << local.z << ": integral " << result.integral
                                      << ", sampled " << result.sampledFraction;
      EXPECT_LE(result.integral, 1.003) << model.name << " from z = " << local.z;
      EXPECT_NEAR(result.integral, result.sampledFraction, 0.02) << model.name << " from z = " << local.z;
      ++cases;
    }
  }
  std::printf("           %d cases\n", cases);
}

TEST(BsdfPdf, SampleReportsWhatEvaluateSays) {
  ModelTables tables;
  int compared = 0;
  for (const TestModel& model : AllModels(tables)) {
    const Bsdf bsdf = MakeBsdf(model.model);
    Rng rng(7);
    for (const Vector3& local : LocalDirections()) {
      const Vector3 wo = bsdf.ShadingFrame().ToWorld(local);
      for (int i = 0; i < 400; ++i) {
        const TransportMode mode = i % 2 ? TransportMode::Radiance : TransportMode::Importance;
        const float uLobe = rng.NextFloat();
        const auto sample = bsdf.Sample(wo, uLobe, rng.NextPoint2(), mode);
        if (!sample) continue;
        EXPECT_NEAR(glm::length(sample.wi), 1, 1e-6f) << model.name;
        const bool isAcross = glm::dot(sample.wi, bsdf.ShadingFrame().z) * local.z < 0;
        EXPECT_EQ(sample.isTransmission, isAcross && !bsdf.IsMedium()) << model.name;
        const BsdfEvaluation value = bsdf.Evaluate(wo, sample.wi, mode);
        if (sample.isDelta) {
          EXPECT_GT(sample.pdfForward.value, 0) << model.name;
          EXPECT_LE(sample.pdfForward.value, 1) << model.name;
          continue;
        }
        const float cosine = bsdf.ScatteringCosine(sample.wi);
        if (cosine < 1e-3f) continue;  // a rounded direction says little about so small a cosine
        const float tolerance = model.tolerance;
        EXPECT_TRUE(Near(value.pdfForward.value, sample.pdfForward.value, tolerance))
            << model.name << ": " << value.pdfForward.value << " against " << sample.pdfForward.value;
        EXPECT_TRUE(Near(value.pdfReverse.value, sample.pdfReverse.value, tolerance)) << model.name;
        const float scale = cosine / value.pdfForward.value;
        EXPECT_TRUE(Near(value.diffuse * scale, sample.weightDiffuse, tolerance)) << model.name;
        EXPECT_TRUE(Near(value.specular * scale, sample.weightSpecular, tolerance))
            << model.name << ": " << value.specular.g * scale << " against " << sample.weightSpecular.g;
        ++compared;
      }
    }
  }
  EXPECT_GT(compared, 20000);
}

// The reverse density is the forward one of a path of the other mode with the directions exchanged, for deltas too.
TEST(BsdfPdf, ReverseIsForwardExchanged) {
  ModelTables tables;
  for (const TestModel& model : AllModels(tables)) {
    const Bsdf bsdf = MakeBsdf(model.model);
    Rng rng(11);
    for (int i = 0; i < 500; ++i) {
      const Vector3 wo = SampleUniformSphere(rng.NextPoint2());
      const float uLobe = rng.NextFloat();
      const Point2 u = rng.NextPoint2();
      const auto sample = bsdf.Sample(wo, uLobe, u, TransportMode::Radiance);
      const Vector3 wi = sample && i % 2 ? sample.wi : SampleUniformSphere(rng.NextPoint2());
      if (AbsDot(wi, bsdf.ShadingFrame().z) < 1e-3f || AbsDot(wo, bsdf.ShadingFrame().z) < 1e-3f) continue;
      const auto there = bsdf.Evaluate(wo, wi, TransportMode::Radiance);
      const auto back = bsdf.Evaluate(wi, wo, TransportMode::Importance);
      EXPECT_TRUE(Near(there.pdfReverse.value, back.pdfForward.value, model.tolerance)) << model.name;
      EXPECT_TRUE(Near(there.pdfForward.value, back.pdfReverse.value, model.tolerance)) << model.name;
      if (!sample || !sample.isDelta) continue;
      const float reverseLobe = sample.isTransmission ? kOneMinusEpsilon : 0.0f;
      const auto reverse = bsdf.Sample(sample.wi, reverseLobe, u, TransportMode::Radiance);
      ASSERT_TRUE(reverse && reverse.isDelta) << model.name;
      EXPECT_LT(glm::length(reverse.wi - wo), 2e-3f) << model.name;
      EXPECT_TRUE(Near(reverse.pdfForward.value, sample.pdfReverse.value, 2e-2f)) << model.name;
    }
  }
}

}  // namespace
}  // namespace lampyr::testing
