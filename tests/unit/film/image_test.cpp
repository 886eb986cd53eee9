// Writing and reading images: nothing lost on the way, whole files or none.
#include "film/image.h"

#include <gtest/gtest.h>

#include <sys/resource.h>

#include <cmath>
#include <csignal>
#include <fstream>
#include <optional>
#include <random>

#include "base/error.h"
#include "film/image_colors.h"
#include "film/image_formats.h"
#include "film/srgb.h"
#include "support/temporary_folder.h"

namespace lampyr {
namespace {

Image NoiseImage(int width, int height, std::vector<std::string> channels, float scale = 1.0f) {
  Image image(width, height, std::move(channels));
  std::mt19937 generator(11);
  std::uniform_real_distribution<float> uniform(0.0f, scale);
  for (float& value : image.data) value = uniform(generator);
  return image;
}

TEST(Exr, FloatLayersMetadataAndCropComeBackExactly) {
  const TemporaryFolder folder;
  Image image = NoiseImage(
      37, 21,
      {"R", "G", "B", "A", "albedo.R", "albedo.G", "albedo.B", "variance.R", "variance.G", "variance.B", "depth.Z"},
      100.0f);
  image.offsetX = 5;
  image.offsetY = 9;
  image.fullWidth = 100;
  image.fullHeight = 50;
  image.metadata = {{"lampyr.integrator", "path"}, {"lampyr.seed", "42"}, {"empty", ""}};
  WriteExr(folder / "a.exr", image, ExrPrecision::Float);
  const Image read = ReadImage(folder / "a.exr");
  EXPECT_EQ(read.width, image.width);
  EXPECT_EQ(read.height, image.height);
  EXPECT_EQ(read.offsetX, 5);
  EXPECT_EQ(read.offsetY, 9);
  EXPECT_EQ(read.fullWidth, 100);
  EXPECT_EQ(read.fullHeight, 50);
  EXPECT_EQ(read.metadata, image.metadata);
  const std::vector<std::string> order = {"R",        "G",       "B",          "A",          "albedo.R",  "albedo.G",
                                          "albedo.B", "depth.Z", "variance.R", "variance.G", "variance.B"};
  ASSERT_EQ(read.channels, order);
  for (const std::string& channel : order) {
    const auto from = static_cast<size_t>(image.ChannelIndex(channel)),
               to = static_cast<size_t>(read.ChannelIndex(channel));
    for (int y = 0; y < image.height; ++y) {
      for (int x = 0; x < image.width; ++x) ASSERT_EQ(image.At(x, y, from), read.At(x, y, to)) << channel;
    }
  }
  EXPECT_EQ(folder.FileCount(), 1u);
}

// Layers that half cannot hold are floats: identifiers, variances, and those with large values.
TEST(Exr, HalfKeepsElevenBitsOfWhatItCanHold) {
  const TemporaryFolder folder;
  Image image = NoiseImage(16, 16, {"R", "G", "B", "key.R", "key.G", "key.B", "variance.R", "CryptoObject00.R"});
  image.At(3, 4, 4) = 1e30f;
  image.At(3, 4, 5) = 0.1f;
  image.At(3, 4, 6) = 1e-9f;
  image.At(3, 4, 7) = -4.2e35f;
  WriteExr(folder / "a.exr", image, ExrPrecision::Half);
  const Image read = ReadImage(folder / "a.exr");
  ASSERT_EQ(read.channels.size(), image.channels.size());
  for (const char* channel : {"key.G", "key.B", "variance.R", "CryptoObject00.R"}) {
    EXPECT_EQ(read.At(3, 4, static_cast<size_t>(read.ChannelIndex(channel))),
              image.At(3, 4, static_cast<size_t>(image.ChannelIndex(channel))))
        << channel;
  }
  image = ChannelsOf(image, {"R", "G", "B"});
  const Image picture = ChannelsOf(read, {"R", "G", "B"});
  EXPECT_NE(picture.data, image.data);
  for (size_t i = 0; i < image.data.size(); ++i) {
    if (std::abs(image.data[i]) < 2) {
      ASSERT_NEAR(picture.data[i], image.data[i], std::ldexp(std::max(image.data[i], 1e-4f), -11));
    }
  }
}

TEST(Exr, WritesOverTheOldFile) {
  const TemporaryFolder folder;
  WriteExr(folder / "a.exr", NoiseImage(64, 64, {"R", "G", "B"}), ExrPrecision::Float);
  WriteExr(folder / "a.exr", NoiseImage(2, 2, {"R", "G", "B"}), ExrPrecision::Float);
  EXPECT_EQ(ReadImage(folder / "a.exr").width, 2);
}

std::string FailureOf(const std::filesystem::path& path, bool png = false) {
  try {
    const Image image = NoiseImage(128, 128, {"R", "G", "B"});
    if (png) {
      WritePng(path, image, 0, ToneMap::Clip);
    } else {
      WriteExr(path, image, ExrPrecision::Float);
    }
  } catch (const Error& e) {
    return e.Text();
  }
  return "";
}

// A layer for each of many light groups.
TEST(Exr, ThousandsOfLayersComeBack) {
  const TemporaryFolder folder;
  std::vector<std::string> channels = {"R", "G", "B"};
  for (int i = 1000; i < 3000; ++i) {
    for (const char* channel : {".R", ".G", ".B"}) channels.push_back("g" + std::to_string(i) + channel);
  }
  const Image image = NoiseImage(3, 2, channels);
  WriteExr(folder.Path() / "many.exr", image, ExrPrecision::Float);
  const Image read = ReadImage(folder.Path() / "many.exr");
  EXPECT_EQ(read.channels, image.channels);
  EXPECT_EQ(read.data, image.data);
}

TEST(AtomicWrite, ARewrittenFileKeepsItsPermissions) {
  const TemporaryFolder folder;
  const auto wanted =
      std::filesystem::perms::owner_read | std::filesystem::perms::owner_write | std::filesystem::perms::others_read;
  WriteBytes(folder / "a.exr", "old");
  std::filesystem::permissions(folder / "a.exr", wanted);
  EXPECT_EQ(FailureOf(folder / "a.exr"), "");
  EXPECT_EQ(std::filesystem::status(folder / "a.exr").permissions(), wanted);
}

TEST(AtomicWrite, FailuresNameFileAndReason) {
  const TemporaryFolder folder;
  WriteBytes(folder / "file", "old");
  EXPECT_NE(FailureOf(folder / "file/a.exr").find("Not a directory"), std::string::npos);
  EXPECT_NE(FailureOf(folder / "missing/a.exr").find("No such file or directory"), std::string::npos);
  EXPECT_NE(FailureOf(folder.Path()).find("Is a directory"), std::string::npos);
  EXPECT_NE(FailureOf(folder / "file/a.png", true).find("Not a directory"), std::string::npos);
  EXPECT_EQ(ReadBytes(folder / "file"), "old");
}

TEST(AtomicWrite, AFullDiskLeavesTheOldFileAndNoRest) {
  const TemporaryFolder folder;
  WriteExr(folder / "a.exr", NoiseImage(8, 8, {"R", "G", "B"}), ExrPrecision::Float);
  const std::string before = ReadBytes(folder / "a.exr");
  // A limit on the size of files stands for the full disk: writing stops short in the middle of the pixels.
  rlimit old{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &old), 0);
  const auto oldHandler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{30000, old.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  const std::string exr = FailureOf(folder / "a.exr"), png = FailureOf(folder / "a.png", true);
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &old), 0);
  std::signal(SIGXFSZ, oldHandler);
  EXPECT_NE(exr.find("File too large"), std::string::npos) << exr;
  EXPECT_NE(png.find("File too large"), std::string::npos) << png;
  EXPECT_EQ(ReadBytes(folder / "a.exr"), before);
  EXPECT_EQ(folder.FileCount(), 1u);
}

TEST(AtomicWrite, BadMetadataIsAnErrorAndLeavesNoRest) {
  const TemporaryFolder folder;
  Image image(2, 2, {"R", "G", "B"});
  image.metadata[""] = "no name";
  EXPECT_THROW(WriteExr(folder / "a.exr", image, ExrPrecision::Half), Error);
  EXPECT_EQ(folder.FileCount(), 0u);
}

TEST(Png, RoundTripIsExactToEightBits) {
  const TemporaryFolder folder;
  const Image image = NoiseImage(31, 17, {"R", "G", "B"});
  WritePng(folder / "a.png", image, 0, ToneMap::Clip);
  const Image srgb = ReadImage(folder / "a.png");
  const Image encoded = ReadImage(folder / "a.png", ImageEncoding::Linear);
  EXPECT_EQ(srgb.colorGamma, 0);
  EXPECT_EQ(encoded.colorGamma, 1);
  ASSERT_EQ(srgb.channels, (std::vector<std::string>{"R", "G", "B"}));
  ASSERT_EQ(srgb.width, 31);
  ASSERT_EQ(srgb.height, 17);
  for (size_t i = 0; i < image.data.size(); ++i) {
    ASSERT_NEAR(encoded.data[i], LinearToSrgb(image.data[i]), 0.5f / 255 + 1e-6f);
    ASSERT_NEAR(srgb.data[i], SrgbToLinear(encoded.data[i]), 1e-6f);
  }
  const Image gamma = ReadImageWithGamma(folder / "a.png", 2.0f);
  for (size_t i = 0; i < gamma.data.size(); ++i) ASSERT_NEAR(gamma.data[i], Sqr(encoded.data[i]), 1e-6f);
}

TEST(Png, ToneMapping) {
  const TemporaryFolder folder;
  Image image(4, 1, {"Y"});
  image.data = {-1.0f, 0.25f, 4.0f, std::numeric_limits<float>::quiet_NaN()};
  WritePng(folder / "clip.png", image, 1, ToneMap::Clip);
  WritePng(folder / "filmic.png", image, 1, ToneMap::Filmic);
  const Image clip = ReadImage(folder / "clip.png"), filmic = ReadImage(folder / "filmic.png");
  for (const Image* read : {&clip, &filmic}) {
    EXPECT_EQ(read->RgbAt(0, 0).r, 0);
    EXPECT_NEAR(read->RgbAt(1, 0).g, 0.5f, 0.004f);  // below the shoulder both are the identity
    EXPECT_EQ(read->RgbAt(3, 0).b, 0);
  }
  EXPECT_EQ(clip.RgbAt(2, 0).r, 1);
  EXPECT_NEAR(filmic.RgbAt(2, 0).r, 1.0f, 0.01f);
}

TEST(Hdr, ReadsTheSkyOfTheReferenceScenes) {
  const std::filesystem::path path = std::filesystem::path(LAMPYR_SHARED_DATA) / "peer/sky.hdr";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no " << path;
  const Image sky = ReadImage(path);
  EXPECT_EQ(sky.width, 128);
  EXPECT_EQ(sky.height, 128);
  ASSERT_TRUE(sky.HasRgb());
  float largest = 0;
  for (int y = 0; y < sky.height; ++y) {
    for (int x = 0; x < sky.width; ++x) {
      ASSERT_TRUE(sky.RgbAt(x, y).IsValid());
      largest = std::max(largest, sky.RgbAt(x, y).Max());
    }
  }
  EXPECT_GT(largest, 1.0f);  // linear: the sun is brighter than white
}

// Our reader of Radiance pictures gives what OpenImageIO gives, and leaves what it does not know to that.
TEST(Hdr, IsReadAsOpenImageIoReadsIt) {
  const TemporaryFolder folder;
  std::vector<std::filesystem::path> files = {std::filesystem::path(LAMPYR_SOURCE_DIR) / "scenes/data/sky-noon.hdr",
                                              std::filesystem::path(LAMPYR_SHARED_DATA) / "peer/sky.hdr"};
  size_t compared = 0;
  for (const std::filesystem::path& path : files) {
    if (!std::filesystem::exists(path)) continue;
    ++compared;
    const std::optional<Image> own = ReadUsualRadiance(path);
    ASSERT_TRUE(own) << path;
    const EncodedImage other = ReadThroughModule(path, FindImageKind(path));
    EXPECT_EQ(other.integerBits, 0);
    EXPECT_FALSE(other.saysSrgb);
    EXPECT_EQ(own->channels, other.image.channels);
    EXPECT_EQ(own->width, other.image.width);
    EXPECT_EQ(own->data, other.image.data) << path;
  }
  EXPECT_GT(compared, 0u);
  const std::string whole = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 8\n\2\2" + std::string("\0\10", 2) +
                            "\210\100\210\40\4\1\2\3\4\204\5\210\201";
  const auto read = [&](const std::string& text) {
    std::ofstream(folder / "a.hdr", std::ios::binary) << text;
    return ReadUsualRadiance(folder / "a.hdr");
  };
  const std::optional<Image> image = read(whole);
  ASSERT_TRUE(image);
  EXPECT_EQ(image->At(3, 0, 0), 0x40 * 0x1p-7f);
  EXPECT_EQ(image->At(3, 0, 1), 0x20 * 0x1p-7f);
  EXPECT_EQ(image->At(2, 0, 2), 3 * 0x1p-7f);
  EXPECT_EQ(image->At(7, 0, 2), 5 * 0x1p-7f);
  for (size_t length = 0; length < whole.size(); ++length) EXPECT_FALSE(read(whole.substr(0, length))) << length;
  const auto changed = [&](const std::string& from, const std::string& to) {
    std::string text = whole;
    return text.replace(text.find(from), from.size(), to);
  };
  EXPECT_FALSE(read(changed("rgbe", "xyze")));
  EXPECT_FALSE(read(changed("-Y 1 +X 8", "+Y 1 +X 8")));
  EXPECT_FALSE(read(changed("-Y 1 +X 8", "-Y 1 +X 9")));
  EXPECT_FALSE(read(changed("-Y 1 +X 8", "-Y 2 +X 8")));
}

// Rendering needs colours in gamut; comparing pictures needs the linear map.
TEST(ImageColors, OutOfGamut) {
  Image image(2, 1, {"R", "G", "B"});
  image.chromaticities = {0.713, 0.293, 0.165, 0.830, 0.128, 0.044, 0.32168, 0.33767};  // ACEScg
  image.data = {0.5f, 1e-6f, 0.5f, 0.5f, -1e-6f, 0.5f};
  const Image limited = InRec709(image, WhiteHandling::Adapt, GamutHandling::Limit);
  for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(limited.At(0, 0, c), limited.At(1, 0, c), 1e-4);
  EXPECT_GT(limited.RgbAt(0, 0).r, limited.RgbAt(0, 0).b + 0.1f);
  EXPECT_GE(limited.RgbAt(0, 0).g, 0);
  const Image kept = InRec709(image, WhiteHandling::Adapt, GamutHandling::Keep);
  EXPECT_LT(kept.RgbAt(0, 0).g, -0.01f);
  EXPECT_FALSE(NeedsConversion(kept, WhiteHandling::Adapt));
  Image white = image;
  white.data = {1, 1, 1, 1, 1, 1};
  white = InRec709(white, WhiteHandling::Adapt, GamutHandling::Keep);
  for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(white.At(0, 0, c), 1, 1e-3);
}

TEST(Srgb, CurveIsContinuousAndInvertible) {
  EXPECT_NEAR(SrgbToLinear(0.5f), 0.21404114f, 1e-6f);
  EXPECT_NEAR(LinearToSrgb(0.18f), 0.46135613f, 1e-6f);
  for (int i = 0; i <= 1000; ++i) EXPECT_NEAR(LinearToSrgb(SrgbToLinear(i / 1000.0f)), i / 1000.0f, 2e-6f);
}

TEST(ImageClass, LayersOfAnotherSizeAreRefused) {
  Image image(2, 2, {"R"});
  EXPECT_THROW(AppendChannels(image, Image(2, 1, {"N.X"})), Error);
}

TEST(ImageClass, RgbAtGrayAndLayers) {
  Image gray(1, 1, {"Z"});
  gray.data = {0.25f};
  EXPECT_TRUE(gray.HasRgb());
  EXPECT_EQ(gray.RgbAt(0, 0), Color(0.25f));
  Image grayAlpha(1, 1, {"A", "Y"});
  grayAlpha.data = {1.0f, 0.25f};
  EXPECT_EQ(grayAlpha.RgbAt(0, 0), Color(0.25f));
  Image reversed(1, 1, {"B", "G", "R"});
  reversed.data = {3.0f, 2.0f, 1.0f};
  EXPECT_EQ(reversed.RgbAt(0, 0), Color(1, 2, 3));
  EXPECT_FALSE(Image(1, 1, {"variance.R", "variance.G"}).HasRgb());
  EXPECT_FALSE(Image(1, 1, {"X", "Y", "Z"}).HasRgb());  // Y is a part of these colours
  EXPECT_FALSE(Image(1, 1, {"BY", "RY", "Y"}).HasRgb());
  EXPECT_TRUE(Image(1, 1, {"Y", "Z"}).HasRgb());  // gray with depth
  EXPECT_EQ(gray.ChannelIndex("R"), -1);
}

}  // namespace
}  // namespace lampyr
