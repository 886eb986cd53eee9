// Damaged, truncated and absurd image files: an Error that names the file, or an image with the promised pixels; never
// a crash. Runs under sanitizers, too.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <random>
#include <string>

#include "base/error.h"
#include "film/image.h"
#include "support/temporary_folder.h"

namespace lampyr {
namespace {

Image Sample(int width, int height) {
  Image image(width, height, {"R", "G", "B", "variance.R", "variance.G", "variance.B"});
  std::mt19937 generator(3);
  std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
  for (float& value : image.data) value = uniform(generator);
  image.metadata["scene"] = "test";
  return image;
}

// True when the file was read; an Error must name the file.
bool Reads(const std::filesystem::path& path) {
  try {
    const Image image = ReadImage(path);
    EXPECT_EQ(image.data.size(),
              static_cast<size_t>(image.width) * static_cast<size_t>(image.height) * image.channels.size());
    return true;
  } catch (const Error& e) {
    EXPECT_NE(e.Text().find(path.filename().string()), std::string::npos) << e.Text();
    return false;
  }
}

// A gray baseline JPEG of 16 x 8 pixels: quantisation of ones, Huffman tables of one symbol each, two empty blocks.
std::string GrayJpeg() {
  std::string bytes = "\xff\xd8\xff\xdb" + std::string("\0\x43\0", 3) + std::string(64, '\1');
  bytes += std::string("\xff\xc0\0\x0b\x08\0\x08\0\x10\1\1\x11\0", 13);
  for (const char table : {'\0', '\x10'}) {
    bytes += std::string("\xff\xc4\0\x14", 4) + table + '\1' + std::string(15, '\0') + '\0';
  }
  return bytes + std::string("\xff\xda\0\x08\1\1\0\0\x3f\0\x0f\xff\xd9", 13);
}

// Files of the formats that can be made without tools, each with its name.
std::vector<std::pair<std::string, std::string>> Corpus(const TemporaryFolder& folder) {
  WriteExr(folder / "float.exr", Sample(40, 30), ExrPrecision::Float);
  WriteExr(folder / "half.exr", Sample(40, 30), ExrPrecision::Half);
  WritePng(folder / "a.png", Sample(40, 30), 0, ToneMap::Clip);
  std::string hdr = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 6 +X 5\n";
  for (int i = 0; i < 30; ++i) hdr += "\x40\x50\x60\x81";
  std::string ppm = "P6\n5 6\n255\n", pfm = "PF\n5 6\n-1.0\n", tga("\0\0\2\0\0\0\0\0\0\0\0\0\5\0\6\0\30\0", 18);
  for (int i = 0; i < 90; ++i) {
    ppm += static_cast<char>(2 * i);
    tga += static_cast<char>(2 * i);
    pfm.append("\0\0\x80\x3f", 4);
  }
  std::vector<std::pair<std::string, std::string>> corpus = {
      {"a.hdr", hdr}, {"a.ppm", ppm}, {"a.pfm", pfm}, {"a.tga", tga}, {"a.jpg", GrayJpeg()}};
  for (const char* name : {"float.exr", "half.exr", "a.png"}) corpus.emplace_back(name, ReadBytes(folder / name));
  return corpus;
}

TEST(ImageCorpus, WholeFilesAreRead) {
  const TemporaryFolder folder;
  for (const auto& [name, bytes] : Corpus(folder)) {
    WriteBytes(folder / name, bytes);
    EXPECT_TRUE(Reads(folder / name)) << name;
  }
}

TEST(ImageCorpus, PixelValuesOfHandMadeFiles) {
  const TemporaryFolder folder;
  const auto corpus = Corpus(folder);
  for (const auto& [name, bytes] : corpus) WriteBytes(folder / name, bytes);
  const Image pfm = ReadImage(folder / "a.pfm");
  EXPECT_EQ(pfm.width, 5);
  EXPECT_EQ(pfm.height, 6);
  EXPECT_EQ(pfm.RgbAt(4, 5), Color(1.0f));
  const Image hdr = ReadImage(folder / "a.hdr");
  EXPECT_NEAR(hdr.RgbAt(2, 3).r, 0x40 / 128.0f, 0.01f);
  EXPECT_NEAR(hdr.RgbAt(2, 3).b, 0x60 / 128.0f, 0.01f);
  const Image ppm = ReadImage(folder / "a.ppm", ImageEncoding::Linear);
  EXPECT_NEAR(ppm.RgbAt(1, 0).r, 6 / 255.0f, 1e-6f);
}

TEST(ImageCorpus, TruncatedFilesAreErrors) {
  const TemporaryFolder folder;
  for (const auto& [name, bytes] : Corpus(folder)) {
    for (const double part : {0.0, 0.01, 0.3, 0.6, 0.9}) {
      const std::string cut = "cut-" + name;
      WriteBytes(folder / cut, bytes.substr(0, static_cast<size_t>(part * static_cast<double>(bytes.size()))));
      EXPECT_FALSE(Reads(folder / cut)) << name << " cut at " << part;
    }
  }
}

TEST(ImageCorpus, AJpegWithoutItsEndIsAnError) {
  const TemporaryFolder folder;
  const std::string bytes = GrayJpeg();
  WriteBytes(folder / "a.jpg", bytes + "whatever follows");
  EXPECT_NEAR(ReadImage(folder / "a.jpg", ImageEncoding::Linear).RgbAt(15, 7).g, 128 / 255.0f, 1e-6f);
  for (const size_t cut : {1, 2, 3, 4, 9}) {
    WriteBytes(folder / "cut.jpg", bytes.substr(0, bytes.size() - cut));
    EXPECT_FALSE(Reads(folder / "cut.jpg")) << cut;
  }
}

TEST(ImageCorpus, DamagedBytesNeverCrash) {
  const TemporaryFolder folder;
  std::mt19937 generator(17);
  size_t cases = 0;
  for (const auto& [name, bytes] : Corpus(folder)) {
    for (int trial = 0; trial < 60; ++trial) {
      std::string damaged = bytes;
      // Half of the cases hit the header, where sizes and types are.
      const size_t range = trial % 2 == 0 ? std::min<size_t>(bytes.size(), 400) : bytes.size();
      for (int hit = 0; hit < 1 + trial % 4; ++hit) damaged[generator() % range] = static_cast<char>(generator());
      WriteBytes(folder / ("damaged-" + name), damaged);
      Reads(folder / ("damaged-" + name));
      ++cases;
    }
  }
  RecordProperty("cases", std::to_string(cases));
}

// A 4-byte little-endian number into an EXR attribute of the given name (its value starts after name, type and size).
void PatchWindow(std::string& bytes, const std::string& attribute, int32_t maxX, int32_t maxY) {
  const size_t name = bytes.find(attribute + std::string("\0box2i", 7));
  ASSERT_NE(name, std::string::npos);
  const size_t value = name + attribute.size() + 1 + 6 + 4;
  for (size_t i = 0; i < 4; ++i) {
    bytes[value + 8 + i] = static_cast<char>(static_cast<uint32_t>(maxX) >> (8 * i));
    bytes[value + 12 + i] = static_cast<char>(static_cast<uint32_t>(maxY) >> (8 * i));
  }
}

TEST(ImageCorpus, AbsurdSizesAreErrors) {
  const TemporaryFolder folder;
  WriteExr(folder / "a.exr", Sample(8, 8), ExrPrecision::Float);
  const std::string good = ReadBytes(folder / "a.exr");
  for (const auto& [x, y] : {std::pair<int32_t, int32_t>{2000000000, 7},
                             {7, 2000000000},
                             {100000, 100000},
                             {2147483647, 2147483647},
                             {-5, 3},
                             {1 << 20, 1 << 12}}) {
    std::string bytes = good;
    PatchWindow(bytes, "dataWindow", x, y);
    PatchWindow(bytes, "displayWindow", x, y);
    WriteBytes(folder / "absurd.exr", bytes);
    EXPECT_FALSE(Reads(folder / "absurd.exr")) << x << " x " << y;
  }
  for (const char* size : {"99999999 99999999", "0 0", "-3 4", "65536 65536"}) {
    WriteBytes(folder / "absurd.ppm", std::string("P6\n") + size + "\n255\nabc");
    EXPECT_FALSE(Reads(folder / "absurd.ppm")) << size;
  }
}

TEST(ImageCorpus, WrongKindsOfFiles) {
  const TemporaryFolder folder;
  EXPECT_FALSE(Reads(folder / "missing.png"));
  EXPECT_FALSE(Reads(folder / "missing.exr"));
  std::filesystem::create_directory(folder / "folder.exr");
  EXPECT_FALSE(Reads(folder / "folder.exr"));
  for (const char* name : {"text.png", "text.exr", "text.jpg", "text.hdr", "text.unknown", "text"}) {
    WriteBytes(folder / name, "this is no image at all\n");
    EXPECT_FALSE(Reads(folder / name)) << name;
  }
}

}  // namespace
}  // namespace lampyr
