// The phase function of media: its integral, its mean cosine, its samples at the peak, and what a Bsdf makes of it.
#include <gtest/gtest.h>

#include "materials/bsdf.h"
#include "sampling/rng.h"

namespace lampyr::testing {
namespace {

constexpr float kAsymmetries[] = {0,    1e-6f, -1e-6f, 5e-4f,  -5e-4f, 0.1f,   -0.3f,
                                  0.7f, -0.8f, 0.95f,  -0.99f, 0.99f,  0.999f, -0.999f};

Bsdf MediumBsdf(float g) {
  return Bsdf(Frame{}, Normal3(0.0f), PhaseBsdf{Color(0.2f, 0.6f, 1.0f), g});
}

Vector3 DirectionAt(double cosine) {
  return {static_cast<float>(std::sqrt((1 - cosine) * (1 + cosine))), 0, static_cast<float>(cosine)};
}

// Henyey and Greenstein's formula as it is printed, in double.
double Reference(double g, double cosine) {
  return (1 - g * g) / (4 * 3.14159265358979323846 * std::pow(1 + g * g - 2 * g * cosine, 1.5));
}

// The integral over the sphere is 1, and the mean cosine between the directions before and after is g. In z = cosθ with
// z = 1 - x⁴ from the peak, which makes the integrand smooth for all g here.
TEST(Phase, IsNormalizedAndHasItsMeanCosine) {
  for (const float g : kAsymmetries) {
    const Bsdf bsdf = MediumBsdf(g);
    const double sign = g < 0 ? -1 : 1, end = std::pow(2.0, 0.25);
    double integral = 0, mean = 0;
    constexpr int kSteps = 20000;
    for (int i = 0; i < kSteps; ++i) {
      const double x = (i + 0.5) * end / kSteps, cosine = sign * (1 - x * x * x * x);
      // Forward is opposite to wo.
      const auto value = bsdf.Evaluate({0, 0, -1}, DirectionAt(cosine), TransportMode::Radiance);
      const double weight = 4 * x * x * x * (end / kSteps) * 2 * 3.14159265358979323846;
      integral += static_cast<double>(value.pdfForward.value) * weight;
      mean += static_cast<double>(value.pdfForward.value) * cosine * weight;
    }
    EXPECT_NEAR(integral, 1, 1e-4) << g;
    EXPECT_NEAR(mean, static_cast<double>(g), 1e-4) << g;
  }
}

TEST(Phase, IsTheFormula) {
  for (const float g : kAsymmetries) {
    const Bsdf bsdf = MediumBsdf(g);
    for (const double cosine : {-1.0, -0.9999, -0.5, 0.0, 0.3, 0.75, 0.9999, 1.0}) {
      const auto value = bsdf.Evaluate({0, 0, -1}, DirectionAt(cosine), TransportMode::Radiance);
      const double expected = Reference(static_cast<double>(g), cosine);
      EXPECT_NEAR(static_cast<double>(value.pdfForward.value), expected, 1e-3 * expected) << g << " at " << cosine;
      EXPECT_EQ(value.pdfForward.value, value.pdfReverse.value);
      EXPECT_EQ(value.diffuse, Color(0.2f, 0.6f, 1.0f) * value.pdfForward.value);
      EXPECT_TRUE(value.specular.IsBlack());
    }
  }
}

// The cosine below which a fraction u of the samples lies, against the integral of the density in closed form.
TEST(Phase, SamplesInvertTheIntegral) {
  for (const float g : kAsymmetries) {
    const Bsdf bsdf = MediumBsdf(g);
    const double a = std::abs(static_cast<double>(g)), sign = g < 0 ? -1 : 1;
    for (const float u : {0.0f, 1e-4f, 0.1f, 0.5f, 0.9f, 0.9999f, kOneMinusEpsilon}) {
      const auto sample = bsdf.Sample({0, 0, -1}, 0, {u, 0.3f}, TransportMode::Importance);
      ASSERT_TRUE(sample);
      EXPECT_EQ(sample.Weight(), Color(0.2f, 0.6f, 1.0f));
      EXPECT_NEAR(glm::length(sample.wi), 1, 1e-6f);
      // 1 - cosθ from the axis of the lobe, and the part of the lobe within.
      const double t = 0.5 * glm::dot(glm::dvec3(sample.wi) - glm::dvec3(0, 0, sign),
                                      glm::dvec3(sample.wi) - glm::dvec3(0, 0, sign));
      const double within = a < 1e-3
                                ? 0.5 * t + 0.75 * a * t * (2 - t)
                                : (1 - a * a) / (2 * a) * (1 / (1 - a) - 1 / std::sqrt((1 - a) * (1 - a) + 2 * a * t));
      EXPECT_NEAR(within, static_cast<double>(u), 2e-6) << g << " at " << u;
    }
  }
}

TEST(Phase, IsReciprocalToTheLastBit) {
  Rng rng(4);
  for (const float g : kAsymmetries) {
    const Bsdf bsdf = MediumBsdf(g);
    for (int i = 0; i < 500; ++i) {
      const Vector3 wo = SampleUniformSphere(rng.NextPoint2()), wi = SampleUniformSphere(rng.NextPoint2());
      const auto there = bsdf.Evaluate(wo, wi, TransportMode::Radiance);
      const auto back = bsdf.Evaluate(wi, wo, TransportMode::Importance);
      EXPECT_EQ(there.diffuse, back.diffuse);
      EXPECT_EQ(there.pdfForward.value, back.pdfReverse.value);
    }
  }
}

// No frame counts, and no direction is in a plane that would be left out.
TEST(Phase, HasNeitherFrameNorSurface) {
  const PhaseBsdf model{Color(1.0f), 0.4f};
  const Frame frame{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const Bsdf framed(frame, frame.z, model), other(Frame{{0, 0, 1}, {1, 0, 0}, {0, 1, 0}}, {0, 1, 0}, model);
  const Vector3 wo(1, 0, 0);
  for (const Vector3& wi : {Vector3(0, 1, 0), Vector3(-1, 0, 0), Vector3(1, 0, 0), Vector3(0, 0, 1)}) {
    const auto value = framed.Evaluate(wo, wi, TransportMode::Radiance);
    EXPECT_GT(value.diffuse.g, 0);
    EXPECT_EQ(value.diffuse, other.Evaluate(wo, wi, TransportMode::Radiance).diffuse);
    EXPECT_EQ(framed.ScatteringCosine(wi), 1);
    EXPECT_EQ(framed.GeometricCosine(wi), 1);
  }
  const auto sample = framed.Sample(wo, 0.5f, {0.4f, 0.2f}, TransportMode::Radiance);
  ASSERT_TRUE(sample);
  EXPECT_EQ(sample.wi, other.Sample(wo, 0.5f, {0.4f, 0.2f}, TransportMode::Radiance).wi);
  EXPECT_TRUE(framed.IsMedium() && framed.IsTransmissive());
  EXPECT_FALSE(framed.IsDelta() || framed.IsFibre() || framed.GathersPhotons() || sample.isTransmission);
  EXPECT_FALSE(Bsdf(frame, frame.z, DiffuseBsdf{Color(1.0f)}).IsMedium());
}

TEST(Phase, IsFiniteAtTheEdges) {
  for (const float g : {0.0f, 1e-30f, 0.99999f, -0.99999f, kOneMinusEpsilon, -kOneMinusEpsilon}) {
    const Bsdf bsdf = MediumBsdf(g);
    for (const float x : {0.0f, 0.5f, kOneMinusEpsilon}) {
      for (const Vector3& wo : {Vector3(0, 0, 1), Vector3(0, 0, -1), glm::normalize(Vector3(1, 1, 1e-8f))}) {
        const auto sample = bsdf.Sample(wo, x, {x, x}, TransportMode::Radiance);
        ASSERT_TRUE(sample && IsFinite(sample.wi) && sample.pdfForward.value < kInfinity) << g << ", " << x;
        for (const Vector3& wi : {sample.wi, wo, -wo}) {
          const auto value = bsdf.Evaluate(wo, wi, TransportMode::Radiance);
          ASSERT_TRUE(value.diffuse.IsValid() && value.pdfForward.value > 0 && value.pdfForward.value < kInfinity) << g;
        }
      }
    }
  }
}

}  // namespace
}  // namespace lampyr::testing
