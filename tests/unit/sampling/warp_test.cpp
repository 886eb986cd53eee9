// Warps: histograms of samples against the densities, inverses, extremes; and the two maps of environment images.
#include "sampling/warp.h"

#include <gtest/gtest.h>

#include <functional>

#include "histogram_test.h"
#include "sampling/equal_area.h"
#include "sampling/rng.h"

namespace lampyr {
namespace {

constexpr int kSamples = 200000;
constexpr int kBins = 16;

double Double(float v) {
  return static_cast<double>(v);
}

// Histogram over (1 - cosθ)/range and φ, against a density in solid angle that depends on cosθ alone.
double DirectionPValue(const std::function<Vector3(Point2)>& sample, const std::function<double(double)>& density,
                       double range) {
  Rng rng(11);
  std::vector<double> counts(kBins * kBins), expected(kBins * kBins);
  for (int i = 0; i < kSamples; ++i) {
    const Vector3 v = sample(rng.NextPoint2());
    const double t = Double(warp_internal::OneMinusCosTheta(v)) / range;
    const double turns = std::atan2(Double(v.y), Double(v.x)) / (2 * Double(kPi)) + 0.5;
    const int row = std::min(static_cast<int>(t * kBins), kBins - 1);
    const int column = std::min(static_cast<int>(turns * kBins), kBins - 1);
    counts[static_cast<size_t>(row * kBins + column)] += 1;
  }
  double total = 0;
  for (int row = 0; row < kBins; ++row) {
    double integral = 0;
    for (int k = 0; k < 32; ++k) integral += density(1 - range * (row + (k + 0.5) / 32) / kBins) / 32;
    integral *= range * 2 * Double(kPi) / kBins;
    total += integral;
    for (int column = 0; column < kBins; ++column) {
      expected[static_cast<size_t>(row * kBins + column)] = kSamples * integral / kBins;
    }
  }
  EXPECT_NEAR(total, 1, 1e-6);
  return test::HistogramPValue(counts, expected);
}

TEST(Warp, SphereAndHemispheresFollowTheirDensities) {
  EXPECT_GT(DirectionPValue(
                SampleUniformSphere, [](double) { return Double(UniformSpherePdf().value); }, 2),
            test::kSignificance);
  EXPECT_GT(DirectionPValue(
                SampleUniformHemisphere, [](double) { return Double(UniformHemispherePdf().value); }, 1),
            test::kSignificance);
  EXPECT_GT(
      DirectionPValue(
          SampleCosineHemisphere, [](double c) { return Double(CosineHemispherePdf(static_cast<float>(c)).value); }, 1),
      test::kSignificance);
}

TEST(Warp, ConesOfAllSizesFollowTheirDensity) {
  for (const float range : {2.0f, 1.3f, 0.5f, 1e-2f, 1e-7f, 1e-12f, 1e-20f}) {
    EXPECT_GT(DirectionPValue([&](Point2 u) { return SampleUniformCone(u, range); },
                              [&](double) { return Double(UniformConePdf(range).value); }, Double(range)),
              test::kSignificance)
        << range;
  }
}

TEST(Warp, WrongDensityIsFound) {
  // The histogram test has power: a hemisphere sampled uniformly is not cosine distributed.
  EXPECT_LT(DirectionPValue(
                SampleUniformHemisphere, [](double c) { return c / Double(kPi); }, 1),
            test::kSignificance);
}

TEST(Warp, DiskAndTriangleAreUniform) {
  Rng rng(5);
  std::vector<double> disk(kBins * kBins), triangle(kBins * kBins / 2 + kBins);
  for (int i = 0; i < kSamples; ++i) {
    const Point2 p = SampleConcentricDisk(rng.NextPoint2());
    const double r2 = std::min(Double(glm::dot(p, p)), 0.999999);
    const double turns = std::atan2(Double(p.y), Double(p.x)) / (2 * Double(kPi)) + 0.5;
    disk[static_cast<size_t>(static_cast<int>(r2 * kBins) * kBins +
                             std::min(static_cast<int>(turns * kBins), kBins - 1))] += 1;
    // Rows of equal area: 1 - b0 is distributed as the square root, and b1/(1 - b0) uniformly.
    const Vector3 b = SampleUniformTriangle(rng.NextPoint2());
    EXPECT_GE(std::min(b.x, std::min(b.y, b.z)), 0.0f);
    EXPECT_NEAR(b.x + b.y + b.z, 1.0f, 2e-7f);
    const double rest = 1 - Double(b.x);
    const int row = std::min(static_cast<int>(rest * rest * 8), 7);
    const int column = std::min(static_cast<int>(Double(b.y) / rest * kBins), kBins - 1);
    triangle[static_cast<size_t>(row * kBins + column)] += 1;
  }
  EXPECT_GT(test::HistogramPValue(disk, std::vector<double>(kBins * kBins, kSamples / Double(kBins * kBins))),
            test::kSignificance);
  triangle.resize(8 * kBins);
  EXPECT_GT(test::HistogramPValue(triangle, std::vector<double>(8 * kBins, kSamples / Double(8 * kBins))),
            test::kSignificance);
}

TEST(Warp, InvertGivesBackTheSample) {
  Rng rng(7);
  for (int i = 0; i < 100000; ++i) {
    const Point2 u = rng.NextPoint2();
    const auto expectNear = [&](const Point2& v, const char* what, float error = 1e-5f) {
      EXPECT_NEAR(u.x, v.x, error) << what << " " << u.y;
      const float dy = std::abs(u.y - v.y);  // an angle may come back a whole turn away
      EXPECT_LT(std::min(dy, 1 - dy), error) << what << " " << u.x;
      EXPECT_TRUE(v.x >= 0 && v.x < 1 && v.y >= 0 && v.y < 1) << what;
    };
    if (u.x < 1e-5f || u.x > 1 - 1e-5f) continue;  // the azimuth at a pole is arbitrary
    expectNear(InvertConcentricDisk(SampleConcentricDisk(u)), "disk");
    expectNear(InvertCosineHemisphere(SampleCosineHemisphere(u)), "cosine");
    expectNear(InvertUniformSphere(SampleUniformSphere(u)), "sphere");
    expectNear(InvertUniformHemisphere(SampleUniformHemisphere(u)), "hemisphere");
    for (const float range : {1.9f, 1e-3f, 1e-9f})
      expectNear(InvertUniformCone(SampleUniformCone(u, range), range), "cone");
    expectNear(InvertUniformTriangle(SampleUniformTriangle(u)), "triangle");
    expectNear(EqualAreaSphereToSquare(EqualAreaSquareToSphere(u)), "equal area", 2e-6f);
    expectNear(LatLongSphereToSquare(LatLongSquareToSphere(u)), "lat-long");
  }
}

TEST(Warp, UnitLengthEverywhereOnTheSquare) {
  for (const float x : {0.0f, 1e-20f, 1e-7f, 0.25f, 0.5f, 0.75f, kOneMinusEpsilon}) {
    for (const float y : {0.0f, 1e-20f, 1e-7f, 0.25f, 0.5f, 0.75f, kOneMinusEpsilon}) {
      const Point2 u(x, y);
      EXPECT_GT(SampleCosineHemisphere(u).z, 0.0f);
      EXPECT_GT(SampleUniformHemisphere(u).z, 0.0f);
      for (const Vector3& v :
           {SampleCosineHemisphere(u), SampleUniformSphere(u), SampleUniformHemisphere(u), SampleUniformCone(u, 1e-30f),
            SampleUniformCone(u, 2.0f), EqualAreaSquareToSphere(u), LatLongSquareToSphere(u)}) {
        EXPECT_NEAR(glm::length(v), 1.0f, 3e-7f) << x << " " << y;
      }
    }
  }
}

TEST(Warp, ConeOfATinySphereIsConditioned) {
  // A sphere of radius 1e-6 at distance 1e3: cosθmax is 1 in float, the solid angle is not 0.
  const float sinSquared = 1e-18f;
  EXPECT_NEAR(OneMinusCosFromSinSquared(sinSquared) / 0.5e-18f, 1.0f, 1e-6f);
  EXPECT_NEAR(OneMinusCosFromSinSquared(1.0f), 1.0f, 1e-6f);
}

TEST(EqualArea, OrientationIsThatOfPbrt) {
  const auto expectDirection = [](const Point2& p, const Vector3& v) {
    EXPECT_LT(glm::length(EqualAreaSquareToSphere(p) - v), 1e-6f) << p.x << " " << p.y;
  };
  expectDirection({0.5f, 0.5f}, {0, 0, 1});
  for (const Point2 corner : {Point2(0, 0), Point2(1, 0), Point2(0, 1), Point2(1, 1)})
    expectDirection(corner, {0, 0, -1});
  expectDirection({1, 0.5f}, {1, 0, 0});
  expectDirection({0, 0.5f}, {-1, 0, 0});
  expectDirection({0.5f, 1}, {0, 1, 0});
  expectDirection({0.5f, 0}, {0, -1, 0});
  expectDirection({0.75f, 0.75f}, {std::sqrt(0.5f), std::sqrt(0.5f), 0});
}

TEST(EqualArea, AreasAreEqual) {
  EXPECT_GT(DirectionPValue(
                EqualAreaSquareToSphere, [](double) { return 0.25 / Double(kPi); }, 2),
            test::kSignificance);
}

TEST(EqualArea, WrappingContinuesTheMapAcrossEveryEdge) {
  Rng rng(9);
  for (int i = 0; i < 1000; ++i) {
    const float t = rng.NextFloat(), e = 1e-4f;
    for (const auto& [inside, outside] :
         {std::pair(Point2(e, t), Point2(-e, t)), std::pair(Point2(1 - e, t), Point2(1 + e, t)),
          std::pair(Point2(t, e), Point2(t, -e)), std::pair(Point2(t, 1 - e), Point2(t, 1 + e))}) {
      const Vector3 a = EqualAreaSquareToSphere(inside), b = EqualAreaSquareToSphere(WrapEqualAreaSquare(outside));
      EXPECT_LT(glm::length(a - b), 5e-3f) << outside.x << " " << outside.y;
    }
  }
}

TEST(LatLong, PolesAndMeridian) {
  EXPECT_LT(glm::length(LatLongSquareToSphere({0.3f, 0}) - Vector3(0, 0, 1)), 1e-6f);
  EXPECT_LT(glm::length(LatLongSquareToSphere({0.3f, 1}) - Vector3(0, 0, -1)), 1e-6f);
  EXPECT_LT(glm::length(LatLongSquareToSphere({0, 0.5f}) - Vector3(1, 0, 0)), 1e-6f);
  EXPECT_LT(glm::length(LatLongSquareToSphere({0.25f, 0.5f}) - Vector3(0, 1, 0)), 1e-6f);
}

TEST(CosSinTurns, AgreesWithTheLibrary) {
  Rng rng(3);
  for (int i = 0; i < 100000; ++i) {
    const float turns = 4 * rng.NextFloat() - 2;
    const double angle = 2 * 3.14159265358979323846 * Double(turns);
    EXPECT_NEAR(Double(CosSinTurns(turns).x), std::cos(angle), 1.5e-7);
    EXPECT_NEAR(Double(CosSinTurns(turns).y), std::sin(angle), 1.5e-7);
  }
}

TEST(Rng, IsUniformAndStreamsDiffer) {
  Rng a(1, 0), b(1, 1);
  std::vector<double> counts(32 * 32);
  int equal = 0;
  for (int i = 0; i < kSamples; ++i) {
    const float x = a.NextFloat(), y = b.NextFloat();
    ASSERT_TRUE(x >= 0 && x < 1);
    counts[static_cast<size_t>(static_cast<int>(x * 32) * 32 + static_cast<int>(y * 32))] += 1;
    equal += x == y;
  }
  EXPECT_GT(test::HistogramPValue(counts, std::vector<double>(1024, kSamples / 1024.0)), test::kSignificance);
  EXPECT_LT(equal, 5);
  EXPECT_LT(UnitFloat(0xffffffffu), 1.0f);
  EXPECT_NE(Hash(1, 2), Hash(2, 1));
  EXPECT_NE(Hash(0), Hash(0, 0));
}

}  // namespace
}  // namespace lampyr
