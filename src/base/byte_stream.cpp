#include "base/byte_stream.h"

#include <zlib.h>

#include <algorithm>
#include <cstring>

#include "base/error.h"

namespace lampyr {

namespace {

uint32_t Continue(uint32_t checksum, const void* bytes, size_t count) {
  const auto* next = static_cast<const Bytef*>(bytes);
  for (size_t left = count; left > 0;) {
    const auto part = static_cast<uInt>(std::min(left, size_t{1} << 30));
    checksum = static_cast<uint32_t>(crc32(checksum, next, part));
    next += part;
    left -= part;
  }
  return checksum;
}

}  // namespace

void ByteWriter::Bytes(const void* bytes, size_t count) {
  if (count == 0) return;
  checksum_ = Continue(checksum_, bytes, count);
  written_ += count;
  sink_(bytes, count);
}

void ByteReader::Take(void* to, size_t count) {
  if (count > bytes_.size()) throw Error("unexpected end of data");
  if (count > 0) std::memcpy(to, bytes_.data(), count);
  bytes_ = bytes_.subspan(count);
}

void ByteReader::CheckCount(uint64_t count, uint64_t most, size_t size) const {
  if (count > most || count > bytes_.size() / size) throw Error("it holds a number out of range");
}

std::string ByteReader::Text(uint64_t most) {
  const std::vector<char> text = List<char>(most);
  return {text.begin(), text.end()};
}

bool ByteReader::Flag() {
  const auto value = Value<uint8_t>();
  if (value > 1) throw Error("it holds a number out of range");
  return value == 1;
}

void ByteReader::CheckEnd() const {
  if (!bytes_.empty()) throw Error("it goes on after its end");
}

uint32_t ChecksumOf(std::span<const std::byte> bytes) {
  return Continue(0, bytes.data(), bytes.size());
}

}  // namespace lampyr
