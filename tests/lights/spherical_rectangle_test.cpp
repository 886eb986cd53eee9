// The rectangle as seen from a point: solid angles against a formula of its own in long double and against quadrature,
// samples against the density, from points near, far, grazing and in the plane.
#include "lights/types/spherical_rectangle.h"

#include <gtest/gtest.h>

#include <numbers>
#include <vector>

#include "sampling/rng.h"
#include "support/chi_squared.h"

namespace lampyr {
namespace {

struct Case {
  const char* name;
  Point3d P;
  double width, height;  // of the rectangle [0,width] × [0,height] at z = 0
};

const Case kCases[] = {
    {"above the middle", {0.5, 0.5, 1}, 1, 1},
    {"above a corner", {0, 0, 0.7}, 1, 2},
    {"oblique", {-2, 3, 0.8}, 1, 1},
    {"behind", {0.3, 0.4, -1.5}, 2, 1},
    {"far", {40, -70, 1000}, 1, 1},
    {"touched", {0.3, 0.6, 1e-6}, 1, 1},
    {"touched on an edge", {0.3, 0, 1e-6}, 1, 1},
    {"touched beside an edge", {0.3, -1e-6, 1e-6}, 1, 1},
    {"grazing along x", {-1, 0.4, 1e-6}, 1, 1},
    {"grazing along -x", {2.5, 0.4, 1e-5}, 1, 1},
    {"grazing along y", {0.4, 2, 1e-6}, 1, 1},
    {"grazing along -y", {0.4, -2, 1e-6}, 1, 1},
    {"grazing diagonally", {-1, -1, 1e-6}, 1, 1},
    {"grazing at the lowest uniform solid angle", {-1, 0.4, 3e-8}, 1, 1},
    {"thin", {0.2, 0.01, 0.05}, 1, 0.001},
    {"thin, along the other axis", {0.01, 0.2, 0.05}, 0.001, 1},
    {"thin, far", {3, 1, 4}, 1, 0.001},
    {"thin, grazing its end", {-0.5, 0.0003, 1e-4}, 1, 0.001},
    {"changing to area sampling", {0.1, 0.2, 1.5e4}, 1, 1},
    {"changing, thin and oblique", {5, 1e-3, 0.002}, 1, 1e-4},
    {"by area", {3, -2, 1e6}, 1, 1},
    {"tiny and far", {2e4, 3e4, 1e5}, 1e-6, 1e-6},
};

SphericalRectangle Make(const Case& c) {
  return {c.P, Point3d(0.0), Vector3d(c.width, 0, 0), Vector3d(0, c.height, 0)};
}

// Signed solid angle of [0,x] × [0,y] at distance z.
long double Corner(long double x, long double y, long double z) {
  return std::atan2(x * y, z * std::sqrt(x * x + y * y + z * z));
}
long double Exact(const Case& c, double u0, double u1, double v0, double v1) {
  const auto P = [&](int i) { return static_cast<long double>(c.P[i]); };
  const long double x0 = u0 * static_cast<long double>(c.width) - P(0), z = std::abs(P(2));
  const long double x1 = u1 * static_cast<long double>(c.width) - P(0);
  const long double y0 = v0 * static_cast<long double>(c.height) - P(1);
  const long double y1 = v1 * static_cast<long double>(c.height) - P(1);
  return Corner(x1, y1, z) - Corner(x0, y1, z) - Corner(x1, y0, z) + Corner(x0, y0, z);
}

TEST(SphericalRectangle, SolidAngleIsExact) {
  for (const Case& c : kCases) {
    const double solidAngle = Make(c).SolidAngle(), d2 = glm::dot(c.P, c.P);
    // The difference of four angles has no digits left for the smallest: z A / d³ there.
    const auto exact = solidAngle > 1e-12 ? static_cast<double>(Exact(c, 0, 1, 0, 1))
                                          : std::abs(c.P.z) * c.width * c.height / (d2 * std::sqrt(d2));
    EXPECT_NEAR(solidAngle / exact, 1, solidAngle > 1e-12 ? 5e-11 + 2e-18 / solidAngle : 2e-6) << c.name;
  }
}

TEST(SphericalRectangle, SolidAngleWithoutDigitsToLose) {
  // z A / d³ where the rectangle is small beside its distance.
  const Case c{"", {2e4, 3e4, 1e5}, 1e-6, 1e-6};
  const double d2 = glm::dot(c.P, c.P);
  EXPECT_NEAR(Make(c).SolidAngle() / (1e5 * 1e-12 / (d2 * std::sqrt(d2))), 1, 1e-9);
  // A face of the cube around P is a sixth of the sphere; all of the plane, half of it.
  const SphericalRectangle face(Point3d(0.0), {-1, -1, 1}, {2, 0, 0}, {0, 2, 0});
  EXPECT_NEAR(face.SolidAngle(), 4 * std::numbers::pi / 6, 1e-14);
  const SphericalRectangle plane(Point3d(0.0), {-1e9, -1e9, 1}, {2e9, 0, 0}, {0, 2e9, 0});
  EXPECT_NEAR(plane.SolidAngle(), 2 * std::numbers::pi, 1e-8);
}

TEST(SphericalRectangle, NotSeenFromItsPlane) {
  for (const Point3d& P : {Point3d(0.5, 0.5, 0), Point3d(-1, 0.5, 0), Point3d(1, 0.2, 0), Point3d(0.0),
                           Point3d(0.5, 0.5, 1e-18), Point3d(0.3, 0.3, -1e-14)}) {
    const SphericalRectangle r(P, Point3d(0.0), {1, 0, 0}, {0, 1, 0});
    EXPECT_EQ(r.SolidAngle(), 0);
    EXPECT_TRUE(r.Density({0.5, 0.5}).IsZero());
    EXPECT_FALSE(r.Meet({10, 10, 0.3}));
  }
}

// Cuts of [0,1]: even ones, and ever finer ones around `center`.
std::vector<double> Cuts(double center) {
  std::vector<double> cuts = {0, 1};
  for (int i = 1; i < 8; ++i) cuts.push_back(i / 8.0);
  for (double step = 3e-7; step < 1; step *= 3) {
    for (const double cut : {center - step, center + step}) {
      if (cut > 0 && cut < 1) cuts.push_back(cut);
    }
  }
  std::sort(cuts.begin(), cuts.end());
  return cuts;
}

// Probability of a cell by the density: exactly where it is 1/Ω, else by quadrature.
double CellProbability(const Case& c, const SphericalRectangle& r, double u0, double u1, double v0, double v1) {
  if (r.SolidAngle() > 1e-8) return static_cast<double>(Exact(c, u0, u1, v0, v1) / Exact(c, 0, 1, 0, 1));
  constexpr int n = 16;
  double sum = 0;
  for (int i = 0; i < n * n; ++i) {
    const Point2d uv(u0 + (u1 - u0) * (i % n + 0.5) / n, v0 + (v1 - v0) * (i / n + 0.5) / n);
    const double d = r.At(uv).distance;
    sum += static_cast<double>(r.Density(uv).value) * std::abs(r.Height()) / (d * d * d);
  }
  return sum / (n * n) * (u1 - u0) * (v1 - v0) * c.width * c.height;
}

TEST(SphericalRectangle, SamplesFollowTheDensity) {
  constexpr int kSamples = 200000;
  for (const Case& c : kCases) {
    const SphericalRectangle r = Make(c);
    const std::vector<double> us = Cuts(c.P.x / c.width), vs = Cuts(c.P.y / c.height);
    std::vector<double> observed((us.size() - 1) * (vs.size() - 1), 0.0), expected(observed.size());
    double total = 0;
    for (size_t i = 0; i < observed.size(); ++i) {
      const size_t x = i % (us.size() - 1), y = i / (us.size() - 1);
      const double p = CellProbability(c, r, us[x], us[x + 1], vs[y], vs[y + 1]);
      expected[i] = kSamples * p;
      total += p;
    }
    EXPECT_NEAR(total, 1, 1e-4) << c.name;
    Rng rng(9);
    for (int i = 0; i < kSamples; ++i) {
      const Point2d uv = r.Sample(rng.NextPoint2()).uv;
      const auto cell = [](const std::vector<double>& cuts, double at) {
        const auto above = std::upper_bound(cuts.begin(), cuts.end(), at) - cuts.begin();
        return static_cast<size_t>(std::clamp<std::ptrdiff_t>(above - 1, 0, std::ssize(cuts) - 2));
      };
      ++observed[cell(vs, uv.y) * (us.size() - 1) + cell(us, uv.x)];
    }
    EXPECT_GT(testing::ChiSquaredPValue(observed, expected), 1e-3 / std::size(kCases)) << c.name;
  }
}

TEST(SphericalRectangle, SamplesLieOnTheRectangleAndAreMetAgain) {
  Rng rng(4);
  for (const Case& c : kCases) {
    const SphericalRectangle r = Make(c);
    for (int i = 0; i < 1000; ++i) {
      // The corners of the unit square as well.
      const Point2 u =
          i < 4 ? Point2(i & 1 ? kOneMinusEpsilon : 0.0f, i & 2 ? kOneMinusEpsilon : 0.0f) : rng.NextPoint2();
      const auto sample = r.Sample(u);
      ASSERT_TRUE(sample.uv.x >= 0 && sample.uv.x <= 1 && sample.uv.y >= 0 && sample.uv.y <= 1) << c.name;
      const Point3d point = c.P + sample.toPoint;
      const double slack = 1e-14 * (glm::length(c.P) + 1);
      ASSERT_NEAR(point.x, sample.uv.x * c.width, slack) << c.name;
      ASSERT_NEAR(point.y, sample.uv.y * c.height, slack) << c.name;
      ASSERT_NEAR(point.z, 0, slack) << c.name;
      ASSERT_NEAR(sample.distance / glm::length(sample.toPoint), 1, 1e-9) << c.name;
      ASSERT_GT(r.Density(sample.uv).value, 0) << c.name;
      if (sample.uv.x < 1e-3 || sample.uv.x > 0.999 || sample.uv.y < 1e-3 || sample.uv.y > 0.999) continue;
      const auto met = r.Meet(3.0 * sample.toPoint);
      if (c.width < 1e-5) continue;  // the way to the point has no digits for a place on it
      ASSERT_TRUE(met) << c.name;
      ASSERT_NEAR(met->x, sample.uv.x, 1e-5) << c.name;
      ASSERT_NEAR(met->y, sample.uv.y, 1e-5) << c.name;
      ASSERT_FALSE(r.Meet(-sample.toPoint)) << c.name;
    }
  }
}

TEST(SphericalRectangle, TheChangeToAreaSamplingIsContinuous) {
  // Densities just above and below both ends of the change, at an edge of the rectangle, seen obliquely.
  for (const double solidAngle : {1e-8, 1e-9}) {
    const double d = 1 / std::sqrt(solidAngle);
    const auto density = [&](double distance) {
      const Case c{"", {0, 0.3, distance}, 1, 1};
      return static_cast<double>(Make(c).Density({0.01, 0.02}).value);
    };
    EXPECT_NEAR(density(d * 0.9999) / density(d * 1.0001), 1, 5e-4);
  }
  // In all of the change the density is that of the mixture, so the whole integrates to 1 (SamplesFollowTheDensity).
  EXPECT_LT(Make({"", {0.1, 0.2, 1.5e4}, 1, 1}).SolidAngle(), 1e-8);
  EXPECT_GT(Make({"", {0.1, 0.2, 1.5e4}, 1, 1}).SolidAngle(), 1e-9);
}

TEST(SphericalRectangle, AnyPlacement) {
  // Turned, mirrored and moved: the same solid angle, and points on the rectangle.
  const Vector3d x = glm::normalize(Vector3d(1, 2, -0.5)), y = glm::normalize(glm::cross(x, Vector3d(0.3, -1, 2)));
  const Vector3d z = glm::cross(x, y), move(100, -20, 7);
  const Case c{"", {-0.3, 1.4, 0.9}, 2, 0.7};
  const double expected = Make(c).SolidAngle();
  for (const double side : {1.0, -1.0}) {
    const Point3d P = move + c.P.x * x + c.P.y * y + side * c.P.z * z;
    const SphericalRectangle r(P, move, 2.0 * x, 0.7 * y);
    EXPECT_NEAR(r.SolidAngle() / expected, 1, 1e-12);
    EXPECT_NEAR(r.Height(), side * c.P.z, 1e-12);
    EXPECT_NEAR(SphericalRectangle(Vector3d(0.0) - c.P, c.width, c.height).SolidAngle() / expected, 1, 1e-14);
    const auto sample = r.Sample({0.3f, 0.8f});
    EXPECT_LT(glm::length(P + sample.toPoint - (move + 2.0 * sample.uv.x * x + 0.7 * sample.uv.y * y)), 1e-12);
  }
}

}  // namespace
}  // namespace lampyr
