// Mixing layers: light groups are added up, other layers give their difference, and the place of a crop is kept.
#include "film/mix.h"

#include <gtest/gtest.h>

#include "base/error.h"

namespace lampyr {
namespace {

// A cropped picture of one pixel, of two groups and a layer that overlaps with them.
Image Picture(float value, std::vector<std::string> more = {}) {
  std::vector<std::string> channels;
  for (const char* layer : {"", "variance.", "key.", "rest.", "caustic."}) {
    for (const char* channel : {"R", "G", "B"}) channels.push_back(std::string(layer) + channel);
  }
  channels.insert(channels.end(), more.begin(), more.end());
  Image image(1, 1, channels);
  for (size_t c = 0; c < 3; ++c) {
    image.At(0, 0, c) = value;
    image.At(0, 0, 3 + c) = 0.5f;
    image.At(0, 0, 6 + c) = 1;
    image.At(0, 0, 9 + c) = 3;
    image.At(0, 0, 12 + c) = 0.25f;
  }
  image.metadata["lampyr.lightGroups"] = "key,rest";
  image.offsetX = 3;
  image.offsetY = 2;
  image.fullWidth = 8;
  image.fullHeight = 6;
  return image;
}

void ExpectPlace(const Image& image) {
  EXPECT_EQ(image.offsetX, 3);
  EXPECT_EQ(image.offsetY, 2);
  EXPECT_EQ(image.fullWidth, 8);
  EXPECT_EQ(image.fullHeight, 6);
}

TEST(Mix, GroupsAreAddedUp) {
  const Image mixed = MixLayers(Picture(4), {{"key", Color(2, 0, 1)}});
  EXPECT_EQ(mixed.RgbAt(0, 0), Color(5, 3, 4));
  EXPECT_EQ(mixed.ChannelIndex("variance.R"), -1);
  ExpectPlace(mixed);
}

TEST(Mix, OneFactorOfAllGroupsKeepsTheVariance) {
  const Image mixed = MixLayers(Picture(4), {{"key", Color(2.0f)}, {"rest", Color(2.0f)}});
  EXPECT_EQ(mixed.RgbAt(0, 0), Color(8.0f));
  EXPECT_EQ(mixed.At(0, 0, 3), 2);
  ExpectPlace(mixed);
}

TEST(Mix, OfOtherLayersThePictureGetsTheDifference) {
  EXPECT_EQ(MixLayers(Picture(4), {{"caustic", Color(3.0f)}}).RgbAt(0, 0), Color(4.5f));
}

// Its groups add up to the noisy picture.
TEST(Mix, OfADenoisedPictureToo) {
  const Image denoised = Picture(3.5f, {"noisy.R", "noisy.G", "noisy.B"});
  EXPECT_EQ(MixLayers(denoised, {{"key", Color(1.0f)}, {"rest", Color(1.0f)}}).RgbAt(0, 0), Color(3.5f));
  const Image mixed = MixLayers(denoised, {{"key", Color(2.0f)}});
  EXPECT_EQ(mixed.RgbAt(0, 0), Color(4.5f));
  EXPECT_EQ(mixed.ChannelIndex("variance.R"), -1);
}

TEST(Mix, KnowsItsLayers) {
  EXPECT_THROW(MixLayers(Picture(4), {{"kee", Color(1.0f)}}), Error);
  EXPECT_THROW(MixLayers(Picture(4), {{"noisy", Color(1.0f)}}), Error);
  EXPECT_THROW(MixLayers(Picture(4), {{"key", Color(1.0f)}, {"key", Color(1.0f)}}), Error);
}

}  // namespace
}  // namespace lampyr
