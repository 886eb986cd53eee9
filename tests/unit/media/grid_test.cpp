// Media on grids of voxels: interpolation, placement, emission.
#include <gmock/gmock.h>

#include <cmath>
#include <functional>

#include "media/voxels.h"
#include "sampling/rng.h"
#include "scene/spectrum.h"
#include "unit/media/medium_scene.h"

namespace lampyr {
namespace {

using testing::HasSubstr;

std::string Number(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g ", x);
  return text;
}

// A list of the values of `f` at the centres of the voxels, in the unit cube.
std::string VoxelsOf(int nx, int ny, int nz, const std::function<double(const Point3d&)>& f) {
  std::string list = "[ ";
  for (int z = 0; z < nz; ++z) {
    for (int y = 0; y < ny; ++y) {
      for (int x = 0; x < nx; ++x) list += Number(f({(x + 0.5) / nx, (y + 0.5) / ny, (z + 0.5) / nz}));
    }
  }
  return list + "]";
}

double Trilinear(const Point3d& p) {
  return 1 + 2 * p.x + 3 * p.y + 0.5 * p.z + p.x * p.y - 0.25 * p.y * p.z + 4 * p.x * p.y * p.z;
}

constexpr const char* kSize = "\"integer nx\" 5 \"integer ny\" 3 \"integer nz\" 4 ";

TEST(UniformGrid, InterpolatesTrilinearFunctionsExactly) {
  const auto medium =
      MediumOf(std::string("\"uniformgrid\" ") + kSize + "\"float density\" " + VoxelsOf(5, 3, 4, Trilinear) +
               " \"rgb sigma_a\" [ 1 2 3 ] \"rgb sigma_s\" [ 4 0 6 ] \"float scale\" 2 \"float g\" 0.3");
  EXPECT_FALSE(medium->IsHomogeneous());
  EXPECT_FALSE(medium->IsEmissive());
  EXPECT_EQ(medium->Bytes(), 60 * sizeof(float));
  EXPECT_EQ(medium->Asymmetry(), 0.3f);
  Rng rng(1);
  for (int i = 0; i < 2000; ++i) {
    const Vector3 u(rng.NextFloat(), rng.NextFloat(), rng.NextFloat());
    const Vector3 half(0.1f, 1.0f / 6, 0.125f);  // of a voxel
    const Point3 p = half + u * (Vector3(1.0f) - 2.0f * half);
    const auto expected = static_cast<float>(Trilinear(Point3d(p)));
    const MediumCoefficients at = medium->At(p);
    ASSERT_NEAR(at.absorption.r, 2 * expected, 2e-5f);
    ASSERT_NEAR(at.absorption.b, 6 * expected, 6e-5f);
    ASSERT_NEAR(at.scattering.r, 8 * expected, 8e-5f);
    ASSERT_EQ(at.scattering.g, 0);
    ASSERT_TRUE(at.emission.IsBlack());
  }
}

TEST(UniformGrid, FallsOffToItsSidesAndIsEmptyOutside) {
  const auto medium = MediumOf(
      "\"uniformgrid\" \"integer nx\" 2 \"float density\" [ 3 5 ] \"point3 p0\" [ 4 1 3 ] "
      "\"point3 p1\" [ 0 0 1 ]");
  // Its box is that of the corners in order: x from 0 to 4, y to 1, z from 1 to 3. The voxels' centres:
  EXPECT_EQ(medium->At({1, 0.5f, 2}).absorption.g, 3);
  EXPECT_EQ(medium->At({3, 0.5f, 2}).absorption.g, 5);
  EXPECT_EQ(medium->At({2, 0.5f, 2}).absorption.g, 4);
  // Half of it on the sides.
  EXPECT_EQ(medium->At({0, 0.5f, 2}).absorption.g, 1.5f);
  EXPECT_EQ(medium->At({4, 0.5f, 2}).absorption.g, 2.5f);
  EXPECT_EQ(medium->At({3, 0, 2}).absorption.g, 2.5f);
  EXPECT_EQ(medium->At({3, 1, 3}).absorption.g, 1.25f);
  for (const Point3& p : {Point3(-1e-6f, 0.5f, 2), Point3(4.00001f, 0.5f, 2), Point3(2, 1.00001f, 2),
                          Point3(2, 0.5f, 0.9999f), Point3(NAN, 0.5f, 2), Point3(2, kInfinity, 2)}) {
    EXPECT_TRUE(medium->At(p).Extinction().IsBlack());
  }
}

// Coefficients are those of render space, whatever the transform does to the grid.
TEST(UniformGrid, GoesWhereItIsPlaced) {
  const std::string density = "\"float density\" " + VoxelsOf(5, 3, 4, Trilinear);
  const auto local = MediumOf(std::string("\"uniformgrid\" ") + kSize + density);
  const std::string before = "Translate 3 4 5 Rotate 40 1 2 3 Scale 2 -3 0.5";
  const Transform toWorld =
      Transform::Translate({3, 4, 5}) * Transform::Rotate(40, {1, 2, 3}) * Transform::Scale({2, -3, 0.5});
  const Transform renderFromWorld = Transform::Translate({-10, 20, 0}) * Transform::Rotate(90, {0, 1, 0});
  const auto placed = MediumOf(std::string("\"uniformgrid\" ") + kSize + density, before, renderFromWorld);
  Rng rng(2);
  for (int i = 0; i < 1000; ++i) {
    const Point3 p(rng.NextFloat(), rng.NextFloat(), rng.NextFloat());
    const float expected = local->At(p).absorption.r;
    const Point3 render((renderFromWorld * toWorld).Point(Point3d(p)));
    // Rounding moves the point by a few units in the last place of 20.
    ASSERT_NEAR(placed->At(render).absorption.r, expected, 2e-4f) << i;
  }
}

TEST(UniformGrid, EmitsByAColourAndAScale) {
  const auto plain = MediumOf(R"("uniformgrid" "float density" 2 "rgb sigma_a" [ 1 2 0 ] "rgb Le" [ 3 4 5 ])");
  EXPECT_TRUE(plain->IsEmissive());
  EXPECT_EQ(plain->At(Point3(0.5f)).emission, Color(6, 16, 0));
  EXPECT_EQ(plain->At({0, 0.5f, 0.5f}).emission, Color(3, 8, 0));  // the scale of 1 does not fall off
  const auto scaled = MediumOf(R"("uniformgrid" "integer nx" 2 "float density" [ 1 1 ] "float Lescale" [ 0 4 ]
    "rgb Le" [ 1 1 1 ])");
  EXPECT_EQ(scaled->At({0.25f, 0.5f, 0.5f}).emission, Color(0.0f));
  EXPECT_EQ(scaled->At({0.75f, 0.5f, 0.5f}).emission, Color(4.0f));
  EXPECT_EQ(scaled->At({0.5f, 0.5f, 0.5f}).emission, Color(2.0f));
  EXPECT_EQ(scaled->Bytes(), 4 * sizeof(float));
  EXPECT_FALSE(MediumOf(R"("uniformgrid" "float density" 1 "rgb Le" [ 1 1 1 ] "float Lescale" 0)")->IsEmissive());
  EXPECT_FALSE(MediumOf(R"("uniformgrid" "float density" 0 "rgb Le" [ 1 1 1 ])")->IsEmissive());
}

TEST(UniformGrid, EmitsByTemperature) {
  for (const double kelvin : {150.0, 700.0, 1234.0, 2500.0, 6500.0, 30000.0, 1e6}) {
    const auto medium = MediumOf(
        "\"uniformgrid\" \"float density\" 0.5 \"rgb sigma_a\" [ 2 1 1 ] \"float temperature\" " +
        Number(kelvin / 10 + 20) + "\"float temperaturescale\" 10 \"float temperatureoffset\" 20 \"float Lescale\" 3");
    EXPECT_TRUE(medium->IsEmissive());
    const Color expected = NormalizedBlackbody(kelvin) * Color(3, 1.5f, 1.5f),
                found = medium->At(Point3(0.5f)).emission;
    EXPECT_NEAR(found.r, expected.r, 1e-3f * expected.r) << kelvin;
    EXPECT_NEAR(found.g, expected.g, 2e-3f * expected.Max()) << kelvin;
    EXPECT_NEAR(found.b, expected.b, 2e-3f * expected.Max()) << kelvin;
  }
  // The temperature is interpolated, not the light: between 0 and 4000 K there are 2000 K.
  const auto between =
      MediumOf(R"("uniformgrid" "integer nx" 2 "float density" [ 1 1 ] "float temperature" [ 0 4000 ])");
  const Color half = between->At(Point3(0.5f)).emission;
  EXPECT_NEAR(half.r, NormalizedBlackbody(2000).r, 1e-3f * half.r);
  EXPECT_TRUE(between->At({0.25f, 0.5f, 0.5f}).emission.IsBlack());
  // Gas of 100 K and below is dark.
  const auto cold =
      MediumOf(R"("uniformgrid" "float density" 1 "float temperature" 5000 "float temperaturecutoff" 4900)");
  EXPECT_FALSE(cold->IsEmissive());
  EXPECT_TRUE(cold->At(Point3(0.5f)).emission.IsBlack());
}

TEST(RgbGrid, HasColoursByVoxel) {
  const auto medium = MediumOf(R"("rgbgrid" "integer nz" 2 "rgb sigma_a" [ 1 2 3 3 4 5 ] "rgb sigma_s" [ 0 1 0 2 1 0 ]
    "rgb Le" [ 1 1 1 5 0 1 ] "float Lescale" 2 "float scale" 3 "float g" 0.5 "point3 p1" [ 1 1 2 ])");
  EXPECT_EQ(medium->Asymmetry(), 0.5f);
  EXPECT_TRUE(medium->IsEmissive());
  EXPECT_EQ(medium->Bytes(), 6 * sizeof(Color));
  const MediumCoefficients low = medium->At({0.5f, 0.5f, 0.5f}), middle = medium->At({0.5f, 0.5f, 1});
  EXPECT_EQ(low.absorption, Color(3, 6, 9));
  EXPECT_EQ(low.scattering, Color(0, 3, 0));
  EXPECT_EQ(low.emission, Color(6, 12, 18));
  EXPECT_EQ(middle.absorption, Color(6, 9, 12));
  EXPECT_EQ(middle.scattering, Color(3, 3, 0));
  EXPECT_EQ(middle.emission, Color(36, 9, 24));
  EXPECT_TRUE(medium->At({0.5f, 0.5f, 2.1f}).Extinction().IsBlack());
  // A coefficient that is not given is 1 all over the box.
  const auto half = MediumOf(R"("rgbgrid" "rgb sigma_s" [ 2 2 2 ] "float scale" 0.5)");
  EXPECT_EQ(half->At(Point3(0.0f)).absorption, Color(0.5f));
  EXPECT_EQ(half->At(Point3(0.0f)).scattering, Color(0.125f));
  EXPECT_FALSE(half->IsEmissive());
}

TEST(GridErrors, SayWhatWouldBeRight) {
  EXPECT_EQ(MediumError("\"uniformgrid\" \"integer nx\" 2 \"float density\" [ 1 2 3 ]"),
            "scene.pbrt:2:64: error: \"density\" of MakeNamedMedium \"m\" needs a value for each of the nx · ny · nz = "
            "2 · 1 · 1 voxels, and has 3");
  EXPECT_THAT(MediumError("\"uniformgrid\" \"integer nx\" 2"),
              HasSubstr("scene.pbrt:2:1: error: MakeNamedMedium \"m\" needs \"float density\""));
  // 2^32 · 2^32 is 0 in 64 bits, and 65536³ is 0 in 32.
  for (const char* n : {"65536", "2147483647", "4096"}) {
    const std::string all = std::string("\"integer nx\" ") + n + " \"integer ny\" " + n + " \"integer nz\" " + n;
    EXPECT_THAT(MediumError("\"uniformgrid\" " + all + " \"float density\" [ 1 2 ]"), HasSubstr("voxels, and has 2"));
    EXPECT_THAT(MediumError("\"rgbgrid\" " + all + " \"rgb sigma_a\" [ 1 2 3 ]"), HasSubstr("voxels, and has 1"));
  }
  for (const char* n : {"0", "-1"}) {
    EXPECT_EQ(MediumError(std::string("\"uniformgrid\" \"float density\" 1 \"integer ny\" ") + n),
              "scene.pbrt:2:67: error: \"ny\" must be at least 1");
  }
  EXPECT_EQ(
      MediumError("\"uniformgrid\" \"integer ny\" 3 \"float density\" [ 1 2 -3 ]"),
      "scene.pbrt:2:64: error: \"density\" of MakeNamedMedium \"m\" has a negative value, that of voxel 2 (counted "
      "from 0)");
  EXPECT_THAT(MediumError("\"uniformgrid\" \"float density\" nan"), HasSubstr("scene.pbrt:2:"));
  EXPECT_THAT(MediumError("\"uniformgrid\" \"float density\" [ inf ]"), HasSubstr("scene.pbrt:2:"));
  EXPECT_THAT(MediumError("\"uniformgrid\" \"float density\" 1 \"float temperature\" [ 1 2 ]"),
              HasSubstr("2:67: error: \"temperature\""));
  EXPECT_THAT(MediumError("\"uniformgrid\" \"float density\" 1 \"float temperature\" 2e6"),
              HasSubstr("2:67: error: the temperatures of this medium reach more than 1e6 K"));
  EXPECT_THAT(MediumError("\"uniformgrid\" \"float density\" 1 \"float temperature\" 9 \"rgb Le\" [ 1 1 1 ]"),
              HasSubstr("\"Le\" and \"temperature\" exclude each other"));
  EXPECT_THAT(MediumError("\"uniformgrid\" \"float density\" 1 \"float Lescale\" -1"), HasSubstr("negative value"));
  EXPECT_THAT(MediumError("\"uniformgrid\" \"float density\" 1e38 \"float scale\" 10"),
              HasSubstr("leaves the range of floats"));
  EXPECT_THAT(MediumError("\"uniformgrid\" \"float density\" 1 \"point3 p1\" [ 1 0 1 ]"),
              HasSubstr("2:67: error: \"p0\" and \"p1\" have the same y: the box of this medium is empty"));
  EXPECT_THAT(MediumError("\"uniformgrid\" \"float densty\" 1"), HasSubstr("2:1: error"));
  EXPECT_THAT(MediumError("\"uniformgrid\" \"float density\" 1 \"float sacle\" 1"),
              HasSubstr("did you mean \"scale\"?"));
  EXPECT_THAT(MediumError("\"rgbgrid\""), HasSubstr("2:1: error: MakeNamedMedium \"m\" needs \"rgb sigma_a\" or"));
  EXPECT_THAT(MediumError("\"rgbgrid\" \"rgb sigma_s\" [ 1 1 1 ] \"rgb Le\" [ 1 1 1 ]"),
              HasSubstr("\"Le\" of MakeNamedMedium \"m\" needs \"rgb sigma_a\""));
  EXPECT_THAT(MediumError("\"rgbgrid\" \"rgb sigma_s\" [ 1 1 1 ] \"rgb sigma_a\" [ 1 1 1 2 2 2 ]"),
              HasSubstr("\"sigma_a\""));
  EXPECT_THAT(MediumError("\"rgbgrid\" \"rgb sigma_s\" [ 1 -1 1 ]"), HasSubstr("negative component"));
}

TEST(GridErrors, MemoryIsCountedBeforeItIsTaken) {
  const std::string grid =
      std::string("\"uniformgrid\" ") + kSize + "\"float density\" " + VoxelsOf(5, 3, 4, Trilinear);
  EXPECT_EQ(MediumError(grid, 240), "no error");
  EXPECT_THAT(MediumError(grid, 239),
              HasSubstr("error: the voxels of \"density\" of MakeNamedMedium \"m\" take 240 bytes"));
  EXPECT_THAT(MediumError("\"rgbgrid\" \"rgb sigma_a\" [ 1 1 1 ]", 11), HasSubstr("error: the voxels of \"sigma_a\""));
}

}  // namespace
}  // namespace lampyr
