// Values to bytes and back, and bytes that are not what they should be.
#include "base/byte_stream.h"

#include <gtest/gtest.h>

#include <cstring>

#include "base/error.h"
#include "base/mapped_file.h"
#include "support/temporary_folder.h"

namespace lampyr {
namespace {

struct Written {
  std::vector<std::byte> bytes;
  ByteWriter writer{[this](const void* from, size_t count) {
    const auto* first = static_cast<const std::byte*>(from);
    bytes.insert(bytes.end(), first, first + count);
  }};
};

TEST(ByteStream, WhatIsWrittenIsRead) {
  Written written;
  const std::vector<double> values = {1.5, -0.0, 1e300};
  written.writer.Value<uint32_t>(7);
  written.writer.Text("a \"name\"");
  written.writer.Text("");
  written.writer.List(std::span<const double>(values));
  written.writer.Values(std::span<const double>(values));
  written.writer.Value<uint8_t>(1);
  EXPECT_EQ(written.writer.Written(), written.bytes.size());
  EXPECT_EQ(written.writer.Checksum(), ChecksumOf(written.bytes));
  ByteReader reader(written.bytes);
  EXPECT_EQ(reader.Value<uint32_t>(), 7u);
  EXPECT_EQ(reader.Text(), "a \"name\"");
  EXPECT_EQ(reader.Text(), "");
  EXPECT_EQ(reader.List<double>(3), values);
  std::vector<double> again(3);
  reader.Values(std::span<double>(again));
  EXPECT_EQ(again, values);
  EXPECT_THROW(reader.CheckEnd(), Error);
  EXPECT_TRUE(reader.Flag());
  EXPECT_NO_THROW(reader.CheckEnd());
  EXPECT_THROW(reader.Flag(), Error);
}

TEST(ByteStream, TakesNoMoreThanThereIs) {
  for (const uint64_t count : {uint64_t{4}, uint64_t{1} << 32, ~uint64_t{0}, ~uint64_t{0} / 8}) {
    Written written;
    written.writer.Value(count);
    written.writer.Value<uint64_t>(1);
    EXPECT_THROW(ByteReader(written.bytes).List<double>(~uint64_t{0}), Error) << count;
    EXPECT_THROW(ByteReader(written.bytes).Text(3), Error) << count;
  }
  Written three;
  three.writer.List(std::span<const char>("abc", 3));
  EXPECT_THROW(ByteReader(three.bytes).Text(2), Error) << "more than is allowed";
  const std::byte two{2};
  EXPECT_THROW(ByteReader(std::span(&two, 1)).Flag(), Error);
}

TEST(ByteStream, OneBitChangesTheChecksum) {
  std::vector<std::byte> bytes(1000);
  const uint32_t checksum = ChecksumOf(bytes);
  for (size_t i = 0; i < bytes.size(); i += 37) {
    bytes[i] ^= std::byte{1} << (i % 8);
    EXPECT_NE(ChecksumOf(bytes), checksum);
    bytes[i] ^= std::byte{1} << (i % 8);
  }
}

TEST(MappedFile, HoldsTheFileOrSaysWhyNot) {
  const TemporaryFolder folder;
  WriteBytes(folder / "a", "bytes");
  const MappedFile file(folder / "a");
  EXPECT_EQ(std::string(reinterpret_cast<const char*>(file.Bytes().data()), file.Bytes().size()), "bytes");
  WriteBytes(folder / "empty", "");
  EXPECT_TRUE(MappedFile(folder / "empty").Bytes().empty());
  EXPECT_THROW(MappedFile(folder / "none"), Error);
  EXPECT_THROW(MappedFile{folder.Path()}, Error);
  EXPECT_THROW(MappedFile("/dev/zero"), Error);
}

}  // namespace
}  // namespace lampyr
