// Values as bytes and back, for files that are read again on the machine that wrote them, or on one like it: byte order
// and floating point are the processor's. What is read is not trusted: nothing is taken that is not there.
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
  // The values alone: their number is known to who reads them.
  template <class T>
  void Values(std::span<const T> values) {
    static_assert(std::is_trivially_copyable_v<T>);
    Bytes(values.data(), values.size_bytes());
  }
  // With their number.
  template <class T>
  void List(std::span<const T> values) {
    Value<uint64_t>(values.size());
    Values(values);
  }
  void Text(std::string_view text) { List(std::span<const char>(text)); }

  uint64_t Written() const { return written_; }
  // Of all bytes so far.
  uint32_t Checksum() const { return checksum_; }

 private:
  void Bytes(const void* bytes, size_t count);

  Sink sink_;
  uint64_t written_ = 0;
  uint32_t checksum_ = 0;
};

// Throws an Error where less is left than is asked for.
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
  // Not more than `most`: an Error.
  template <class T>
  std::vector<T> List(uint64_t most) {
    const auto count = Value<uint64_t>();
    CheckCount(count, most, sizeof(T));
    std::vector<T> values(static_cast<size_t>(count));
    Values(std::span<T>(values));
    return values;
  }
  std::string Text(uint64_t most = 1 << 16);
  // A bool that is neither 0 nor 1 is none.
  bool Flag();

  uint64_t Left() const { return bytes_.size(); }
  // Throws an Error where bytes are left that nobody has asked for.
  void CheckEnd() const;

 private:
  void Take(void* to, size_t count);
  void CheckCount(uint64_t count, uint64_t most, size_t size) const;

  std::span<const std::byte> bytes_;
};

// As ByteWriter::Checksum.
uint32_t ChecksumOf(std::span<const std::byte> bytes);

}  // namespace lampyr
