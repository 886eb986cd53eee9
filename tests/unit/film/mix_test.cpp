// Mixing layers: light groups are added up, other layers give their difference, and the place of a crop is kept.
#include "film/mix.h"

#include <gtest/gtest.h>

#include <cmath>

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

TEST(Mix, NeedsThePicture) {
  Image layer(1, 1, {"key.R", "key.G", "key.B"});
  layer.metadata["lampyr.lightGroups"] = "key";
  EXPECT_THROW(MixLayers(layer, {{"key", Color(2.0f)}}), Error);
  Image partial = Picture(4);
  partial.channels[4] = "other.G";  // a variance of R and B alone
  EXPECT_EQ(MixLayers(partial, {{"key", Color(2.0f)}, {"rest", Color(2.0f)}}).RgbAt(0, 0), Color(8.0f));
}

// Names that begin like those of other layers.
TEST(Mix, GroupsMayBeCalledAlmostAnything) {
  for (const char* name : {"weighted", "unweighted", "splatShare", "splatShares", "relativeErrors", "CryptoKey"}) {
    const std::string group = name;
    Image image = Picture(4, {"weighted.s2-t3.R", "weighted.s2-t3.G", "weighted.s2-t3.B", "relativeError"});
    for (std::string& channel : image.channels)
      if (channel.starts_with("key.")) channel = group + channel.substr(3);
    image.metadata["lampyr.lightGroups"] = group + ",rest";
    const Image mixed = MixLayers(image, {{group, Color(2, 0, 1)}});
    EXPECT_EQ(mixed.RgbAt(0, 0), Color(5, 3, 4)) << name;
    EXPECT_GE(mixed.ChannelIndex(group + ".R"), 0) << name;
    EXPECT_EQ(mixed.ChannelIndex("weighted.s2-t3.R"), -1) << name;
    EXPECT_EQ(mixed.ChannelIndex("relativeError"), -1) << name;
    EXPECT_EQ(MixLayers(mixed, {{"rest", Color(2.0f)}}).RgbAt(0, 0), Color(8, 6, 7)) << name;
  }
}

TEST(Mix, OfOtherLayersThePictureGetsTheDifference) {
  EXPECT_EQ(MixLayers(Picture(4), {{"caustic", Color(3.0f)}}).RgbAt(0, 0), Color(4.5f));
}

// The layers of a mixed picture are scaled like it, so that mixing twice equals mixing once by the product.
TEST(Mix, TwiceIsOnce) {
  const std::vector<std::string> more = {"half.R", "half.G", "half.B", "weighted.s0-t2.R", "relativeError", "Z"};
  for (const char* layer : {"key", "caustic"}) {
    const Image half = MixLayers(Picture(4, more), {{layer, Color(0.5f)}}),
                none = MixLayers(half, {{layer, Color(0.0f)}});
    EXPECT_EQ(none.RgbAt(0, 0), MixLayers(Picture(4, more), {{layer, Color(0.0f)}}).RgbAt(0, 0)) << layer;
    EXPECT_EQ(MixLayers(none, {{layer, Color(2.0f)}}).RgbAt(0, 0), none.RgbAt(0, 0)) << layer;
    EXPECT_EQ(MixLayers(half, {{layer, Color(2.0f)}}).RgbAt(0, 0), Color(4.0f)) << layer;
    const bool isGroup = std::string(layer) == "key";
    EXPECT_EQ(half.ChannelIndex("rest.R") >= 0, isGroup);
    EXPECT_EQ(GroupLayers(half).size(), isGroup ? 2u : 0u);
    EXPECT_EQ(half.ChannelIndex("caustic.R") >= 0, !isGroup);
    for (const char* gone : {"half.R", "weighted.s0-t2.R", "relativeError", "variance.R"})
      EXPECT_EQ(half.ChannelIndex(gone), -1) << gone;
    EXPECT_GE(half.ChannelIndex("Z"), 0);
  }
  const Image both = MixLayers(Picture(4), {{"key", Color(2.0f)}, {"caustic", Color(0.0f)}});
  EXPECT_EQ(both.RgbAt(0, 0), Color(4.75f));
  EXPECT_TRUE(ColorLayers(both).empty());
}

TEST(Mix, OfOneFactorOfAllGroupsOtherLayersHaveIt) {
  const Image mixed = MixLayers(Picture(4), {{"key", Color(2, 1, 0)}, {"rest", Color(2, 1, 0)}});
  EXPECT_EQ(mixed.At(0, 0, static_cast<size_t>(mixed.ChannelIndex("caustic.R"))), 0.5f);
  EXPECT_EQ(mixed.At(0, 0, static_cast<size_t>(mixed.ChannelIndex("caustic.B"))), 0.0f);
}

TEST(Mix, IsFiniteOrRefused) {
  EXPECT_THROW(MixLayers(Picture(4), {{"rest", Color(3e38f)}}), Error);
  EXPECT_THROW(MixLayers(Picture(4), {{"key", Color(1e25f)}, {"rest", Color(1e25f)}}), Error);  // its variance
  Image broken = Picture(4);
  broken.At(0, 0, 0) = NAN;  // the groups are not
  EXPECT_EQ(MixLayers(broken, {{"key", Color(2.0f)}}).RgbAt(0, 0), Color(5.0f));
  Image far = Picture(4, {"Z"});
  far.At(0, 0, static_cast<size_t>(far.ChannelIndex("Z"))) = HUGE_VALF;
  EXPECT_EQ(MixLayers(far, {{"key", Color(2.0f)}}).RgbAt(0, 0), Color(5.0f));
}

// Its groups add up to the noisy picture.
TEST(Mix, OfADenoisedPictureToo) {
  const Image denoised = Picture(3.5f, {"noisy.R", "noisy.G", "noisy.B"});
  EXPECT_EQ(MixLayers(denoised, {{"key", Color(1.0f)}, {"rest", Color(1.0f)}}).RgbAt(0, 0), Color(3.5f));
  const Image mixed = MixLayers(denoised, {{"key", Color(2.0f)}});
  EXPECT_EQ(mixed.RgbAt(0, 0), Color(4.5f));
  EXPECT_EQ(mixed.ChannelIndex("variance.R"), -1);
  EXPECT_EQ(mixed.ChannelIndex("noisy.R"), -1);
}

TEST(Mix, KnowsItsLayers) {
  EXPECT_THROW(MixLayers(Picture(4), {{"kee", Color(1.0f)}}), Error);
  EXPECT_THROW(MixLayers(Picture(4), {{"noisy", Color(1.0f)}}), Error);
  EXPECT_THROW(MixLayers(Picture(4), {{"key", Color(1.0f)}, {"key", Color(1.0f)}}), Error);
}

}  // namespace
}  // namespace lampyr
