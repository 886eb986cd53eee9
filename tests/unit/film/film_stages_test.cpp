// Adaptive films: the mean of stages is unbiased, whatever the stages before have decided, and its variance is what it
// states.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

#include "base/byte_stream.h"
#include "film/film.h"

namespace lampyr {
namespace {

Film OnePixel(bool hasGroups = false) {
  Film film(1, 1, {0, 0, 1, 1});
  film.MakeAdaptive(hasGroups);
  return film;
}

float ValueOf(const Film& film) {
  return film.Develop().At(0, 0, 0);
}

// Calls visit(probability, film, mean over all samples) for all outcomes of a pixel that sees light in `hit` of its
// samples: two passes with two samples in all, and two more with as many as `decide(hits of the first two)` says.
template <class Decide, class Visit>
void ForAllOutcomes(double hit, const Decide& decide, const Visit& visit) {
  for (int first = 0; first < 4; ++first) {
    const int hits = (first & 1) + (first >> 1);
    const int second = decide(hits);
    for (int outcome = 0; outcome < 1 << second; ++outcome) {
      Film film = OnePixel();
      double probability = 1;
      int all = 0;
      const auto add = [&](bool isHit) {
        film.Pixel(0, 0).Add(Color(isHit ? 1.0f : 0.0f), 1);
        probability *= isHit ? hit : 1 - hit;
        all += isHit ? 1 : 0;
      };
      add((first & 1) != 0);
      add((first & 2) != 0);
      film.CountPasses(2);
      film.EndStage();
      for (int i = 0; i < second; ++i) add((outcome >> i & 1) != 0);
      film.CountPasses(2);
      visit(probability, film, static_cast<double>(all) / (2 + second));
    }
  }
}

TEST(FilmStages, TheMeanOfStagesIsUnbiased) {
  constexpr double kHit = 0.3;
  double ofStages = 0, ofSamples = 0;
  // More samples where there was light.
  ForAllOutcomes(
      kHit, [](int hits) { return hits == 0 ? 1 : 3 * hits; },
      [&](double probability, const Film& film, double meanOfSamples) {
        ofStages += probability * static_cast<double>(ValueOf(film));
        ofSamples += probability * meanOfSamples;
      });
  EXPECT_NEAR(ofStages, kHit, 1e-7);
  EXPECT_GT(std::abs(ofSamples - kHit), 0.02) << "the mean of samples, which would be wrong, must be far enough off";
}

TEST(FilmStages, TheVarianceIsTheOneThatIsStated) {
  constexpr double kHit = 0.3;
  double variance = 0, stated = 0;
  ForAllOutcomes(
      kHit, [](int) { return 5; },
      [&](double probability, const Film& film, double) {
        variance += probability * std::pow(static_cast<double>(ValueOf(film)) - kHit, 2);
        stated += probability * static_cast<double>(film.Develop().At(0, 0, 3));
      });
  EXPECT_NEAR(stated / variance, 1, 1e-6);
}

// Samples of a pass that gather the same photons: a part of their noise is common to them.
TEST(FilmStages, TheVarianceKnowsWhatSamplesShare) {
  std::mt19937 random(3);
  std::normal_distribution<double> noise;
  constexpr double kCommon = 2, kOwn = 1;
  const uint32_t counts[] = {1, 1, 1, 1, 6, 1, 9, 4};
  double squares = 0, stated = 0, independent = 0;
  constexpr int kFilms = 4000;
  for (int i = 0; i < kFilms; ++i) {
    Film film = OnePixel(true), without = OnePixel(false);
    uint32_t pass = 0;
    for (const uint32_t count : counts) {
      const double common = kCommon * noise(random);
      PixelSums sums;
      for (uint32_t k = 0; k < count; ++k) sums.Add(Color(static_cast<float>(100 + common + kOwn * noise(random))), 1);
      for (Film* own : {&film, &without}) own->Pixel(0, 0).Add(sums);
      film.AddGroup(0, 0, sums);
      for (Film* own : {&film, &without}) own->CountPasses(1);
      if (++pass != 4) continue;
      for (Film* own : {&film, &without}) own->EndStage();
    }
    squares += std::pow(static_cast<double>(ValueOf(film)) - 100, 2) / kFilms;
    stated += static_cast<double>(film.Develop().At(0, 0, 3)) / kFilms;
    independent += static_cast<double>(without.Develop().At(0, 0, 3)) / kFilms;
  }
  // The variance of a sample is taken from all samples, of which many share theirs: 15 % too small here.
  EXPECT_NEAR(stated / squares, 0.9, 0.15);
  EXPECT_LT(independent / squares, 0.6) << "samples taken as independent must be told apart";
}

// A film of several stages, and one more that has not ended, with layers and splats.
Film WithStages(unsigned seed, int stages) {
  Film film(4, 3, {0, 0, 4, 3}, {"key", "rest", kHalfLayer});
  film.MakeAdaptive(false);
  const PixelFilter filter({PixelFilterSettings::Kind::Mitchell, 2, 2});
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> value(0, 10);
  for (int stage = 0; stage <= stages; ++stage) {
    for (int y = 0; y < 3; ++y) {
      for (int x = 0; x < 4; ++x) {
        const auto count = 1 + random() % 5;
        for (unsigned i = 0; i < count; ++i) {
          const Color color(value(random), value(random), value(random));
          film.Pixel(x, y).Add(color, 1);
          LayerSample layers(2);
          layers.Add(random() % 2, color);
          film.AddToLayers(x, y, layers, 1, 1);
          if (i % 2 == 0) film.AddToHalf(x, y, color, 1);
        }
      }
    }
    SplatList splats = film.MakeSplatList(filter, 1);
    for (int i = 0; i < 20; ++i) {
      splats.StartPath();
      splats.Add({value(random) * 0.4f, value(random) * 0.3f}, Color(value(random)));
    }
    film.AddSplats(filter, std::span(&splats, 1), 1, static_cast<uint32_t>(stage));
    film.CountPasses(2);
    if (stage < stages) film.EndStage();
  }
  return film;
}

TEST(FilmStages, LayersAddUpToThePicture) {
  const Film film = WithStages(5, 3);
  const Image image = film.Develop();
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const auto at = [&](const char* channel) {
        return static_cast<double>(image.At(x, y, static_cast<size_t>(image.ChannelIndex(channel))));
      };
      const double layers = at("key.R") + at("rest.R");
      EXPECT_LT(layers, at("R") + 1e-5);
      EXPECT_GT(at("half.R"), 0);
    }
  }
  EXPECT_EQ(image.metadata.at(kHalfShareMetadata), "0.5");
}

TEST(FilmStages, AreSavedAndRead) {
  const Film film = WithStages(7, 2);
  std::string bytes;
  ByteWriter writer([&](const void* data, size_t count) { bytes.append(static_cast<const char*>(data), count); });
  film.Save(writer);
  Film loaded = film.EmptyCopy();
  ByteReader reader(std::as_bytes(std::span(bytes.data(), bytes.size())));
  loaded.Load(reader);
  EXPECT_EQ(loaded.Develop().data, film.Develop().data);
  EXPECT_EQ(loaded.EndedPasses(), film.EndedPasses());
  Film copy = film.EmptyCopy();
  copy.CopyFrom(film, 2);
  EXPECT_EQ(copy.Develop().data, film.Develop().data);
  EXPECT_EQ(copy.PixelErrors(), film.PixelErrors());
}

// The sum of two films is the mean of their pictures, weighted by passes.
TEST(FilmStages, AddUp) {
  const Film a = WithStages(1, 1), b = WithStages(2, 3);
  Film sum = a.EmptyCopy();
  sum.Add(a);
  sum.Add(b);
  const Image first = a.Develop(), second = b.Develop(), both = sum.Develop();
  for (size_t i = 0; i < both.data.size(); i += both.channels.size()) {
    const double mean = (4 * static_cast<double>(first.data[i]) + 8 * static_cast<double>(second.data[i])) / 12;
    EXPECT_NEAR(static_cast<double>(both.data[i]), mean, 1e-5 * mean);
  }
  EXPECT_EQ(sum.Samples(0), a.Samples(0) + b.Samples(0));
}

TEST(FilmStages, PixelErrorsAreRelativeToThePixel) {
  Film film(2, 1, {0, 0, 2, 1});
  EXPECT_TRUE(film.PixelErrors()[0] == 0 || std::isinf(film.PixelErrors()[0]));
  for (int i = 0; i < 100; ++i) {
    film.Pixel(0, 0).Add(Color(i % 2 == 0 ? 1.0f : 3.0f), 1);
    film.Pixel(1, 0).Add(Color(20), 1);
  }
  const std::vector<float> errors = film.PixelErrors();
  EXPECT_NEAR(static_cast<double>(errors[0]), 1.96 * 0.1 / 2, 0.002);
  EXPECT_EQ(errors[1], 0);
}

// While little is known of a picture, a pixel that is black may yet be lit; one of a known colour is known.
TEST(FilmStages, BlackPixelsAreUnknownUntilThePictureIsKnown) {
  Film film(3, 1, {0, 0, 3, 1});
  for (int i = 0; i < 100; ++i) {
    film.Pixel(0, 0).Add(Color(i == 0 ? 1.0f : 0.0f), 1);
    film.Pixel(1, 0).Add(Color(0), 1);
    film.Pixel(2, 0).Add(Color(2), 1);
  }
  EXPECT_TRUE(std::isinf(film.PixelErrors(1.5)[1]));
  EXPECT_EQ(film.PixelErrors(0.5)[1], 0);
  EXPECT_EQ(film.PixelErrors(1.5)[2], 0);
}

}  // namespace
}  // namespace lampyr
