// The promise of every medium on a grid: its majorants are bounds of its extinction, at points and along rays.
#include <cmath>

#include "math/noise.h"
#include "sampling/rng.h"
#include "sampling/warp.h"
#include "unit/media/medium_scene.h"

namespace lampyr {
namespace {

struct MajorantCase {
  const char* name;
  std::string parameters;
};

void PrintTo(const MajorantCase& c, std::ostream* out) {
  *out << c.name;
}

// Random voxels, few of them bright, some of them on the sides.
std::string RandomVoxels(int count, uint64_t seed) {
  Rng rng(seed);
  std::string list = "[ ";
  for (int i = 0; i < count; ++i) {
    const float u = rng.NextFloat();
    list += u < 0.6f ? "0 " : std::to_string(u > 0.95f ? 100 * u : u) + " ";
  }
  return list + "]";
}

std::string Grid(int nx, int ny, int nz, int perVoxel, const std::string& what, uint64_t seed) {
  return "\"integer nx\" " + std::to_string(nx) + " \"integer ny\" " + std::to_string(ny) + " \"integer nz\" " +
         std::to_string(nz) + " " + what + " " + RandomVoxels(perVoxel * nx * ny * nz, seed) + " ";
}

std::vector<MajorantCase> Cases() {
  const std::string sigma = "\"rgb sigma_a\" [ 0.1 0.2 0.7 ] \"rgb sigma_s\" [ 3 0.2 0.3 ] \"float scale\" 1.7";
  return {
      {"small", "\"uniformgrid\" " + Grid(3, 4, 5, 1, "\"float density\"", 1) + sigma},
      {"sixteen", "\"uniformgrid\" " + Grid(16, 16, 16, 1, "\"float density\"", 2) + sigma},
      {"large", "\"uniformgrid\" " + Grid(150, 17, 33, 1, "\"float density\"", 3) + sigma},
      {"one", "\"uniformgrid\" " + sigma + " \"float density\" 2"},
      {"colours",
       "\"rgbgrid\" " + Grid(9, 8, 20, 3, "\"rgb sigma_a\"", 4) + "\"rgb sigma_s\" " + RandomVoxels(3 * 1440, 5)},
      {"colours_and_constant", "\"rgbgrid\" " + Grid(9, 8, 20, 3, "\"rgb sigma_s\"", 6) + "\"float scale\" 0.3"},
      {"cloud", "\"cloud\" \"rgb sigma_s\" [ 8 9 10 ]"},
      {"wispy_cloud", "\"cloud\" \"float density\" 3 \"float wispiness\" 20 \"float frequency\" 40"},
      {"thin_cloud", "\"cloud\" \"float density\" 0.1 \"point3 p0\" [ -1 0.4 0 ] \"point3 p1\" [ 2 1.5 1 ]"},
  };
}

class Majorants : public testing::TestWithParam<std::tuple<MajorantCase, const char*>> {};

constexpr const char* kPlacements[] = {"", "Translate 100 -30 20 Rotate 50 1 -2 3 Scale 10 0.2 -3"};

TEST_P(Majorants, BoundTheExtinction) {
  const auto& [medium, before] = GetParam();
  const auto made = MediumOf(medium.parameters, before);
  ASSERT_FALSE(made->IsHomogeneous());
  const MajorantGrid& majorants = *made->Majorants();
  const SceneDescription scene = Parse(InWorld(std::string(before) + " Shape \"sphere\""));
  const Transform& toRender = scene.shapes[0].placement.start;
  Rng rng(1);
  int inside = 0;
  const Transform gridToRender = medium.name == std::string("thin_cloud")
                                     ? toRender * Transform::Translate({-1, 0.4, 0}) * Transform::Scale({3, 1.1, 1})
                                     : toRender;
  for (int i = 0; i < 100000; ++i) {
    // Some exactly on borders of cells, and beside the box.
    Vector3d u(rng.NextFloat(), rng.NextFloat(), rng.NextFloat());
    if (i % 4 == 0) u = glm::round(u * 64.0) / 64.0;
    if (i % 10 == 0) u = u * 1.2 - 0.1;
    const Point3 p(gridToRender.Point(u));
    const float extinction = made->At(p).Extinction().Max(), bound = majorants.At(p);
    // At the sides of the box, one of the two may round to its outside.
    if (bound == 0 && glm::any(glm::greaterThan(glm::abs(u - 0.5), Vector3d(0.4999)))) continue;
    ASSERT_GE(bound, extinction) << "at " << u.x << ", " << u.y << ", " << u.z;
    inside += bound > 0;
  }
  EXPECT_GT(inside, 20000);
}

TEST_P(Majorants, BoundItAlongRays) {
  const auto& [medium, before] = GetParam();
  const auto made = MediumOf(medium.parameters, before);
  const SceneDescription scene = Parse(InWorld(std::string(before) + " Shape \"sphere\""));
  const Transform& toRender = scene.shapes[0].placement.start;
  Rng rng(2);
  int points = 0;
  for (int i = 0; i < 500; ++i) {
    const Point3 from(toRender.Point(3.0 * Vector3d(SampleUniformSphere(rng.NextPoint2()))));
    const Point3 to(toRender.Point({rng.NextFloat(), rng.NextFloat(), rng.NextFloat()}));
    const Ray ray{from, glm::normalize(to - from)};
    double last = 0;
    const RayDouble line{Point3d(ray.origin), Vector3d(ray.direction), 0, std::numeric_limits<double>::infinity()};
    made->Majorants()->Walk(line, [&](const MajorantSegment& segment) {
      EXPECT_GE(segment.tMin, last);
      last = segment.tMax;
      for (int k = 0; k < 10; ++k) {
        const auto t =
            static_cast<float>(segment.tMin + (segment.tMax - segment.tMin) * static_cast<double>(rng.NextFloat()));
        EXPECT_GE(segment.majorant, made->At(ray.origin + ray.direction * t).Extinction().Max());
        ++points;
      }
      return true;
    });
  }
  EXPECT_GE(points, 5000);
}

INSTANTIATE_TEST_SUITE_P(Media, Majorants, testing::Combine(testing::ValuesIn(Cases()), testing::ValuesIn(kPlacements)),
                         [](const auto& info) {
                           return std::string(std::get<0>(info.param).name) +
                                  (*std::get<1>(info.param) ? "_placed" : "");
                         });

// A blob of 40³ voxels: the mean bound is not far above the mean extinction, as one bound for all would be.
TEST(MajorantGrid, IsTightOverSmoothDensities) {
  std::string voxels = "[ ";
  for (int i = 0; i < 64000; ++i) {
    const Vector3d p = (Vector3d(i % 40, i / 40 % 40, i / 1600) - 19.5) / 40.0;
    voxels += std::to_string(std::exp(-20 * glm::dot(p, p))) + " ";
  }
  const auto medium = MediumOf(
      "\"uniformgrid\" \"integer nx\" 40 \"integer ny\" 40 \"integer nz\" 40 \"float density\" " + voxels + "]");
  Rng rng(5);
  double extinctions = 0, bounds = 0;
  for (int i = 0; i < 20000; ++i) {
    const Point3 p(rng.NextFloat(), rng.NextFloat(), rng.NextFloat());
    extinctions += static_cast<double>(medium->At(p).Extinction().Max());
    bounds += static_cast<double>(medium->Majorants()->At(p));
  }
  EXPECT_GT(bounds, extinctions);
  EXPECT_LT(bounds, 1.8 * extinctions);
  EXPECT_LT(bounds, 0.25 * 20000 * 2);  // one bound for all: 2
}

// The bounds of clouds rest on that of the noise.
TEST(Noise, StaysBelowItsBound) {
  Rng rng(3);
  float most = 0;
  for (int i = 0; i < 4000000; ++i) {
    const Vector3 u(rng.NextFloat(), rng.NextFloat(), rng.NextFloat());
    most = std::max(most, std::abs(Noise(u * 3000.0f)));
  }
  EXPECT_LT(most, 1.037f);
  EXPECT_GT(most, 0.9f);
}

TEST(Cloud, IsFullBelowAndThinsOutAbove) {
  const auto medium = MediumOf("\"cloud\" \"rgb sigma_a\" [ 1 1 1 ] \"rgb sigma_s\" [ 0 0 0 ]");
  Rng rng(4);
  double low = 0, high = 0;
  float least = 1, most = 0;
  for (int i = 0; i < 10000; ++i) {
    const Point3 p(rng.NextFloat(), rng.NextFloat(), rng.NextFloat());
    const float density = medium->At(p).absorption.r;
    ASSERT_GE(density, std::min(1.0f, 2 * std::max(0.0f, 0.5f - p.y)));
    ASSERT_LE(density, 1);
    (p.y < 0.75f ? low : high) += static_cast<double>(density);
    if (p.y > 0.5f) {
      least = std::min(least, density);
      most = std::max(most, density);
    }
  }
  EXPECT_EQ(least, 0);    // gaps
  EXPECT_GT(most, 0.7f);  // and clouds
  EXPECT_GT(low / 3, 2 * high);
  EXPECT_TRUE(medium->At({0.5f, 1, 0.5f}).absorption.IsBlack());
  EXPECT_TRUE(medium->At({0.5f, 0, 0.5f}).absorption == Color(1.0f));
  EXPECT_FALSE(medium->IsEmissive());
  const auto smooth = MediumOf("\"cloud\" \"float wispiness\" 0"), wispy = MediumOf("\"cloud\" \"float wispiness\" 1");
  int different = 0;
  for (int i = 0; i < 100; ++i) {
    const Point3 p(rng.NextFloat(), 0.3f + 0.4f * rng.NextFloat(), rng.NextFloat());
    different += smooth->At(p).absorption != wispy->At(p).absorption ? 1 : 0;
  }
  EXPECT_GT(different, 10);
}

TEST(CloudErrors, SayWhatWouldBeRight) {
  for (const char* name : {"density", "wispiness", "frequency"}) {
    const std::string parameter = std::string("\"cloud\" \"float ") + name + "\" ";
    EXPECT_NE(MediumError(parameter + "-1").find("must not be negative"), std::string::npos);
    EXPECT_NE(MediumError(parameter + "1e7").find("must be at most 1e6"), std::string::npos);
    EXPECT_EQ(MediumError(parameter + "1e6"), "no error");
  }
  EXPECT_NE(MediumError("\"cloud\" \"point3 p1\" [ 1e10 1 1 ]").find("within 1e9"), std::string::npos);
  EXPECT_NE(MediumError("\"cloud\" \"float scale\" 1").find("has no parameter \"scale\""), std::string::npos);
  EXPECT_NE(MediumError("\"cloud\" \"rgb Le\" [ 1 1 1 ]").find("has no parameter \"Le\""), std::string::npos);
}

}  // namespace
}  // namespace lampyr
