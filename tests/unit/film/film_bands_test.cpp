// Bands of the spectrum: where they are, how samples, splats, stages and parts of a film add up in them.
#include <gtest/gtest.h>

#include "base/byte_stream.h"
#include "base/error.h"
#include "film/film.h"
#include "film/mix.h"

namespace lampyr {
namespace {

// Lanes of radiance 1 per unit of weight, in those bands.
LanesInBands Lanes(const std::array<int, 3>& bands, const std::array<double, 3>& weights) {
  LanesInBands lanes;
  for (size_t i = 0; i < 3; ++i) {
    lanes.band[i] = bands[i];
    lanes.weight[i] = weights[i];
    lanes.radiance[i] = static_cast<float>(weights[i]);
  }
  return lanes;
}

constexpr SpectralBands kFour{4, 400, 800};

TEST(SpectralBands, DivideTheirRange) {
  EXPECT_EQ(kFour.Width(), 100);
  const std::pair<double, int> cases[] = {{399.9, -1}, {400, 0}, {499.9, 0}, {500, 1},
                                          {799.9, 3},  {800, 3}, {800.1, -1}};
  for (const auto& [wavelength, band] : cases) EXPECT_EQ(kFour.Of(wavelength), band) << wavelength;
  EXPECT_EQ(SpectralBands().Of(500), -1);
}

TEST(SpectralBands, HaveChannelsOfThePublishedLayout) {
  EXPECT_EQ(LayersOfBands(kFour), (std::vector<std::string>{"S0.450,000nm S0.550,000nm S0.650,000nm", "S0.750,000nm"}));
  std::vector<std::string> layers = LayersOfBands(kFour);
  layers.insert(layers.begin(), "key");
  layers.emplace_back(kHalfLayer);
  const Film film(2, 1, {0, 0, 2, 1}, layers);
  EXPECT_EQ(film.SplitLayers(), 1u);
  EXPECT_TRUE(film.HasBands());
  EXPECT_TRUE(film.HasHalf());
  EXPECT_EQ(film.Develop().channels,
            (std::vector<std::string>{"R", "G", "B", "variance.R", "variance.G", "variance.B", "key.R", "key.G",
                                      "key.B", "S0.450,000nm", "S0.550,000nm", "S0.650,000nm", "S0.750,000nm", "half.R",
                                      "half.G", "half.B"}));
  EXPECT_FALSE(Film(2, 1, {0, 0, 2, 1}, {"key"}).HasBands());
}

float BandAt(const Image& image, int x, const std::string& band) {
  return image.At(x, 0, static_cast<size_t>(image.ChannelIndex("S0." + band + ",000nm")));
}

// Adds a pass in which the lanes have the values 1, 2 and 3, times `scale`.
void AddPass(Film& film, const LanesInBands& lanes, float scale = 1) {
  film.SetLanes(lanes);
  film.Pixel(1, 0).Add(Color(1.0f), 0.5f);
  film.AddToBands(1, 0, Color(scale, 2 * scale, 3 * scale), 0.5f);
  film.CountWhite({1, 1, 1});
}

void ExpectBands(const Image& image, const std::array<float, 4>& values) {
  const char* bands[] = {"450", "550", "650", "750"};
  for (size_t i = 0; i < 4; ++i) EXPECT_FLOAT_EQ(BandAt(image, 1, bands[i]), values[i]) << bands[i];
}

// The mean over the wavelengths that fell into a band, weighted by their densities, however many they are.
// Layers as a damaged checkpoint may name them.
TEST(SpectralBands, AreAFilmsLastLayersAndOfThree) {
  const PixelRect all{0, 0, 2, 1};
  const std::string bands = "S0.450,000nm S0.550,000nm S0.650,000nm";
  EXPECT_NO_THROW(Film(2, 1, all, {"key", bands, kHalfLayer}));
  EXPECT_THROW(Film(2, 1, all, {bands, "key"}), Error);
  EXPECT_THROW(Film(2, 1, all, {bands + " S0.750,000nm"}), Error);
}

TEST(SpectralBands, AreMeansOverTheirWavelengths) {
  std::vector<std::string> layers = LayersOfBands(kFour);
  layers.insert(layers.begin(), "key");
  Film film(2, 1, {0, 0, 2, 1}, layers);
  AddPass(film, Lanes({0, 1, -1}, {1, 4, 1}));
  ExpectBands(film.Develop(), {1, 2, 0, 0});
  AddPass(film, Lanes({1, 0, 3}, {2, 1, 0.5}));
  ExpectBands(film.Develop(), {1.5f, (4 * 2 + 2 * 1) / 6.0f, 0, 3});
  EXPECT_EQ(BandAt(film.Develop(), 0, "450"), 0);
  // Two parts of the passes, and a film that is saved.
  Film first = film.EmptyCopy(), second = film.EmptyCopy();
  AddPass(first, Lanes({0, 1, -1}, {1, 4, 1}));
  AddPass(second, Lanes({1, 0, 3}, {2, 1, 0.5}));
  first.Add(second);
  EXPECT_EQ(first.Develop().data, film.Develop().data);
  std::string bytes;
  ByteWriter writer([&](const void* data, size_t count) { bytes.append(static_cast<const char*>(data), count); });
  film.Save(writer);
  Film loaded = film.EmptyCopy();
  ByteReader reader(std::as_bytes(std::span(bytes)));
  loaded.Load(reader);
  reader.CheckEnd();
  EXPECT_EQ(loaded.Develop().data, film.Develop().data);
  Film copied = film.EmptyCopy();
  copied.CopyFrom(film, 1);
  EXPECT_EQ(copied.Develop().data, film.Develop().data);
}

TEST(SpectralBands, OfAnAdaptiveFilm) {
  Film film(2, 1, {0, 0, 2, 1}, LayersOfBands(kFour));
  film.MakeAdaptive(false);
  for (const float scale : {1.0f, 3.0f}) {
    for (int x : {0, 1}) film.Pixel(x, 0).Add(Color(1.0f), 1);
    AddPass(film, Lanes({0, 1, 2}, {1, 1, 1}), scale);
    film.CountPasses(1);
    film.EndStage();
  }
  const Image image = film.Develop();
  // Two samples of weights 1 and 0.5 in each stage; the first brings nothing to the bands.
  ExpectBands(image, {(0.5f + 1.5f) / 3, (1 + 3) / 3.0f, (1.5f + 4.5f) / 3, 0});
}

// Splats go to the bands of their lanes, as factors of their values.
TEST(SpectralBands, OfSplats) {
  PixelFilterSettings settings;
  settings.kind = PixelFilterSettings::Kind::Box;
  settings.radiusX = settings.radiusY = 0.5f;
  const PixelFilter box(settings);
  std::vector<std::string> layers = LayersOfBands(kFour);
  layers.emplace_back(kHalfLayer);
  Film film(2, 1, {0, 0, 2, 1}, layers);
  film.SetLanes(Lanes({3, -1, 0}, {2, 1, 4}));
  SplatList list = film.MakeSplatList(box, SensorResponse(0.5f));
  for (int path = 0; path < 4; ++path) {
    list.StartPath();
    EXPECT_TRUE(path != 2 || list.Add({1.5f, 0.5f}, Color(8, 16, 24)));
  }
  film.AddSplats(box, std::span(&list, 1), 1, 0);
  film.CountWhite({1, 1, 1});
  const Image image = film.Develop();
  EXPECT_FLOAT_EQ(image.At(1, 0, 0), 1);
  ExpectBands(image, {3, 0, 0, 1});
  EXPECT_EQ(BandAt(image, 0, "450"), 0);
}

TEST(SpectralBands, OfMixedPictures) {
  std::vector<std::string> layers = LayersOfBands({1, 400, 500});
  layers.insert(layers.begin(), {"key", "rest"});
  Film film(1, 1, {0, 0, 1, 1}, layers);
  film.SetLanes(Lanes({0, -1, -1}, {1, 1, 1}));
  film.Pixel(0, 0).Add(Color(1.0f), 1);
  film.AddToBands(0, 0, Color(5.0f), 1);
  film.CountWhite({1, 1, 1});
  Image image = film.Develop();
  image.metadata["lampyr.lightGroups"] = "key,rest";
  const auto band = [&](const Color& key, const Color& rest) {
    const Image mixed = MixLayers(image, {{"key", key}, {"rest", rest}});
    const int channel = mixed.ChannelIndex("S0.450,000nm");
    return channel < 0 ? -1 : mixed.At(0, 0, static_cast<size_t>(channel));
  };
  EXPECT_EQ(band(Color(1.0f), Color(1.0f)), 5);
  EXPECT_EQ(band(Color(0.5f), Color(0.5f)), 2.5f);
  EXPECT_EQ(band(Color(0.5f), Color(1.0f)), -1);
  EXPECT_EQ(band(Color(1, 0.5f, 1), Color(1, 0.5f, 1)), -1);
}

}  // namespace
}  // namespace lampyr
