// Estimates of the bias of merging photons: their noise is not taken for bias, whatever the film is made of.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

#include "base/byte_stream.h"
#include "base/error.h"
#include "film/film.h"

namespace lampyr {
namespace {

constexpr int kSideOfBias = 48;
constexpr double kBound = 1.70710678118654752;

Film FilmOfBias() {
  Film film(kSideOfBias, kSideOfBias, {0, 0, kSideOfBias, kSideOfBias});
  film.KeepBias();
  return film;
}

// Adds a pass with `count` samples in a pixel, of which all have the same value: 1 and noise; and the estimate `bias`
// with as much noise.
void AddPass(Film& film, int x, int y, int count, double bias, double noise, std::mt19937& random) {
  std::normal_distribution<double> normal;
  const auto value = static_cast<float>(1 + 0.01 * normal(random)),
             own = static_cast<float>(bias + noise * normal(random));
  PassBias pass;
  PixelSums sums;
  for (int i = 0; i < count; ++i) {
    film.Pixel(x, y).Add(Color(value), 1);
    sums.Add(Color(value), 1);
    pass.Add(Color(own), 1);
  }
  film.AddBias(x, y, pass);
  if (film.IsAdaptive()) film.AddGroup(x, y, sums);
}

void AddPasses(Film& film, int passes, double bias, double noise, unsigned seed) {
  std::mt19937 random(seed);
  for (int pass = 0; pass < passes; ++pass) {
    for (int y = 0; y < kSideOfBias; ++y) {
      for (int x = 0; x < kSideOfBias; ++x) AddPass(film, x, y, 1, bias, noise, random);
    }
  }
}

TEST(FilmBias, NoiseIsNotTakenForBias) {
  Film film = FilmOfBias();
  AddPasses(film, 8, 0, 1, 3);
  EXPECT_LT(film.PartsOfError().bias, 0.15) << "the estimates have a noise of 0.35";
  Film biased = FilmOfBias();
  AddPasses(biased, 8, 0.5, 1, 4);
  EXPECT_NEAR(biased.PartsOfError().bias, kBound * 0.5, 0.03);
  EXPECT_NEAR(biased.RelativeError(), std::hypot(biased.PartsOfError().noise, biased.PartsOfError().bias), 1e-12);
}

TEST(FilmBias, IsSignedAndAMeanOfSamples) {
  Film film(1, 1, {0, 0, 1, 1});
  film.KeepBias();
  for (const float bias : {-3.0f, 1.0f}) {
    PassBias pass;
    pass.Add(Color(bias, 2 * bias, 0), 1);
    film.Pixel(0, 0).Add(Color(1.0f), 1);
    film.AddBias(0, 0, pass);
  }
  EXPECT_DOUBLE_EQ(film.Bias(0, 0), -1);
  EXPECT_DOUBLE_EQ(film.Bias(0, 1), -2);
  EXPECT_DOUBLE_EQ(film.Bias(0, 2), 0);
}

// Samples of a pass gather the same photons. Stages are weighted by their passes, however many samples they have.
TEST(FilmBias, OfStagesIsWithoutTheNoiseOfPasses) {
  for (const double bias : {0.0, 0.5}) {
    Film film(kSideOfBias, kSideOfBias, {0, 0, kSideOfBias, kSideOfBias});
    film.MakeAdaptive(true);
    film.KeepBias();
    std::mt19937 random(5);
    for (int pass = 0; pass < 8; ++pass) {
      for (int y = 0; y < kSideOfBias; ++y) {
        for (int x = 0; x < kSideOfBias; ++x) AddPass(film, x, y, pass < 4 ? 1 : 1 + (x + pass) % 5, bias, 1, random);
      }
      film.CountPasses(1);
      if (pass == 3) film.EndStage();
    }
    const double before = film.PartsOfError().bias, ofPixel = film.Bias(7, 0);
    EXPECT_NEAR(before, kBound * bias, bias > 0 ? 0.04 : 0.2);
    film.EndStage();
    EXPECT_NEAR(film.PartsOfError().bias, before, 1e-9);
    EXPECT_NEAR(film.Bias(7, 0), ofPixel, 1e-12);
  }
}

TEST(FilmBias, IsInTheErrorsOfPixelsNearby) {
  Film film = FilmOfBias(), sharp(kSideOfBias, kSideOfBias, {0, 0, kSideOfBias, kSideOfBias});
  std::mt19937 random(6);
  for (int y = 0; y < kSideOfBias; ++y) {
    for (int x = 0; x < kSideOfBias; ++x) {
      for (int pass = 0; pass < 16; ++pass) AddPass(film, x, y, 1, x < 24 ? 0.2 : 0, 0.01, random);
      sharp.Pixel(x, y) = film.Pixel(x, y);
    }
  }
  const std::vector<float> errors = film.PixelErrors(), without = sharp.PixelErrors();
  EXPECT_NEAR(errors[5], kBound * 0.2, 0.02);
  EXPECT_NEAR(errors[40], without[40], 0.02);
  EXPECT_LT(without[5], 0.02);
}

TEST(FilmBias, OfPartsAddsUp) {
  Film whole = FilmOfBias(), first = FilmOfBias(), second = FilmOfBias();
  AddPasses(first, 3, 0.5, 1, 7);
  AddPasses(second, 5, 0.5, 1, 8);
  AddPasses(whole, 3, 0.5, 1, 7);
  AddPasses(whole, 5, 0.5, 1, 8);
  Film sum(kSideOfBias, kSideOfBias, {0, 0, kSideOfBias, kSideOfBias});  // as `merge` makes it: of no kind yet
  sum.Add(first);
  sum.Add(second);
  EXPECT_EQ(sum.Bias(11, 1), whole.Bias(11, 1));
  EXPECT_NEAR(sum.PartsOfError().bias, whole.PartsOfError().bias, 1e-9);
  Film copy = whole.EmptyCopy();
  EXPECT_TRUE(copy.KeepsBias());
  EXPECT_EQ(copy.Bias(11, 1), 0);
  copy.CopyFrom(whole, 2);
  EXPECT_EQ(copy.PartsOfError().bias, whole.PartsOfError().bias);
}

std::string SavedBias(const Film& film) {
  std::string bytes;
  ByteWriter writer([&](const void* data, size_t count) { bytes.append(static_cast<const char*>(data), count); });
  film.Save(writer);
  return bytes;
}

void LoadBias(Film& film, const std::string& bytes) {
  ByteReader reader(std::as_bytes(std::span(bytes)));
  film.Load(reader);
  reader.CheckEnd();
}

TEST(FilmBias, IsSavedAndRead) {
  Film film = FilmOfBias();
  AddPasses(film, 4, 0.5, 1, 9);
  const std::string bytes = SavedBias(film);
  Film read(kSideOfBias, kSideOfBias, {0, 0, kSideOfBias, kSideOfBias});
  LoadBias(read, bytes);
  EXPECT_EQ(read.PartsOfError().bias, film.PartsOfError().bias);
  EXPECT_EQ(SavedBias(read), bytes);
}

// The saved films of other integrators are unchanged: their files can still be read.
TEST(FilmBias, OfFilmsWithoutItIsNotSaved) {
  Film film(2, 1, {0, 0, 2, 1});
  film.Pixel(0, 0).Add(Color(1.0f), 1);
  const std::string bytes = SavedBias(film);
  EXPECT_EQ(bytes.size(), 2 * sizeof(PixelSums) + 1);
  EXPECT_EQ(bytes.back(), '\0');
  EXPECT_EQ(film.Bias(0, 0), 0);
  EXPECT_EQ(film.PartsOfError().bias, 0);
  Film biased = film.EmptyCopy();
  biased.KeepBias();
  EXPECT_THROW(LoadBias(biased, bytes), Error) << "a render that goes on would have estimates of a part of its samples";
  EXPECT_THROW(LoadBias(film, bytes.substr(0, bytes.size() - 1) + '\4'), Error);
}

}  // namespace
}  // namespace lampyr
