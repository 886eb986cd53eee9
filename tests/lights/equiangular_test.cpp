// Equiangular distances: samples follow the density, the density is the formula's and integrates to 1, in all extremes.
#include "lights/services/equiangular.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sampling/rng.h"
#include "sampling/warp.h"
#include "support/chi_squared.h"

namespace lampyr {
namespace {

struct Setting {
  const char* name;
  double distance, foot;  // of the apex: from the ray, and along it
  float tMin, tMax;
};

constexpr Setting kSettings[] = {
    {"beside", 1.3, 2.1, 0.4f, 6},
    {"near", 1e-3, 2.1, 0.4f, 6},
    {"nearer than floats tell", 1e-12, 2.1, 0.4f, 6},
    {"on the ray", 0, 2.1, 0.4f, 6},
    {"on the ray, ahead", 0, 20, 0.4f, 6},
    {"on the ray, behind", 0, -3, 0.4f, 6},
    {"at the origin", 0, 0, 0, 6},
    {"at the start", 0, 0.4, 0.4f, 6},
    {"at the end", 0, 6, 0.4f, 6},
    {"far behind", 0.5, -1e6, 0, 1},
    {"very far behind", 0.5, -1e15, 0, 1},
    {"very far ahead", 0.5, 1e15, 0, 1},
    {"far aside", 1e9, 0.3, 0, 1},
    {"very far aside", 1e18, 0.3, 0, 1},
    {"without an end", 1.3, 2.1, 0.4f, kInfinity},
    {"without an end, behind", 1.3, -200, 0.4f, kInfinity},
    {"without an end, ahead", 1e-2, 200, 0, kInfinity},
    {"without an end, at the origin", 0, 0, 0, kInfinity},
    {"long", 1, 3, 0, 1e8f},
    {"short", 1, 3, 3, 3.0001f},
    {"tiny", 1e-9, 3e-9, 0, 1e-8f},
    {"huge", 1e20, 3e20, 0, 1e21f},
};

// The ray runs along x, so that D and δ are what they say.
EquiangularDistance Make(const Setting& s) {
  return {Point3(0.0f), Vector3(1, 0, 0), Point3(static_cast<float>(s.foot), 0, static_cast<float>(s.distance)), s.tMin,
          s.tMax};
}

// By the angles of the textbook, in long double: the share of the range before t. Valid where the angles are not tiny.
double TextbookShare(const Setting& s, double t) {
  const auto angle = [&](double at) {
    return std::atan((static_cast<long double>(at) - static_cast<long double>(s.foot)) /
                     static_cast<long double>(s.distance));
  };
  const long double a = angle(static_cast<double>(s.tMin)),
                    b = std::isinf(s.tMax) ? std::numbers::pi_v<long double> / 2 : angle(static_cast<double>(s.tMax));
  return static_cast<double>((angle(t) - a) / (b - a));
}

// ∫ density from t0 to t1 on a fine grid of equal steps of the random number, which is where the density varies.
double Integral(const EquiangularDistance& sampler, double u0, double u1) {
  constexpr int steps = 64;
  double sum = 0;
  float before = sampler.Sample(static_cast<float>(u0));
  for (int i = 1; i <= steps; ++i) {
    const float t = sampler.Sample(static_cast<float>(u0 + (u1 - u0) * i / steps));
    const auto a = static_cast<double>(sampler.Density(before).value),
               b = static_cast<double>(sampler.Density(t).value);
    const double width = static_cast<double>(t) - static_cast<double>(before);
    // Between steps of equal angle the density is nearly that of 1/t²: its integral is the geometric mean times width.
    sum += std::sqrt(a * b) * width;
    before = t;
  }
  return sum;
}

TEST(Equiangular, IsTheFormula) {
  Rng rng(1);
  for (int trial = 0; trial < 2000; ++trial) {
    Setting s{"random", std::exp(6.0 * static_cast<double>(rng.NextFloat()) - 3),
              20.0 * static_cast<double>(rng.NextFloat()) - 10, 3 * rng.NextFloat(), kInfinity};
    if (trial % 4) s.tMax = s.tMin + 10 * rng.NextFloat() + 0.1f;
    s.distance = static_cast<double>(static_cast<float>(s.distance));
    s.foot = static_cast<double>(static_cast<float>(s.foot));
    const EquiangularDistance sampler = Make(s);
    const float u = rng.NextFloat();
    const float t = sampler.Sample(u);
    const double density = static_cast<double>(sampler.Density(t).value);
    // The derivative of the share, and the share itself.
    const double step = 1e-4 * (s.distance + std::abs(static_cast<double>(t) - s.foot));
    const double low = std::max(static_cast<double>(t) - step, static_cast<double>(s.tMin));
    const double high = std::min(static_cast<double>(t) + step, static_cast<double>(s.tMax));
    EXPECT_NEAR(density * (high - low), TextbookShare(s, high) - TextbookShare(s, low), 1e-3 * density * (high - low));
    EXPECT_NEAR(TextbookShare(s, static_cast<double>(t)), static_cast<double>(u),
                1e-5 + 2e-7 * density * static_cast<double>(t));
  }
}

TEST(Equiangular, SamplesFollowTheDensityInAllExtremes) {
  Rng rng(2);
  constexpr int draws = 20000, bins = 64;
  const double level = testing::SidakLevel(static_cast<int>(std::size(kSettings)));
  for (const Setting& s : kSettings) {
    const EquiangularDistance sampler = Make(s);
    ASSERT_FALSE(sampler.IsEmpty()) << s.name;
    // Bins that end at samples, of which the first and the last are the ends of the range.
    std::vector<float> ends;
    std::vector<double> expected, observed;
    for (int i = 1; i < bins; ++i) ends.push_back(sampler.Sample(static_cast<float>(i) / bins));
    double whole = 0;
    for (int i = 0; i < bins; ++i) {
      const double share = Integral(sampler, static_cast<double>(i) / bins, (i + 1.0) / bins);
      whole += share;
      expected.push_back(draws * share);
      observed.push_back(0);
    }
    // A distance is rounded to the nearest float: a bin begins half a float's spacing before its first one.
    for (size_t i = 0; i < ends.size(); ++i) {
      const double half = 0.5 * (static_cast<double>(ends[i]) - static_cast<double>(std::nextafter(ends[i], -1.0f)));
      const double moved = draws * half * static_cast<double>(sampler.Density(ends[i]).value);
      expected[i] -= moved;
      expected[i + 1] += moved;
    }
    for (int i = 0; i < draws; ++i) {
      const float t = sampler.Sample(rng.NextFloat());
      ASSERT_TRUE(t >= s.tMin && t <= s.tMax) << s.name << " " << t;
      const float density = sampler.Density(t).value;
      ASSERT_TRUE(density > 0 && std::isfinite(density)) << s.name << " " << t << " " << density;
      const auto bin = std::upper_bound(ends.begin(), ends.end(), t) - ends.begin();
      observed[static_cast<size_t>(bin)] += 1;
    }
    EXPECT_NEAR(whole, 1, 2e-3) << s.name;
    EXPECT_GT(testing::ChiSquaredPValue(observed, expected), level) << s.name;
  }
}

TEST(Equiangular, InvertIsTheInverse) {
  Rng rng(3);
  for (const Setting& s : kSettings) {
    const EquiangularDistance sampler = Make(s);
    for (int i = 0; i < 1000; ++i) {
      const float u = rng.NextFloat(), t = sampler.Sample(u);
      // A distance is rounded to a float: by half its spacing, times the density, in u.
      const double spacing = 1.2e-7 * static_cast<double>(t);
      const double tolerance = 1e-9 + spacing * static_cast<double>(sampler.Density(t).value);
      EXPECT_NEAR(sampler.Invert(t), static_cast<double>(u), tolerance) << s.name;
    }
    EXPECT_EQ(sampler.Invert(s.tMin), 0) << s.name;
    EXPECT_NEAR(sampler.Invert(s.tMax), 1, 1e-12) << s.name;
  }
}

// Random numbers over many scales: nothing is ever NaN, infinite or out of range.
TEST(Equiangular, IsAlwaysFinite) {
  Rng rng(4);
  const auto scale = [&] { return std::pow(10.0f, 36 * rng.NextFloat() - 18); };
  for (int trial = 0; trial < 200000; ++trial) {
    const Point3 origin = scale() * (Point3(rng.NextFloat(), rng.NextFloat(), rng.NextFloat()) - 0.5f);
    const Vector3 direction = SampleUniformSphere(rng.NextPoint2());
    const Point3 apex = trial % 3 ? scale() * (Point3(rng.NextFloat(), rng.NextFloat(), rng.NextFloat()) - 0.5f)
                                  : origin + scale() * direction;
    const float tMin = trial % 2 ? scale() : 0.0f, tMax = trial % 5 ? tMin + scale() : kInfinity;
    const EquiangularDistance sampler(origin, direction, apex, tMin, tMax);
    if (sampler.IsEmpty()) {
      EXPECT_EQ(sampler.Density(tMin).value, 0);
      continue;
    }
    for (const float u : {0.0f, rng.NextFloat(), 0x1.fffffep-1f, 1.0f}) {
      const float t = sampler.Sample(u);
      ASSERT_TRUE(t >= tMin && t <= tMax && std::isfinite(t)) << trial;
      const float density = sampler.Density(t).value;
      ASSERT_TRUE(density >= 0 && std::isfinite(density)) << trial;
      const double inverse = sampler.Invert(t);
      ASSERT_TRUE(inverse >= 0 && inverse <= 1) << trial;
    }
  }
}

TEST(Equiangular, HasNoDensityOutsideOfTheRange) {
  const EquiangularDistance sampler = Make(kSettings[0]);
  EXPECT_EQ(sampler.Density(0.39f).value, 0);
  EXPECT_EQ(sampler.Density(6.01f).value, 0);
  EXPECT_EQ(sampler.Density(std::nanf("")).value, 0);
  EXPECT_GT(sampler.Density(6).value, 0);
  for (const float tMax : {2.0f, 1.0f}) {
    const EquiangularDistance empty({0, 0, 0}, {1, 0, 0}, {1, 1, 1}, 2, tMax);
    EXPECT_TRUE(empty.IsEmpty());
    EXPECT_EQ(empty.Density(2).value, 0);
  }
}

// For an isotropic point light without extinction, one sample gives the exact single scattering along the ray.
TEST(Equiangular, MakesInverseSquaresConstant) {
  const Setting s = kSettings[0];
  const EquiangularDistance sampler = Make(s);
  const double exact = (std::atan((6 - s.foot) / s.distance) - std::atan((0.4 - s.foot) / s.distance)) / s.distance;
  Rng rng(5);
  for (int i = 0; i < 100; ++i) {
    const float t = sampler.Sample(rng.NextFloat());
    const double x = static_cast<double>(t) - s.foot;
    EXPECT_NEAR(1 / (s.distance * s.distance + x * x) / static_cast<double>(sampler.Density(t).value), exact,
                1e-5 * exact);
  }
}

}  // namespace
}  // namespace lampyr
