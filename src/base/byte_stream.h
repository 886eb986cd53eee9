// Binary serialization of trivially copyable values, in the byte order and floating-point format of the processor: for
// files that are read back on the machine that wrote them, or on a similar one. Input is untrusted: every read is
// checked against the bytes that are left.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace lampyr {

class ByteWriter {
 public:
  using Sink = std::function<void(const void* bytes, size_t count)>;
  explicit ByteWriter(Sink sink) : sink_(std::move(sink)) {}

  template <class T>
  void Value(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    Bytes(&value, sizeof value);
  }
  // Writes the values without their count, which the reader has to know.
  template <class T>
  void Values(std::span<const T> values) {
    static_assert(std::is_trivially_copyable_v<T>);
    Bytes(values.data(), values.size_bytes());
  }
  // Writes the count (uint64), then the values.
  template <class T>
  void List(std::span<const T> values) {
    Value<uint64_t>(values.size());
    Values(values);
  }
  void Text(std::string_view text) { List(std::span<const char>(text)); }

  uint64_t Written() const { return written_; }
  // CRC-32 of all bytes written so far.
  uint32_t Checksum() const { return checksum_; }

 private:
  void Bytes(const void* bytes, size_t count);

  Sink sink_;
  uint64_t written_ = 0;
  uint32_t checksum_ = 0;
};

// Every read throws an Error if fewer bytes are left than it needs.
class ByteReader {
 public:
  explicit ByteReader(std::span<const std::byte> bytes) : bytes_(bytes) {}

  template <class T>
  T Value() {
    static_assert(std::is_trivially_copyable_v<T>);
    T value;
    Take(&value, sizeof value);
    return value;
  }
  template <class T>
  void Values(std::span<T> values) {
    static_assert(std::is_trivially_copyable_v<T>);
    Take(values.data(), values.size_bytes());
  }
  // Reads a count and that many values. Throws an Error if the count exceeds `most`.
  template <class T>
  std::vector<T> List(uint64_t most) {
    const auto count = Value<uint64_t>();
    CheckCount(count, most, sizeof(T));
    std::vector<T> values(static_cast<size_t>(count));
    Values(std::span<T>(values));
    return values;
  }
  std::string Text(uint64_t most = 1 << 16);
  // Reads a bool. Throws an Error if the byte is neither 0 nor 1.
  bool Flag();

  uint64_t Left() const { return bytes_.size(); }
  // Throws an Error if unread bytes are left.
  void CheckEnd() const;

 private:
  void Take(void* to, size_t count);
  void CheckCount(uint64_t count, uint64_t most, size_t size) const;

  std::span<const std::byte> bytes_;
};

// CRC-32 of `bytes`; equal to ByteWriter::Checksum of the same bytes.
uint32_t ChecksumOf(std::span<const std::byte> bytes);

}  // namespace lampyr
