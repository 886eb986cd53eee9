// Splats: every pixel gets its filter's share and nothing is counted twice, at borders and corners as elsewhere; sums,
// variances and mixtures with camera samples; what the division into lists and threads must not change.
#include "film/splats.h"

#include <gtest/gtest.h>

#include <random>

#include "film/film.h"

namespace lampyr {
namespace {

using Kind = PixelFilterSettings::Kind;

PixelFilter Filter(Kind kind, float radius) {
  PixelFilterSettings settings;
  settings.kind = kind;
  settings.radiusX = settings.radiusY = radius;
  return PixelFilter(settings);
}

std::vector<Color> Pixels(const Film& film) {
  const Image image = film.Develop();
  std::vector<Color> pixels;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) pixels.push_back(image.RgbAt(x, y));
  }
  return pixels;
}

// One path with one splat of value 1.
Film WithSplat(const PixelFilter& filter, const Point2& place) {
  Film film(8, 6, {0, 0, 8, 6});
  std::vector<SplatList> lists(1, film.MakeSplatList(filter, 1));
  lists[0].StartPath();
  EXPECT_TRUE(lists[0].Add(place, Color(1.0f)));
  film.AddSplats(filter, lists, 2);
  return film;
}

TEST(Splats, ABoxGivesEverySplatToOnePixel) {
  const PixelFilter box = Filter(Kind::Box, 0.5f);
  for (const Point2 place :
       {Point2(3, 2), Point2(0, 0), Point2(2.5f, 3.5f), Point2(3, 2.999f), Point2(7.999f, 5.999f)}) {
    const std::vector<Color> pixels = Pixels(WithSplat(box, place));
    float sum = 0;
    for (const Color& pixel : pixels) sum += pixel.g;
    EXPECT_EQ(sum, 1) << place.x << " " << place.y;
    EXPECT_EQ(pixels[static_cast<size_t>(static_cast<int>(place.y) * 8 + static_cast<int>(place.x))].g, 1);
  }
  for (const Point2 outside : {Point2(-1e-4f, 2), Point2(8, 2), Point2(3, -1e-4f), Point2(3, 6)}) {
    for (const Color& pixel : Pixels(WithSplat(box, outside))) EXPECT_EQ(pixel.g, 0) << outside.x << " " << outside.y;
  }
}

TEST(Splats, PixelsGetTheFiltersValueAlsoFromBeyondTheBorder) {
  for (const auto& [kind, radius] : {std::pair{Kind::Triangle, 2.0f}, std::pair{Kind::Gaussian, 1.5f},
                                     std::pair{Kind::Mitchell, 2.0f}, std::pair{Kind::Sinc, 4.0f}}) {
    const PixelFilter filter = Filter(kind, radius);
    for (const Point2 place : {Point2(3.3f, 2.8f), Point2(0, 0), Point2(-0.7f, 6.4f), Point2(8.9f, -0.9f)}) {
      const Film film = WithSplat(filter, place);
      const Image image = film.Develop();
      for (int y = 0; y < 6; ++y) {
        for (int x = 0; x < 8; ++x) {
          const float expected =
              filter.Evaluate(place - Point2(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f));
          EXPECT_FLOAT_EQ(image.RgbAt(x, y).r, expected) << x << " " << y;
        }
      }
    }
  }
}

// All pixels get the value of a filter that is far wider than the film, in memory of the film's size.
TEST(Splats, AFilterMayBeFarWiderThanTheFilm) {
  for (const float radius : {7.0f, 1e6f, 1e30f}) {
    const PixelFilter box = Filter(Kind::Box, radius);
    for (const Color& pixel : Pixels(WithSplat(box, {4, 3}))) EXPECT_EQ(pixel.g, box.Evaluate({0, 0})) << radius;
  }
}

TEST(Splats, OnePathIsOneSampleOfAPixel) {
  // Four paths with 1 + 2, 0, 6 and 3 on a pixel: mean 3, sample variance (0 + 9 + 9 + 0)/3 = 6, of the mean 6/4.
  const PixelFilter box = Filter(Kind::Box, 0.5f);
  Film film(4, 4, {1, 1, 3, 3});
  std::vector<SplatList> lists(2, film.MakeSplatList(box, 1));
  lists[0].StartPath();
  lists[0].Add({1.2f, 1.3f}, Color(1.0f));
  lists[0].Add({1.8f, 1.9f}, Color(2.0f));
  lists[0].StartPath();
  lists[1].StartPath();
  lists[1].Add({1.5f, 1.5f}, Color(6.0f));
  lists[1].StartPath();
  lists[1].Add({1.5f, 1.5f}, Color(3.0f));
  film.AddSplats(box, lists, 1);
  EXPECT_EQ(film.LightPaths(), 4u);
  Image image = film.Develop();
  EXPECT_FLOAT_EQ(image.At(0, 0, 0), 3);
  EXPECT_FLOAT_EQ(image.At(0, 0, 3), 1.5f);
  EXPECT_EQ(image.At(1, 1, 0), 0);
  // With samples 2 and 4 from the camera: means and variances of the means (2/2 = 1) add up.
  for (const float value : {2.0f, 4.0f}) film.Pixel(1, 1).Add(Color(value), 1);
  image = film.Develop();
  EXPECT_FLOAT_EQ(image.At(0, 0, 0), 6);
  EXPECT_FLOAT_EQ(image.At(0, 0, 3), 2.5f);
}

// Without a splat there is no variance yet, although pixels that cameras alone see would be known to be black.
TEST(Splats, ABlackPictureHasNoErrorUntilLightPathsHadTheirChance) {
  const PixelFilter box = Filter(Kind::Box, 0.5f);
  Film film(1, 1, {0, 0, 1, 1});
  std::vector<SplatList> lists(1, film.MakeSplatList(box, 1));
  for (int i = 0; i < 4; ++i) lists[0].StartPath();
  film.AddSplats(box, lists, 1);
  EXPECT_TRUE(std::isinf(film.RelativeError()));
  for (int i = 4; i < 4096; ++i) lists[0].StartPath();
  film.AddSplats(box, lists, 1);
  EXPECT_EQ(film.RelativeError(), 0);
  Film seen(1, 1, {0, 0, 1, 1});
  for (int i = 0; i < 4; ++i) seen.Pixel(0, 0).Add(Color(), 1);
  EXPECT_EQ(seen.RelativeError(), 0);
}

TEST(Splats, RelativeErrorIsThatOfTheSum) {
  const PixelFilter box = Filter(Kind::Box, 0.5f);
  Film film(1, 1, {0, 0, 1, 1});
  std::vector<SplatList> lists(1, film.MakeSplatList(box, 1));
  lists[0].StartPath();
  film.AddSplats(box, lists, 1);
  EXPECT_TRUE(std::isinf(film.RelativeError()));
  lists[0].Clear();
  lists[0].StartPath();
  lists[0].Add({0.5f, 0.5f}, Color(2.0f));
  film.AddSplats(box, lists, 1);
  // 0 and 2: mean 1, variance of the mean 1, made by a single contribution: its upper end is that of Poisson's rate
  // after one event, half of what χ² with four degrees of freedom exceeds in a twentieth of cases.
  const double upper = std::sqrt(9.487729 / 2);
  EXPECT_NEAR(film.RelativeError(), 1.959964 * upper, 1e-5);
  for (int i = 0; i < 2; ++i) film.Pixel(0, 0).Add(Color(3.0f), 1);
  EXPECT_NEAR(film.RelativeError(), 1.959964 * upper / 4, 1e-5);
}

TEST(Splats, WhatIsNotANumberOrNegativeIsRefused) {
  Film film(1, 1, {0, 0, 1, 1});
  SplatList list = film.MakeSplatList(Filter(Kind::Box, 0.5f), 1);
  list.StartPath();
  const float infinity = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
  for (const float bad : {nan, infinity, -1.0f}) EXPECT_FALSE(list.Add({0.5f, 0.5f}, Color(1, bad, 1)));
  EXPECT_TRUE(list.Add({nan, 0.5f}, Color(1.0f)));  // lies nowhere
  EXPECT_TRUE(list.Splats().empty());
}

TEST(Splats, DivisionIntoListsCallsAndThreadsDoesNotShow) {
  const PixelFilter filter = Filter(Kind::Gaussian, 1.5f);
  const PixelRect crop{3, 2, 30, 29};
  const auto render = [&](uint32_t pathsPerList, size_t listsPerCall, int threads) {
    Film film(32, 32, crop);
    std::vector<SplatList> lists(listsPerCall, film.MakeSplatList(filter, 0.7f));
    std::mt19937 generator(5);
    std::uniform_real_distribution<float> place(-2, 34), value(0, 1);
    uint32_t left = 3000;
    while (left > 0) {
      for (SplatList& list : lists) {
        list.Clear();
        for (uint32_t i = 0; i < pathsPerList && left > 0; ++i, --left) {
          list.StartPath();
          for (int k = 0; k < static_cast<int>(left % 4); ++k) {
            const float x = place(generator), y = place(generator), v = value(generator);
            list.Add({x, y}, Color(v));
          }
        }
      }
      film.AddSplats(filter, lists, threads);
    }
    EXPECT_EQ(film.LightPaths(), 3000u);
    return film.Develop().data;
  };
  const std::vector<float> reference = render(3000, 1, 1);
  EXPECT_EQ(render(17, 5, 1), reference);
  EXPECT_EQ(render(100, 7, 3), reference);
  EXPECT_EQ(render(1, 64, 4), reference);
}

}  // namespace
}  // namespace lampyr
