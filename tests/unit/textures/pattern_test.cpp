// Values of the patterns and mappings by hand; noise by its properties.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "math/noise.h"
#include "sampling/rng.h"
#include "texture_scene.h"

namespace lampyr {
namespace {

TEST(Patterns, Bilerp) {
  const TextureScene scene("bilerp", false,
                           {FloatValue("v00", 1), FloatValue("v01", 2), FloatValue("v10", 4), FloatValue("v11", 8)});
  EXPECT_FLOAT_EQ(scene.FloatAt(0, 0), 1);
  EXPECT_FLOAT_EQ(scene.FloatAt(0, 1), 2);
  EXPECT_FLOAT_EQ(scene.FloatAt(1, 0), 4);
  EXPECT_FLOAT_EQ(scene.FloatAt(1, 1), 8);
  EXPECT_FLOAT_EQ(scene.FloatAt(0.5f, 0.25f), 0.375f * 1 + 0.125f * 2 + 0.375f * 4 + 0.125f * 8);
  const TextureScene defaults("bilerp", true, {});
  EXPECT_FLOAT_EQ(defaults.ColorAt(0.7f, 0.3f).g, 0.3f);
}

TEST(Patterns, ScaleAndMix) {
  const TextureScene scene(
      {MakeTexture("ramp", false, "bilerp", {FloatValue("v10", 1), FloatValue("v01", 0)}),
       MakeTexture("c", true, "bilerp",
                   {RgbValue("v00", 0, 0, 0), RgbValue("v10", 0, 0, 0), RgbValue("v01", 1, 0.5, 0),
                    RgbValue("v11", 1, 0.5, 0)}),
       MakeTexture("s", true, "scale", {TextureName("tex", "c"), TextureName("scale", "ramp")}),
       MakeTexture("t", true, "mix",
                   {TextureName("tex1", "s"), RgbValue("tex2", 0, 0, 1), TextureName("amount", "ramp")})});
  // ramp = u, c = v·(1, ½, 0), s = u·c, t = (1-u)·s + u·(0, 0, 1)
  const float u = 0.25f, v = 0.5f;
  const Color color = scene.ColorAt(u, v);
  EXPECT_NEAR(color.r, (1 - u) * u * v, 1e-6f);
  EXPECT_NEAR(color.g, (1 - u) * u * v * 0.5f, 1e-6f);
  EXPECT_NEAR(color.b, u, 1e-6f);
}

TEST(Patterns, Checkerboard2D) {
  const TextureScene scene("checkerboard", false,
                           {FloatValue("uscale", 4), FloatValue("vscale", 2), FloatValue("udelta", 1),
                            FloatValue("tex1", 5), FloatValue("tex2", 7)});
  for (const auto& [u, v] :
       {std::pair{0.1f, 0.1f}, {0.3f, 0.1f}, {-0.1f, 0.1f}, {0.1f, -0.1f}, {0.9f, 0.9f}, {-3.3f, -7.7f}}) {
    const int cells = static_cast<int>(std::floor(4 * u + 1) + std::floor(2 * v));
    EXPECT_EQ(scene.FloatAt(u, v), cells % 2 == 0 ? 5 : 7) << u << " " << v;
  }
}

TEST(Patterns, Checkerboard3DUsesTheTexturesPlace) {
  const Transform place = Transform::Translate({10, 0, 0}) * Transform::Scale({2, 2, 2});
  const TextureScene scene("checkerboard", false, {IntegerValue("dimension", 3)}, place);
  EXPECT_EQ(scene.FloatAt(0, 0, {11, 1, 1}), 1);   // cell (0,0,0)
  EXPECT_EQ(scene.FloatAt(0, 0, {9, 1, 1}), 0);    // (-1,0,0)
  EXPECT_EQ(scene.FloatAt(0, 0, {9, 3, 1}), 1);    // (-1,1,0)
  EXPECT_EQ(scene.FloatAt(0, 0, {13, 3, -1}), 0);  // (1,1,-1)
}

TEST(Patterns, WorldToRenderMovesTextures) {
  const TextureScene scene({MakeTexture("t", false, "checkerboard", {IntegerValue("dimension", 3)})},
                           Transform::Translate({0.5, 0, 0}));
  EXPECT_EQ(scene.FloatAt(0, 0, {0.6f, 0.1f, 0.1f}), 1);  // world x 0.1
  EXPECT_EQ(scene.FloatAt(0, 0, {0.4f, 0.1f, 0.1f}), 0);  // world x -0.1
}

// Noise has the values that follow from the permutation of [Perlin02].
TEST(Patterns, NoiseIsThatOfPerlin) {
  EXPECT_NEAR(Noise({3.14f, 42, 7}), 0.136919959f, 1e-5f);
  EXPECT_NEAR(Noise({-1.3f, 2.7f, 0.4f}), -0.118271942f, 1e-5f);
  EXPECT_NEAR(Noise({10.25f, -20.5f, 300.75f}), -0.260715475f, 1e-5f);
}

// Which cells of pbrt-v4's "dots" have one, the top row first.
TEST(Patterns, DotsAreInTheCellsOfPbrt) {
  const char* const rows[] = {".#.....#", ".#.###.#", ".#######"};
  const TextureScene scene("dots", false, {FloatValue("inside", 1), FloatValue("outside", 0)});
  for (int row = 0; row < 3; ++row) {
    for (int cell = 0; cell < 8; ++cell) {
      // The middles of the cells, in which every dot lies.
      const auto s = static_cast<float>(cell), t = static_cast<float>(7 - row);
      EXPECT_EQ(scene.FloatAt(s, t) > 0.5f, rows[row][cell] == '#') << row << " " << cell;
    }
  }
}

TEST(Patterns, DotsAreDisksInTwoFifthsOfTheCells) {
  const TextureScene scene("dots", false, {FloatValue("inside", 1), FloatValue("outside", 0)});
  int inside = 0;
  constexpr int side = 400, cells = 40;
  for (int i = 0; i < side; ++i) {
    for (int j = 0; j < side; ++j) {
      inside += scene.FloatAt((i + 0.5f) * cells / side - 0.5f, (j + 0.5f) * cells / side - 0.5f) > 0.5f ? 1 : 0;
    }
  }
  // A dot covers π 0.35² of its cell. A cell has one where the noise in its middle is positive, which is a sum of
  // sixteen halves of either sign over 8: with the probability (1 - C(16, 8) / 2^16) / 2. 1600 cells: ± 0.0123, four
  // deviations.
  EXPECT_NEAR(inside / static_cast<double>(side * side), 0.4018 * 3.14159 * 0.35 * 0.35, 0.385 * 0.05 + 0.01);
}

// The coordinates that a mapping gives, read through a bilinear ramp.
Point2 Mapped(std::vector<Parameter> mapping, const Point2& uv, const Point3& position,
              const Transform& transform = {}) {
  std::vector<Parameter> s = mapping, t = mapping;
  for (const auto& p : {FloatValue("v10", 1), FloatValue("v01", 0)}) s.push_back(p);
  const TextureScene along("bilerp", false, s, transform), across("bilerp", false, t, transform);
  return {along.FloatAt(uv.x, uv.y, position), across.FloatAt(uv.x, uv.y, position)};
}

TEST(Mappings, ByHand) {
  const auto near = [](const Point2& a, const Point2& b) {
    EXPECT_NEAR(a.x, b.x, 1e-5f);
    EXPECT_NEAR(a.y, b.y, 1e-5f);
  };
  near(Mapped({FloatValue("uscale", 2), FloatValue("vscale", 3), FloatValue("udelta", 0.5), FloatValue("vdelta", -1)},
              {0.25f, 0.5f}, {}),
       {1.0f, 0.5f});
  near(Mapped({StringValue("mapping", "spherical")}, {}, {0, 2, 0}), {0.5f, 0.25f});
  near(Mapped({StringValue("mapping", "spherical")}, {}, {0, -2, 0}), {0.5f, 0.75f});
  near(Mapped({StringValue("mapping", "spherical")}, {}, {0, 0, 3}), {0.0f, 0.0f});
  near(Mapped({StringValue("mapping", "spherical")}, {}, {1, 0, -1}), {0.75f, 0.0f});
  near(Mapped({StringValue("mapping", "cylindrical")}, {}, {0, 1, 7}), {0.75f, 7.0f});
  near(Mapped({StringValue("mapping", "planar"), VectorValue("v1", 2, 0, 0), VectorValue("v2", 0, 0, 1),
               FloatValue("udelta", 0.5)},
              {}, {1, 5, 3}),
       {2.5f, 3.0f});
  near(Mapped({StringValue("mapping", "planar")}, {}, {3, 4, 5}, Transform::Scale({2, 4, 1})), {1.5f, 1.0f});
  near(Mapped({StringValue("mapping", "spherical")}, {}, {0, 0, 0}), {0.0f, 0.0f});  // the centre: finite
}

TEST(NoiseField, ZeroAtLatticePointsSmoothAndBounded) {
  float largest = 0;
  for (int i = 0; i < 20000; ++i) {
    const Point3 p(0.137f * static_cast<float>(i % 97), 0.311f * static_cast<float>(i % 89),
                   0.173f * static_cast<float>(i % 101));
    const float value = Noise(p);
    largest = std::max(largest, std::abs(value));
    EXPECT_NEAR(Noise(p + Vector3(1e-3f, 1e-3f, -1e-3f)), value, 0.02f);
  }
  EXPECT_LE(largest, 1.05f);
  EXPECT_GT(largest, 0.5f);
  for (int i = -3; i < 4; ++i) EXPECT_EQ(Noise({static_cast<float>(i), 2.0f, -7.0f}), 0);
}

TEST(NoiseField, AroundAPointIsThatOfFourPoints) {
  Rng rng(7, 0);
  for (const float range : {0.02f, 3.0f, 300.0f, 1e6f, 1e12f}) {
    for (int i = 0; i < 2000; ++i) {
      const Point3 p(range * (2 * rng.NextFloat() - 1), range * (2 * rng.NextFloat() - 1),
                     range * (2 * rng.NextFloat() - 1));
      const float step = i % 2 == 0 ? 0.01f : 0.6f;  // mostly within a cell, and often beyond it
      const std::array<float, 4> around = NoiseAround(p, step);
      EXPECT_NEAR(around[0], Noise(p), 1e-6f);
      EXPECT_NEAR(around[1], Noise(p + Vector3(step, 0, 0)), 1e-6f);
      EXPECT_NEAR(around[2], Noise(p + Vector3(0, step, 0)), 1e-6f);
      EXPECT_NEAR(around[3], Noise(p + Vector3(0, 0, step)), 1e-6f);
    }
  }
}

TEST(NoiseField, CentredAndOfPeriod256) {
  double sum = 0, squares = 0, correlation = 0;
  constexpr int n = 20000;
  for (int i = 0; i < n; ++i) {
    // One point in each of n different cells: nearly independent values.
    const Point3 p(static_cast<float>(i % 100) + 0.5f, static_cast<float>(i / 100) + 0.5f, 0.25f);
    const double value = static_cast<double>(Noise(p)), shifted = static_cast<double>(Noise(p + Vector3(128, 0, 0)));
    EXPECT_EQ(Noise(p + Vector3(256, 0, -512)), Noise(p));
    sum += value;
    squares += value * value;
    correlation += value * shifted;
  }
  const double deviation = std::sqrt(squares / n);
  EXPECT_GT(deviation, 0.1);
  // Neighbours share gradients: their correlation widens the error of the mean by less than 3.
  EXPECT_NEAR(sum / n, 0, 4 * 3 * deviation / std::sqrt(n));
  EXPECT_NEAR(correlation / squares, 0, 4 * 3 / std::sqrt(n));
}

TEST(NoiseField, FiniteEverywhere) {
  for (const float x : {0.0f, -0.0f, 1e-30f, 1e6f, -1e9f, 1e20f, -3e38f}) {
    EXPECT_TRUE(std::isfinite(Noise({x, 0.3f, -x}))) << x;
    EXPECT_TRUE(std::isfinite(FractalNoise({x * 1e-10f, x * 1e-10f, 1.0f}, 0.5f, 8))) << x;
  }
}

TEST(NoiseTextures, SumsOfOctaves) {
  const Point3 p(0.3f, 1.7f, -2.2f);
  const TextureScene fbm("fbm", false, {IntegerValue("octaves", 2), FloatValue("roughness", 0.25)});
  EXPECT_FLOAT_EQ(fbm.FloatAt(0, 0, p), Noise(p) + 0.25f * Noise(p * 1.99f));
  const TextureScene wrinkled("wrinkled", false, {IntegerValue("octaves", 2), FloatValue("roughness", 0.25)});
  EXPECT_FLOAT_EQ(wrinkled.FloatAt(0, 0, p), std::abs(Noise(p)) + 0.25f * std::abs(Noise(p * 1.99f)));
  const TextureScene windy("windy", false, {});
  EXPECT_FLOAT_EQ(windy.FloatAt(0, 0, p), std::abs(FractalNoise(p * 0.1f, 0.5f, 3)) * FractalNoise(p, 0.5f, 6));
  const TextureScene none("fbm", false, {IntegerValue("octaves", 0)});
  EXPECT_EQ(none.FloatAt(0, 0, p), 0);
}

TEST(NoiseTextures, MarbleIsAnAlbedoOfKnownColours) {
  // Without variation the phase is y: at sin y = -1 the chain of colours starts, 1.5 · (0.58, 0.58, 0.6).
  const TextureScene scene("marble", true, {FloatValue("variation", 0), FloatValue("scale", 2)});
  const Color start = scene.ColorAt(0, 0, {0.4f, -kPi / 4, 9.0f});
  EXPECT_NEAR(start.r, 0.87f, 1e-4f);
  EXPECT_NEAR(start.b, 0.90f, 1e-4f);
  const TextureScene varied("marble", true, {});
  for (int i = 0; i < 1000; ++i) {
    const Color c = varied.ColorAt(0, 0, {0.01f * static_cast<float>(i), 0.1f * static_cast<float>(i), 3.0f});
    ASSERT_TRUE(c.IsValid());
    ASSERT_LE(c.Max(), 0.91f);
  }
}

}  // namespace
}  // namespace lampyr
