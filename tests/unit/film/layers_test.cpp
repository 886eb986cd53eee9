// Layers: parts of samples and splats add up to the picture, whatever is negative, cropped or cut into lists.
#include <gtest/gtest.h>

#include <random>

#include "film/film.h"

namespace lampyr {
namespace {

constexpr const char* kRgb[] = {".R", ".G", ".B"};

PixelFilter Mitchell() {
  PixelFilterSettings settings;
  settings.kind = PixelFilterSettings::Kind::Mitchell;
  settings.radiusX = settings.radiusY = 2;
  return PixelFilter(settings);
}

TEST(LayerSample, KeepsPartsApartAndForgetsThem) {
  LayerSample sample(5);
  EXPECT_TRUE(sample.Met().empty());
  sample.Add(3, Color(1, 2, 3));
  sample.Add(0, Color(0.5f));
  sample.Add(3, Color(10, 20, 30));
  EXPECT_EQ(sample.Met(), (std::vector<uint32_t>{3, 0}));
  EXPECT_EQ(sample.Sum(3, 0), 11);
  EXPECT_EQ(sample.Sum(3, 2), 33);
  EXPECT_EQ(sample.Sum(0, 1), 0.5);
  sample.Clear();
  EXPECT_TRUE(sample.Met().empty());
  EXPECT_EQ(sample.Sum(3, 0), 0);
  sample.Add(3, Color(4.0f));
  EXPECT_EQ(sample.Sum(3, 0), 4);
}

TEST(FilmLayers, AreWeightedAsThePictureIs) {
  Film film(4, 4, {1, 1, 3, 3}, {"a", "b"});
  LayerSample sample(2);
  film.Pixel(2, 1).Add(Color(3.0f), 0.5f);
  sample.Add(0, Color(1.0f));
  sample.Add(1, Color(0.5f));
  film.AddToLayers(2, 1, sample, 2, 0.5f);
  film.Pixel(2, 1).Add(Color(8.0f), 1.5f);
  sample.Clear();
  sample.Add(1, Color(4.0f));
  film.AddToLayers(2, 1, sample, 2, 1.5f);
  const Image image = film.Develop();
  ASSERT_EQ(image.channels.size(), 12u);
  for (size_t c = 0; c < 3; ++c) {
    EXPECT_EQ(image.channels[6 + c], std::string("a") + kRgb[c]);
    EXPECT_EQ(image.channels[9 + c], std::string("b") + kRgb[c]);
    EXPECT_FLOAT_EQ(image.At(1, 0, c), (0.5f * 3 + 1.5f * 8) / 2);
    EXPECT_FLOAT_EQ(image.At(1, 0, 6 + c), 0.5f * 2 / 2);
    EXPECT_FLOAT_EQ(image.At(1, 0, 9 + c), (0.5f * 1 + 1.5f * 8) / 2);
    EXPECT_EQ(image.At(0, 0, 6 + c), 0);
    EXPECT_EQ(image.At(0, 1, 9 + c), 0);
  }
}

// Random samples and splats, in as many lists as `cut` says.
Image Random(size_t listCount, int threads, std::vector<std::string> layers) {
  const PixelFilter filter = Mitchell();
  Film film(12, 9, {2, 1, 11, 8}, std::move(layers));
  std::mt19937 rng(7);
  std::uniform_real_distribution<float> u(0, 1);
  const size_t count = film.Layers().size();
  for (int y = 1; y < 8; ++y) {
    for (int x = 2; x < 11; ++x) {
      for (int i = 0; i < 5; ++i) {
        LayerSample sample(count);
        Color sum;
        for (uint32_t layer = 0; layer < 3; ++layer) {
          const Color part(u(rng), u(rng), u(rng));
          sum += part;
          if (count > 0) sample.Add(layer, part);
        }
        const float weight = u(rng) < 0.2f ? -0.3f : 1.3f;
        film.Pixel(x, y).Add(sum * 0.7f, weight);
        if (count > 0) film.AddToLayers(x, y, sample, 0.7f, weight);
      }
    }
  }
  constexpr size_t paths = 600;
  std::vector<SplatList> lists(listCount, film.MakeSplatList(filter, 1.7f));
  for (size_t i = 0; i < paths; ++i) {
    SplatList& list = lists[i * listCount / paths];
    list.StartPath();
    for (uint32_t k = 0; k < 3; ++k) {
      const Point2 at(14 * u(rng) - 1, 11 * u(rng) - 1);
      const Color value(u(rng), u(rng), u(rng)), share(u(rng), u(rng), u(rng));
      list.Add(at, value);
      if (count == 0) continue;
      list.AddToLayer(at, value, share, static_cast<uint32_t>(i + k) % 3);
      list.AddToLayer(at, value, Color(1.0f) - share, static_cast<uint32_t>(i + k + 1) % 3);
    }
  }
  film.AddSplats(filter, lists, threads);
  return film.Develop();
}

TEST(FilmLayers, AddUpToThePictureAndLeaveItAsItIs) {
  const Image with = Random(4, 2, {"a", "b", "c"}), without = Random(4, 2, {});
  ASSERT_EQ(without.channels.size(), 7u);  // with kSplatShareChannel
  for (int y = 0; y < with.height; ++y) {
    for (int x = 0; x < with.width; ++x) {
      for (size_t c = 0; c < 6; ++c) ASSERT_EQ(with.At(x, y, c), without.At(x, y, c));
      for (size_t c = 0; c < 3; ++c) {
        double sum = 0, size = 0;
        for (size_t layer = 0; layer < 3; ++layer) {
          const auto value = static_cast<double>(with.At(x, y, 6 + 3 * layer + c));
          EXPECT_NE(value, 0);
          sum += value;
          size += std::abs(value);
        }
        EXPECT_NEAR(static_cast<double>(with.At(x, y, c)), sum, 2 * 0x1p-23 * size) << x << " " << y;
      }
    }
  }
}

TEST(FilmLayers, AreTheSameForAnyListsAndThreads) {
  const Image once = Random(1, 1, {"a", "b", "c"});
  EXPECT_EQ(Random(7, 3, {"a", "b", "c"}).data, once.data);
  EXPECT_EQ(Random(3, 1, {"a", "b", "c"}).data, once.data);
}

TEST(FilmLayers, TakeTheMemoryThatIsTold) {
  EXPECT_EQ(Film::BytesPerPixel(0, false), sizeof(PixelSums));
  EXPECT_EQ(Film::BytesPerPixel(0, true), sizeof(PixelSums) + sizeof(SplatSums));
  EXPECT_EQ(Film::BytesPerPixel(10, false), sizeof(PixelSums) + 10 * 48);
  EXPECT_EQ(Film::BytesPerPixel(10, true), sizeof(PixelSums) + sizeof(SplatSums) + 10 * 96);
}

}  // namespace
}  // namespace lampyr
