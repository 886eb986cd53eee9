// PNG files of every kind of pixel, made here byte by byte; and damaged ones.
#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "base/error.h"
#include "film/image.h"
#include "film/srgb.h"
#include "support/png_file.h"
#include "support/temporary_folder.h"

namespace lampyr {
namespace {

using namespace test;  // kGray, kRgb, …

constexpr int kWidth = 13, kHeight = 11;

int ChannelCount(PngColorType type) {
  return type == kRgb ? 3 : type == kGrayAlpha ? 2 : type == kRgba ? 4 : 1;
}

// The value stored in a channel of a pixel.
uint32_t Stored(int x, int y, int channel, int bits) {
  return (static_cast<uint32_t>(x * 7 + y * 31 + channel * 101) * 2654435761u >> 8) & ((1u << bits) - 1);
}

std::string Row(int y, int x0, int step, PngColorType type, int bits) {
  std::string row(1, '\0');  // no filter
  uint32_t pending = 0;
  int used = 0;
  for (int x = x0; x < kWidth; x += step) {
    for (int c = 0; c < ChannelCount(type); ++c) {
      if (bits >= 8) {
        row += BigEndian(Stored(x, y, c, bits), bits / 8);
        continue;
      }
      pending = pending << bits | Stored(x, y, c, bits);
      used += bits;
      if (used == 8) row += static_cast<char>(pending), pending = 0, used = 0;
    }
  }
  if (used > 0) row += static_cast<char>(pending << (8 - used));
  return row;
}

// `extra`: chunks before the pixels.
std::string Png(PngColorType type, int bits, bool isInterlaced, const std::string& extra = "") {
  struct Pass {
    int x, y, stepX, stepY;
  };
  const std::vector<Pass> adam7 = {{0, 0, 8, 8}, {4, 0, 8, 8}, {0, 4, 4, 8}, {2, 0, 4, 4},
                                   {0, 2, 2, 4}, {1, 0, 2, 2}, {0, 1, 1, 2}};
  std::string pixels;
  for (const Pass& pass : isInterlaced ? adam7 : std::vector<Pass>{{0, 0, 1, 1}}) {
    for (int y = pass.y; y < kHeight; y += pass.stepY) pixels += Row(y, pass.x, pass.stepX, type, bits);
  }
  return test::PngFile({kWidth, kHeight, bits, type, isInterlaced}, pixels, extra);
}

void ExpectPixels(const Image& image, int channels, const std::function<double(int x, int y, int c)>& expected) {
  ASSERT_EQ(image.width, kWidth);
  ASSERT_EQ(image.height, kHeight);
  ASSERT_EQ(image.channels.size(), static_cast<size_t>(channels));
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      for (int c = 0; c < channels; ++c)
        ASSERT_NEAR(image.At(x, y, static_cast<size_t>(c)), expected(x, y, c), 1e-7) << x << " " << y << " " << c;
    }
  }
}

TEST(PngKinds, AllDepthsChannelsAndInterlacing) {
  const TemporaryFolder folder;
  const std::pair<PngColorType, std::vector<int>> kinds[] = {
      {kGray, {1, 2, 4, 8, 16}}, {kRgb, {8, 16}}, {kGrayAlpha, {8, 16}}, {kRgba, {8, 16}}};
  for (const auto& [type, depths] : kinds) {
    for (const int bits : depths) {
      for (const bool isInterlaced : {false, true}) {
        SCOPED_TRACE("type " + std::to_string(type) + ", " + std::to_string(bits) + " bits");
        WriteBytes(folder / "a.png", Png(type, bits, isInterlaced));
        ExpectPixels(ReadImage(folder / "a.png", ImageEncoding::Linear), ChannelCount(type), [&](int x, int y, int c) {
          return static_cast<double>(Stored(x, y, c, bits)) / ((1 << bits) - 1);
        });
      }
    }
  }
}

TEST(PngKinds, PalettesAndTransparentColours) {
  const TemporaryFolder folder;
  std::string palette;
  for (int i = 0; i < 16; ++i) palette += BigEndian(static_cast<uint32_t>(i * 17 << 16 | i << 8 | (255 - i)), 3);
  // The first two entries are transparent and half transparent.
  WriteBytes(folder / "a.png",
             Png(kPalette, 4, true, PngChunk("PLTE", palette) + PngChunk("tRNS", std::string("\0\x80", 2))));
  ExpectPixels(ReadImage(folder / "a.png", ImageEncoding::Linear), 4, [](int x, int y, int c) {
    const int i = static_cast<int>(Stored(x, y, 0, 4));
    const int values[] = {i * 17, i, 255 - i, i == 0 ? 0 : i == 1 ? 128 : 255};
    return values[c] / 255.0;
  });
  // One gray is transparent.
  WriteBytes(folder / "b.png", Png(kGray, 4, false, PngChunk("tRNS", BigEndian(5, 2))));
  ExpectPixels(ReadImage(folder / "b.png", ImageEncoding::Linear), 2, [](int x, int y, int c) {
    const double value = Stored(x, y, 0, 4);
    return c == 0 ? value / 15 : value == 5 ? 0 : 1;
  });
}

// Eight bits are sRGB whatever the file says; sixteen are, unless it says otherwise.
TEST(PngKinds, SixteenBitsAreAsTheFileSays) {
  const TemporaryFolder folder;
  const std::string linear = PngChunk("gAMA", BigEndian(100000, 4));
  WriteBytes(folder / "srgb.png", Png(kGray, 16, false));
  WriteBytes(folder / "gamma.png", Png(kGray, 16, false, PngChunk("gAMA", BigEndian(45455, 4))));
  WriteBytes(folder / "linear.png", Png(kGray, 16, false, linear));
  WriteBytes(folder / "eight.png", Png(kGray, 8, false, linear));
  const auto stored = [](int x, int y, int bits) {
    return static_cast<float>(Stored(x, y, 0, bits)) / static_cast<float>((1 << bits) - 1);
  };
  for (const char* name : {"srgb.png", "gamma.png"})
    ExpectPixels(ReadImage(folder / name), 1,
                 [&](int x, int y, int) { return static_cast<double>(SrgbToLinear(stored(x, y, 16))); });
  ExpectPixels(ReadImage(folder / "linear.png"), 1,
               [&](int x, int y, int) { return static_cast<double>(stored(x, y, 16)); });
  ExpectPixels(ReadImage(folder / "eight.png"), 1,
               [&](int x, int y, int) { return static_cast<double>(SrgbToLinear(stored(x, y, 8))); });
}

// Text chunks of a file are skipped, packed or not, before the pixels or damaged.
TEST(PngKinds, TextsAreSkipped) {
  const TemporaryFolder folder;
  const std::string none(1, '\0'), packed = Deflated("a comment, packed");
  std::string wrong = packed;
  wrong[wrong.size() / 2] ^= 0x55;
  const std::pair<const char*, std::string> texts[] = {
      {"software", PngChunk("tEXt", "Software" + none + "a renderer")},
      {"empty", PngChunk("tEXt", "")},
      {"without a key", PngChunk("tEXt", none + "text")},
      {"long key", PngChunk("tEXt", std::string(300, 'k') + none + "text")},
      {"packed", PngChunk("zTXt", "Comment" + none + none + packed)},
      {"packed and damaged", PngChunk("zTXt", "Comment" + none + none + wrong)},
      {"international", PngChunk("iTXt", "Title" + none + "\x01" + none + "de" + none + "Titel" + none + packed)},
      {"many",
       [&] {
         std::string all;
         for (int i = 0; i < 2000; ++i) all += PngChunk("tEXt", "Comment" + none + std::to_string(i));
         return all;
       }()},
  };
  for (const auto& [name, chunk] : texts) {
    SCOPED_TRACE(name);
    WriteBytes(folder / "a.png", Png(kRgb, 8, false, chunk));
    ExpectPixels(ReadImage(folder / "a.png", ImageEncoding::Linear), 3,
                 [](int x, int y, int c) { return Stored(x, y, c, 8) / 255.0; });
  }
}

// Cut anywhere, or with a byte of the header changed: an error that names the file.
TEST(PngKinds, DamagedFilesAreErrors) {
  const TemporaryFolder folder;
  const std::string whole = Png(kRgb, 8, false);
  const size_t pixelsEnd = whole.size() - 12;  // what comes after the pixels does not matter
  const auto expectError = [&](const std::string& bytes, const std::string& what) {
    WriteBytes(folder / "broken.png", bytes);
    try {
      ReadImage(folder / "broken.png");
      ADD_FAILURE() << what << " is not noticed";
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("broken.png"), std::string::npos) << error.what();
    }
  };
  for (size_t length = 8; length < pixelsEnd - 4; length += 5)
    expectError(whole.substr(0, length), "a cut at " + std::to_string(length));
  for (size_t i = 16; i < 33; ++i) {  // the header, whose checksum is critical
    std::string bytes = whole;
    bytes[i] = static_cast<char>(bytes[i] ^ 0x11);
    expectError(bytes, "byte " + std::to_string(i));
  }
}

}  // namespace
}  // namespace lampyr
