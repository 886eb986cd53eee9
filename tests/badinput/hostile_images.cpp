// Images whose headers announce more than they hold: refused before a reader, ours or the library's, takes the memory.
#include <gmock/gmock.h>

#include "badinput/hostile_support.h"
#include "film/image.h"
#include "support/png_file.h"

namespace lampyr {
namespace {

using test::BigEndian;
using testing::AnyOf;
using testing::HasSubstr;

// Numbers of `bytes` bytes.
std::string Little(uint64_t n, int bytes) {
  std::string text;
  for (int i = 0; i < bytes; ++i) text += static_cast<char>(n >> (8 * i));
  return text;
}
// Bytes that compress to nothing, as a PNG of 8-bit gray.
std::string Png(uint32_t width, uint32_t height, size_t bytesOfPixels) {
  return test::PngFile({width, height}, std::string(bytesOfPixels, '\0'));
}

std::string Bmp(uint32_t width, uint32_t height, uint32_t compression) {
  return "BM" + Little(70, 4) + Little(0, 4) + Little(54, 4) + Little(40, 4) + Little(width, 4) + Little(height, 4) +
         Little(1, 2) + Little(compression ? 8 : 24, 2) + Little(compression, 4) + std::string(36, '\0');
}

std::string Gif(uint32_t width, uint32_t height) {
  return "GIF89a" + Little(width, 2) + Little(height, 2) + std::string("\x80\0\0", 3) + std::string(6, '\0') + "," +
         Little(0, 4) + Little(width, 2) + Little(height, 2) + std::string("\0\2\2\x4c\1\0;", 7);
}

std::string Tga(uint32_t width, uint32_t height) {
  return std::string("\0\0\xa\0\0\0\0\0\0\0\0\0", 12) + Little(width, 2) + Little(height, 2) + "\x20\x08" + "\xff....";
}

std::string Webp(const std::string& chunk, const std::string& data) {
  return "RIFF" + Little(12 + data.size(), 4) + "WEBP" + chunk + Little(data.size(), 4) + data;
}

// Progressive: its reader keeps all coefficients of the picture.
std::string Jpeg(uint32_t width, uint32_t height) {
  return std::string("\xff\xd8\xff\xc2\0\x0b\x08", 7) + BigEndian(height, 2) + BigEndian(width, 2) +
         std::string("\1\1\x11\0", 4) + std::string("\xff\xda\0\x08\1\1\0\0\0\0", 10) + "\xff\xd9";
}

std::string Tiff(uint32_t width, uint32_t height) {
  std::string entries;
  int count = 0;
  const auto add = [&](int tag, uint32_t value) {
    entries += Little(static_cast<uint64_t>(tag), 2) + Little(4, 2) + Little(1, 4) + Little(value, 4);
    ++count;
  };
  add(256, width);
  add(257, height);
  add(258, 8);
  add(259, 1);
  add(262, 1);
  add(273, 8);
  add(277, 1);
  add(278, height);
  add(279, 4);
  return std::string("II*\0", 4) + Little(8, 4) + Little(static_cast<uint64_t>(count), 2) + entries + Little(0, 4) +
         "....";
}

// Texts that unpack to 700 MB, in a file of as many kilobytes.
TEST(HostileImages, TextsOfPngFilesAreNotUnpacked) {
  const TemporaryFolder folder;
  const std::string text = std::string("Comment\0\0", 9) + test::Deflated(std::string(7000000, 'a'));
  std::string all;
  for (int i = 0; i < 100; ++i) all += test::PngChunk("zTXt", text);
  WriteBytes(folder / "a.png", test::PngFile({1, 1}, std::string("\0\xff", 2), all));
  const PeakMemory peak;
  EXPECT_EQ(ReadImage(folder / "a.png").At(0, 0, 0), 1.0f);
  EXPECT_LT(peak.GrownBy(), 16);
}

TEST(HostileImages, HeadersThatAnnounceMoreThanTheFileHoldsTakeNoMemory) {
  const std::pair<const char*, std::string> files[] = {
      {"a.png", Png(1000000, 1000000, 10)},
      {"b.png", Png(30000, 30000, 10)},
      {"a.bmp", Bmp(1000000, 1000000, 0)},
      {"b.bmp", Bmp(0x7fffffff, 0x7fffffff, 1)},
      {"c.bmp", Bmp(30000, static_cast<uint32_t>(-30000), 1)},
      {"a.gif", Gif(65535, 65535)},
      {"a.tga", Tga(65535, 65535)},
      {"a.jpg", Jpeg(65500, 65500)},
      {"a.webp", Webp("VP8L", "\x2f" + Little(0x0fffffff, 4) + std::string(27, '\0'))},
      {"b.webp", Webp("VP8X", std::string(4, '\0') + Little(16382, 3) + Little(16382, 3) + std::string(10, '\0'))},
      {"c.webp", Webp("VP8 ", std::string("\x10\0\0\x9d\x01\x2a", 6) + Little(16383, 2) + Little(16383, 2) +
                                  std::string(20, '\0'))},
      {"a.tif", Tiff(1000000, 1000000)},
      {"a.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1000000 +X 1000000\n...."},
      {"a.pfm", "PF\n1000000 1000000\n-1.0\n...."},
      {"a.ppm", "P6\n1000000 1000000\n255\n...."},
      {"a.pgm", "P5\n30000 30000\n255\n...."},
  };
  const TemporaryFolder folder;
  folder.Write("small.ppm", "P6\n1 1\n255\nabc");
  ASSERT_EQ(ReadImage(folder / "small.ppm").width, 1);  // loads the image library
  for (const auto& [name, bytes] : files) {
    folder.Write(name, bytes);
    const PeakMemory peak;
    const std::string error = ErrorOf([&] { ReadImage(folder / name); });
    EXPECT_THAT(error, HasSubstr(name));
    EXPECT_THAT(error, AnyOf(HasSubstr("too large"), HasSubstr("bytes can hold")));
    EXPECT_LT(peak.GrownBy(), 64) << name;
  }
}

// A header of the attributes given: names with types, sizes and what is there of the values.
std::string Exr(const std::string& attributes, bool severalParts) {
  return "\x76\x2f\x31\x01" + Little(severalParts ? 0x1002 : 2, 4) + attributes;
}

std::string Attribute(const std::string& name, const std::string& type, uint32_t size, const std::string& value) {
  return name + '\0' + type + '\0' + Little(size, 4) + value;
}

TEST(HostileImages, AttributesLongerThanTheFileTakeNoMemory) {
  const TemporaryFolder folder;
  const std::string fine = Attribute("comments", "string", 5, "hello");
  for (const bool severalParts : {false, true}) {
    for (const uint32_t size : {0x7fffffffu, 0xffffffffu, 0x40000000u, 100u}) {
      const std::string next = severalParts ? fine + '\0' : "";  // also in a header that is not the first
      folder.Write("a.exr", Exr(next + fine + Attribute("owner", "string", size, "me"), severalParts));
      const PeakMemory peak;
      EXPECT_THAT(ErrorOf([&] { ReadImage(folder / "a.exr"); }),
                  HasSubstr("its attribute \"owner\" announces " + std::to_string(size) + " bytes"));
      EXPECT_LT(peak.GrownBy(), 64);
    }
  }
}

TEST(HostileImages, PixelsThatCompressToNothingAreReadToALimit) {
  const TemporaryFolder folder;
  folder.Write("plain.png", Png(2000, 2000, 2001 * 2000));
  EXPECT_EQ(ReadImage(folder / "plain.png").data.size(), 4000000u);
  // More values than any image has.
  folder.Write("huge.png", Png(70000, 70000, 10 * kMebibyte));
  EXPECT_THAT(ErrorOf([&] { ReadImage(folder / "huge.png"); }), HasSubstr("too large"));
}

TEST(HostileImages, FilesAreToldApartByTheirContent) {
  const TemporaryFolder folder;
  folder.Write("photo.exr", Png(3, 2, 8));
  EXPECT_EQ(ReadImage(folder / "photo.exr").width, 3);
  // Formats of which the library has readers, too.
  for (const char* start : {"8BPS", "SDPX", "FORM....CIMG", "\x53\x80\xf6\x34", "DICM", "%!PS", "\x01\xda\x01\x01"}) {
    folder.Write("other.png", start + std::string(300, '\0'));
    EXPECT_THAT(ErrorOf([&] { ReadImage(folder / "other.png"); }),
                HasSubstr("its content is of none of the formats that are read: OpenEXR, PNG"))
        << start;
  }
}

}  // namespace
}  // namespace lampyr
