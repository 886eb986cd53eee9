// Films of parts of the samples, added up; films that are saved and read again.
#include <gtest/gtest.h>

#include <random>

#include "base/byte_stream.h"
#include "base/error.h"
#include "film/film.h"

namespace lampyr {
namespace {

constexpr int kSide = 6;

Film MakeFilm() {
  return {8, 8, {1, 1, 1 + kSide, 1 + kSide}, {"key", "rest"}};
}

// Samples and light paths [begin, end) of a render that is the same whoever makes which part of it.
void Render(Film& film, uint32_t begin, uint32_t end) {
  const PixelFilter filter({PixelFilterSettings::Kind::Mitchell, 2, 2});
  for (uint32_t index = begin; index < end; ++index) {
    std::mt19937 random(index);
    std::uniform_real_distribution<float> exponent(-4, 4), place(-1, 9), weight(-0.3f, 1.5f);
    const auto value = [&] { return Color(1, 0.5f, 0.1f) * std::pow(10.0f, exponent(random)); };
    SplatList splats = film.MakeSplatList(filter, 1);
    LayerSample layers(2);
    for (int y = 1; y <= kSide; ++y) {
      for (int x = 1; x <= kSide; ++x) {
        const Color color = value();
        const float w = weight(random);
        film.Pixel(x, y).Add(color, w);
        layers.Clear();
        layers.Add(random() % 2, color);
        film.AddToLayers(x, y, layers, 1, w);
        splats.StartPath();
        for (int i = 0; i < 2; ++i) {
          const Point2 at(place(random), place(random));
          const Color splat = value();
          splats.Add(at, splat);
          splats.AddToLayer(at, splat, Color(1.0f), static_cast<uint32_t>(random() % 2));
        }
      }
    }
    film.AddSplats(filter, std::span(&splats, 1), 1);
  }
}

TEST(FilmParts, AddUpToTheWhole) {
  Film whole = MakeFilm();
  Render(whole, 0, 100);
  for (const uint32_t at : {1u, 37u, 99u}) {
    Film first = MakeFilm(), second = MakeFilm();
    Render(first, 0, at);
    Render(second, at, 100);
    Film sum = MakeFilm();
    sum.Add(second);
    sum.Add(first);
    EXPECT_EQ(sum.Develop().data, whole.Develop().data) << at;
    EXPECT_EQ(sum.LightPaths(), whole.LightPaths());
    // This is only an estimate of the error of the image.
    EXPECT_NEAR(sum.RelativeError(), whole.RelativeError(), 0.2 * whole.RelativeError());
  }
}

TEST(FilmParts, WithoutSplatsAndWithThemCanBeAdded) {
  Film plain = MakeFilm(), withSplats = MakeFilm();
  plain.Pixel(2, 2).Add(Color(3), 1);
  Render(withSplats, 0, 3);
  Film both = MakeFilm();
  both.Add(plain);
  both.Add(withSplats);
  EXPECT_EQ(both.LightPaths(), withSplats.LightPaths());
  EXPECT_GT(both.Develop().RgbAt(1, 1).r, 0);
}

std::vector<std::byte> Saved(const Film& film) {
  std::vector<std::byte> bytes;
  ByteWriter writer([&](const void* from, size_t count) {
    const auto* first = static_cast<const std::byte*>(from);
    bytes.insert(bytes.end(), first, first + count);
  });
  film.Save(writer);
  return bytes;
}

TEST(FilmParts, GoesOnWhereItWasSaved) {
  Film whole = MakeFilm();
  Render(whole, 0, 20);
  Film saved = MakeFilm();
  Render(saved, 0, 9);
  const std::vector<std::byte> bytes = Saved(saved);
  Film loaded = MakeFilm();
  ByteReader reader(bytes);
  loaded.Load(reader);
  reader.CheckEnd();
  Render(loaded, 9, 20);
  EXPECT_EQ(Saved(loaded), Saved(whole));
  EXPECT_EQ(loaded.RelativeError(), whole.RelativeError());
}

TEST(FilmParts, WhatIsNoFilmLeavesTheFilmAsItWas) {
  Film film = MakeFilm();
  Render(film, 0, 2);
  const std::vector<std::byte> whole = Saved(film);
  Film other = MakeFilm();
  const std::vector<std::byte> empty = Saved(other);
  for (size_t size = 0; size < whole.size(); size += 97) {
    ByteReader reader(std::span<const std::byte>(whole).first(size));
    EXPECT_THROW(other.Load(reader), Error) << size;
  }
  std::vector<std::byte> notFinite = whole;
  for (size_t i = 8; i < 16; ++i) notFinite[i] = std::byte{0xff};
  ByteReader reader(notFinite);
  EXPECT_THROW(other.Load(reader), Error);
  EXPECT_EQ(Saved(other), empty);
}

}  // namespace
}  // namespace lampyr
