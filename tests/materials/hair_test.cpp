// Hair: its lobes against what is known of them, energy, fibres as seen from both ends of a path, and extremes.
#include <gtest/gtest.h>

#include <cmath>

#include "materials/fresnel.h"
#include "materials/model_table.h"
#include "support/chi_squared.h"

namespace lampyr::testing {
namespace {

const Frame kAxes{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
constexpr auto kRadiance = TransportMode::Radiance, kImportance = TransportMode::Importance;

struct Fibre {
  Color sigmaA;
  float eta = 1.55f, betaM = 0.3f, betaN = 0.3f, alpha = 2, h = 0;

  HairBsdf Make() const {
    HairBsdf hair(sigmaA, eta, betaM, betaN, alpha);
    hair.offset = h;
    hair.followsRay = hair.isFibre = true;
    return hair;
  }
};

Bsdf InAxes(const HairBsdf& hair) {
  return Bsdf(kAxes, {0, 0, 1}, hair);
}

// Direction at angle θ to the plane across the fibre, φ from y towards z.
Vector3 At(double theta, double phi) {
  return Vector3(Vector3d(std::sin(theta), std::cos(theta) * std::cos(phi), std::cos(theta) * std::sin(phi)));
}

struct Integral {
  double scattered = 0, density = 0;
};

// ∫ f C dωi and the integral of the density, by the trapezium rule in φ and the midpoint rule in sinθ, each on a grid
// that resolves the lobes.
Integral Integrate(const Bsdf& bsdf, const Vector3& wo, int alongSteps, int aroundSteps) {
  Integral sum;
  constexpr double kTurn = 2 * 3.14159265358979323846;
  for (int i = 0; i < alongSteps; ++i) {
    const double theta = std::asin((2.0 * i + 1) / alongSteps - 1);
    for (int k = 0; k < aroundSteps; ++k) {
      const Vector3 wi = At(theta, kTurn * (k + 0.37) / aroundSteps);
      const BsdfEvaluation value = bsdf.Evaluate(wo, wi, kRadiance);
      sum.scattered += static_cast<double>(value.specular.g * bsdf.ScatteringCosine(wi));
      sum.density += static_cast<double>(value.pdfForward.value);
    }
  }
  const double cell = 2 * kTurn / (static_cast<double>(alongSteps) * aroundSteps);
  return {sum.scattered * cell, sum.density * cell};
}

TEST(Hair, BesselFunctionIsThatOfTheStandardLibrary) {
  for (double x = 0; x < 600; x = 1.05 * x + 0.01) {
    const double expected = std::cyl_bessel_i(0.0, x) * std::exp(-x);
    EXPECT_NEAR(static_cast<double>(ScaledBesselI0(static_cast<float>(x))) / expected, 1, 2e-6) << x;
  }
  EXPECT_NEAR(ScaledBesselI0(1e6f) * std::sqrt(2 * kPi * 1e6f), 1, 1e-5);
}

// Nothing absorbs: all light leaves, and the density is one, for every roughness and offset.
TEST(Hair, WhiteFurnace) {
  int cases = 0;
  for (const float betaM : {0.05f, 0.1f, 0.25f, 0.6f, 1.0f}) {
    for (const float betaN : {0.05f, 0.1f, 0.3f, 0.6f, 1.0f}) {
      for (const float h : {-1.0f, -0.8f, 0.0f, 0.3f, 0.99f}) {
        for (const double theta : {-0.9, 0.2}) {
          const Bsdf bsdf = InAxes(Fibre{Color(0.0f), 1.55f, betaM, betaN, 2, h}.Make());
          const int along = betaM < 0.2f ? 400 : 120, around = betaN < 0.2f ? 400 : 60;
          const Integral integral = Integrate(bsdf, At(theta, 1.1), along, around);
          EXPECT_NEAR(integral.scattered, 1, 1e-3) << betaM << " " << betaN << " " << h << " " << theta;
          EXPECT_NEAR(integral.density, 1, 1e-3) << betaM << " " << betaN << " " << h << " " << theta;
          ++cases;
        }
      }
    }
  }
  std::printf("           %d cases\n", cases);
}

// Pieces of the sum: what is reflected at the wall is Fresnel's, and what passes through both walls is absorbed by the
// length of its way inside.
TEST(Hair, AbsorptionLeavesTheReflectedLobe) {
  for (const float h : {0.0f, 0.5f, -0.9f}) {
    const double theta = 0.3;
    const Vector3 wo = At(theta, 0.4);
    const float cosine = static_cast<float>(std::cos(theta)) * std::sqrt(1 - h * h);
    const double F = static_cast<double>(FresnelDielectric(cosine, 1.55f));
    const Bsdf black = InAxes(Fibre{Color(1e6f), 1.55f, 0.3f, 0.3f, 2, h}.Make());
    EXPECT_NEAR(Integrate(black, wo, 300, 200).scattered, F, 1e-3 * F) << h;
    const double sigma = 0.7, sinT = std::sin(theta) / 1.55, cosT = std::sqrt(1 - sinT * sinT);
    const double sinGammaT =
        static_cast<double>(h) * std::cos(theta) / std::sqrt(1.55 * 1.55 - std::pow(std::sin(theta), 2));
    const double T = std::exp(-sigma * 2 * std::sqrt(1 - sinGammaT * sinGammaT) / cosT);
    const Bsdf gray = InAxes(Fibre{Color(0.7f), 1.55f, 0.3f, 0.3f, 2, h}.Make());
    const double expected = F + (1 - F) * (1 - F) * T / (1 - T * F);
    EXPECT_NEAR(Integrate(gray, wo, 300, 200).scattered, expected, 1e-3 * expected) << h;
  }
}

// A smooth black fibre without tilted scales is a mirror: it reflects at the normal of its wall, which leans from z to
// y by asin(h).
TEST(Hair, ReflectsAtItsWall) {
  for (const float h : {-0.7f, 0.0f, 0.4f}) {
    const Bsdf bsdf = InAxes(Fibre{Color(1e6f), 1.55f, 0.02f, 0.02f, 0, h}.Make());
    const Vector3 wo = glm::normalize(Vector3(0.3f, 0, 0.8f)), wall(0, h, std::sqrt(1 - h * h));
    const Vector3 mirrored = 2 * glm::dot(wo, wall) * wall - wo;
    const float peak = bsdf.Evaluate(wo, mirrored, kRadiance).pdfForward.value;
    Rng rng(3);
    Vector3 sum(0.0f);
    constexpr int kSamples = 4000;
    for (int i = 0; i < kSamples; ++i) {
      const float uLobe = rng.NextFloat();
      const auto sample = bsdf.Sample(wo, uLobe, rng.NextPoint2(), kRadiance);
      ASSERT_TRUE(sample);
      EXPECT_LE(sample.pdfForward.value, 1.03f * peak);
      sum += sample.wi;
    }
    EXPECT_LT(glm::length(glm::normalize(sum) - mirrored), 2e-3f) << h;
  }
}

// Without a boundary light goes straight on; the scales turn each lobe along the fibre.
TEST(Hair, GoesStraightOnWithoutABoundaryAndTiltsByItsScales) {
  for (const float alpha : {0.0f, 3.0f}) {
    const Bsdf bsdf = InAxes(Fibre{Color(0.0f), 1, 0.02f, 0.02f, alpha, 0.6f}.Make());
    const Vector3 wo = At(0.4, 0.9);
    Rng rng(5);
    Vector3 sum(0.0f);
    for (int i = 0; i < 4000; ++i) {
      const float uLobe = rng.NextFloat();
      const auto sample = bsdf.Sample(wo, uLobe, rng.NextPoint2(), kRadiance);
      ASSERT_TRUE(sample);
      sum += sample.wi;
    }
    // TT: θ turned by α, then mirrored.
    const Vector3 expected = At(-(0.4 + static_cast<double>(alpha) * 3.14159265358979 / 180), 0.9 + 3.14159265358979);
    EXPECT_LT(glm::length(glm::normalize(sum) - expected), 1e-3f) << alpha;
  }
}

// R, TT and TRT through the middle of a fibre lie where the scales turn them, by -2α, α and 4α.
TEST(Hair, LobesLieWhereTheScalesTurnThem) {
  const double degree = 3.14159265358979 / 180, theta = 12 * degree, alpha = 5 * degree;
  const Bsdf bsdf = InAxes(Fibre{Color(0.0f), 1.55f, 0.02f, 0.05f, 5, 0}.Make());
  const auto density = [&](double thetaI, double turn) {
    return bsdf.Evaluate(At(theta, 0.8), At(thetaI, 0.8 + turn), kRadiance).pdfForward.value;
  };
  const double turns[3] = {0, 3.14159265358979, 0}, tilts[3] = {-2, 1, 4};
  for (int p = 0; p < 3; ++p) {
    const double peak = -(theta + tilts[p] * alpha);
    EXPECT_GT(density(peak, turns[p]), 5 * density(peak - 4 * degree, turns[p])) << p;
    EXPECT_GT(density(peak, turns[p]), 5 * density(peak + 4 * degree, turns[p])) << p;
  }
}

TEST(Hair, PigmentsAndReflectances) {
  const Color brown = HairAbsorption(1.3f, 0.0f), both = HairAbsorption(0.3f, 2.0f);
  EXPECT_NEAR(brown.r, 0.5447f, 1e-5f);
  EXPECT_NEAR(brown.g, 0.9061f, 1e-5f);
  EXPECT_NEAR(brown.b, 1.781f, 1e-5f);
  EXPECT_NEAR(both.r, 0.4997f, 1e-5f);
  EXPECT_NEAR(both.g, 1.0091f, 1e-5f);
  EXPECT_NEAR(both.b, 2.511f, 1e-5f);
  // (ln 0.5 / 5.88841)² for β = 0.3.
  EXPECT_NEAR(HairAbsorption(Color(0.5f), 0.3f).g, 0.0138565f, 1e-6f);
  EXPECT_EQ(HairAbsorption(Color(1.0f), 0.3f), Color(0.0f));
  const Color extreme = HairAbsorption(Color(0.0f, 2.0f, -1.0f), 0.3f);
  EXPECT_TRUE(extreme.IsValid());
  EXPECT_GT(extreme.r, 100);
  EXPECT_EQ(extreme.g, 0);
}

// A fibre that a light path has met at -h is the one that a camera path has met at h.
TEST(Hair, BothEndsOfAPathSeeOneFibre) {
  Rng rng(11);
  for (const bool isFibre : {true, false}) {
    for (int i = 0; i < 2000; ++i) {
      const Fibre fibre{Color(0.1f, 0.3f, 1.0f),       1.55f,
                        0.1f + 0.9f * rng.NextFloat(), 0.1f + 0.9f * rng.NextFloat(),
                        10 * rng.NextFloat() - 5,      2 * rng.NextFloat() - 1};
      HairBsdf seen = fibre.Make(), lit = seen;
      seen.isFibre = lit.isFibre = isFibre;
      lit.offset = -fibre.h;
      const Vector3 wo = SampleUniformSphere(rng.NextPoint2()), wi = SampleUniformSphere(rng.NextPoint2());
      const BsdfEvaluation fromCamera = InAxes(seen).Evaluate(wo, wi, kRadiance);
      const BsdfEvaluation fromLight = InAxes(lit).Evaluate(wi, wo, kImportance);
      const auto near = [](float a, float b) { return std::abs(a - b) <= 1e-4f * std::abs(b); };
      EXPECT_TRUE(near(fromCamera.specular.g, fromLight.specular.g));
      EXPECT_TRUE(near(fromCamera.pdfForward.value, fromLight.pdfReverse.value));
      EXPECT_TRUE(near(fromCamera.pdfReverse.value, fromLight.pdfForward.value));
    }
  }
}

// Light paths are sampled nearly as the adjoint is: their weights are bounded.
TEST(Hair, LightPathsAreSampledByTheAdjoint) {
  Rng rng(13);
  for (const float beta : {0.05f, 0.1f, 0.3f, 0.9f}) {
    double sum = 0, squares = 0;
    constexpr int kSamples = 20000;
    for (int i = 0; i < kSamples; ++i) {
      const Bsdf bsdf = InAxes(Fibre{Color(0.0f), 1.55f, beta, beta, 2, 2 * rng.NextFloat() - 1}.Make());
      // As many meet the fibre as it shows of itself.
      const Vector3 wo = At(0.6, 6 * static_cast<double>(rng.NextFloat()));
      const float uLobe = rng.NextFloat();
      const auto sample = bsdf.Sample(wo, uLobe, rng.NextPoint2(), kImportance);
      const double weight = sample ? static_cast<double>(sample.Weight().g) : 0;
      sum += weight;
      squares += weight * weight;
    }
    EXPECT_LT(squares / kSamples, 3) << beta;
    std::printf("           beta %.2f: mean weight %.3f, mean square %.3f\n", static_cast<double>(beta), sum / kSamples,
                squares / kSamples);
  }
}

// The axis of the fibre is the pole of the bins: narrow lobes lie along their borders.
TEST(Hair, FibresAreSampledByTheirDensity) {
  const Fibre fibres[] = {{Color(0.2f, 0.4f, 0.8f), 1.55f, 0.3f, 0.3f, 2, 0.5f},
                          {Color(0.0f), 1.55f, 0.1f, 0.05f, 2, -0.3f},
                          {Color(0.0f), 1.55f, 1, 0.05f, 4, 0.95f}};
  const double level = SidakLevel(3 * 2 * 3);
  for (const Fibre& fibre : fibres) {
    const Bsdf bsdf = InAxes(fibre.Make());
    for (const TransportMode mode : {kRadiance, kImportance}) {
      for (const Vector3& wo : {At(0.1, 1.4), At(-1.2, 2), At(1.55, -1)}) {
        Rng rng(17);
        const auto result = ChiSquaredTestDirections(
            [&]() -> std::optional<Vector3> {
              const float uLobe = rng.NextFloat();
              const auto sample = bsdf.Sample(wo, uLobe, rng.NextPoint2(), mode);
              if (!sample) return std::nullopt;
              return Vector3(sample.wi.y, sample.wi.z, sample.wi.x);
            },
            [&](const Vector3& w) {
              return static_cast<double>(bsdf.Evaluate(wo, {w.z, w.x, w.y}, mode).pdfForward.value);
            });
        EXPECT_GT(result.pValue, level) << fibre.betaM << " " << fibre.betaN << " from x = " << wo.x << ": integral "
                                        << result.integral;
        EXPECT_NEAR(result.integral, 1, 1e-3);
      }
    }
  }
}

// Directions along the axis and across it, rims, η of 1 and below, absorption of nothing and of all.
TEST(Hair, ExtremesAreFinite) {
  Rng rng(19);
  int samples = 0;
  const auto check = [&](const HairBsdf& hair) {
    const Bsdf bsdf = InAxes(hair);
    const auto finite = [](float x) { return x >= 0 && x < kInfinity; };
    for (int i = 0; i < 300; ++i) {
      Vector3 wo = SampleUniformSphere(rng.NextPoint2());
      const float small = std::pow(10.0f, -8 * rng.NextFloat());
      if (i % 3 == 0) wo = glm::normalize(Vector3(wo.x, wo.y * small, wo.z * small));
      if (i % 4 == 0) wo = glm::normalize(Vector3(wo.x, wo.y, wo.z * small));
      if (i % 7 == 0) wo = {i % 2 ? 1 : -1, 0, 1e-30f};
      if (i % 11 == 0) wo = {0, 0, i % 2 ? 1 : -1};
      const TransportMode mode = i % 2 ? kRadiance : kImportance;
      Point2 u = rng.NextPoint2();
      if (i % 5 == 0) u = {i % 2 ? 0.0f : kOneMinusEpsilon, i % 4 < 2 ? 0.0f : kOneMinusEpsilon};
      const float uLobe = i % 13 == 0 ? 0.0f : i % 17 == 0 ? kOneMinusEpsilon : rng.NextFloat();
      const auto sample = bsdf.Sample(wo, uLobe, u, mode);
      const Vector3 wi = sample && i % 2 ? sample.wi : i % 3 ? SampleUniformSphere(rng.NextPoint2()) : -wo;
      const BsdfEvaluation value = bsdf.Evaluate(wo, wi, mode);
      ASSERT_TRUE(value.specular.IsValid() && finite(value.pdfForward.value) && finite(value.pdfReverse.value))
          << wo.x << " " << wo.y << " " << wo.z << ", f " << value.specular.g << ", pdf " << value.pdfForward.value;
      if (!sample) continue;
      ASSERT_TRUE(IsFinite(sample.wi) && sample.Weight().IsValid() && finite(sample.pdfForward.value) &&
                  finite(sample.pdfReverse.value))
          << wo.x << " " << wo.y << " " << wo.z << " to " << sample.wi.x << " " << sample.wi.y << " " << sample.wi.z
          << ", weight " << sample.Weight().g << ", pdf " << sample.pdfForward.value;
      ASSERT_NEAR(glm::length(sample.wi), 1, 1e-6f);
      ASSERT_LE(mode == kRadiance ? sample.Weight().Max() : 0.0f, 3.01f);
      ++samples;
    }
  };
  for (const float beta : {0.0f, 0.01f, 0.1f, 1.0f, 5.0f}) {
    for (const float sigma : {0.0f, 1.0f, 1e6f, kInfinity}) {
      for (const float eta : {0.01f, 0.7f, 1.0f, 1.0000001f, 1.55f, 100.0f}) {
        for (const float h : {-1.0f, -0.999999f, 0.0f, 0.5f, 1.0f}) {
          for (const bool isFibre : {false, true}) {
            HairBsdf hair = Fibre{Color(sigma, 0, sigma), eta, beta, beta, 2, h}.Make();
            hair.isFibre = hair.followsRay = isFibre;
            check(hair);
          }
        }
      }
    }
  }
  check(Fibre{Color(0.1f), 1.55f, 0.01f, 1, 90, 0.5f}.Make());
  EXPECT_GT(samples, 200000);
}

}  // namespace
}  // namespace lampyr::testing
