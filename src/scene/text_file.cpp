#include "scene/text_file.h"

#include <zlib.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <system_error>

#include "scene/limits.h"

namespace lampyr {

namespace {

[[noreturn]] void Fail(const std::filesystem::path& file, const FileLocation& where, const std::string& what) {
  if (where.file) throw Error(where, "\"" + file.string() + "\" " + what);
  throw Error(FileLocation{std::make_shared<const std::string>(file.string())}, "the file " + what);
}

std::string ReadBytes(const std::filesystem::path& file, const FileLocation& where) {
  std::error_code ignored;
  const std::filesystem::file_status status = std::filesystem::status(file, ignored);
  if (std::filesystem::is_directory(status)) Fail(file, where, "is a folder, not a scene file");
  // A scene may come through a pipe, but a file that it names may not: a pipe without a writer would block.
  const bool isPipe = std::filesystem::is_fifo(status) && !where.file;
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status) && !isPipe) {
    Fail(file, where, "is not a regular file");
  }
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream(std::fopen(file.c_str(), "rb"), &std::fclose);
  if (!stream) Fail(file, where, std::string("cannot be read: ") + std::strerror(errno));
  std::string bytes;
  const std::uintmax_t size = std::filesystem::file_size(file, ignored);
  if (!ignored) bytes.reserve(static_cast<size_t>(size) + 1);
  std::array<char, 1 << 16> buffer;
  while (const size_t count = std::fread(buffer.data(), 1, buffer.size(), stream.get()))
    bytes.append(buffer.data(), count);
  if (std::ferror(stream.get())) Fail(file, where, std::string("cannot be read: ") + std::strerror(errno));
  return bytes;
}

struct Inflater {
  z_stream stream{};
  Inflater() { inflateInit2(&stream, 15 + 16); }  // 15: largest window; 16: expect a gzip header
  ~Inflater() { inflateEnd(&stream); }
};

// Decompresses all members of a gzip file.
std::string Decompress(const std::string& bytes, const std::filesystem::path& file, const FileLocation& where) {
  Inflater inflater;
  z_stream& stream = inflater.stream;
  std::string text;
  std::array<char, 1 << 16> buffer;
  size_t given = 0;
  while (true) {
    if (stream.avail_in == 0 && given < bytes.size()) {
      const size_t chunk = std::min(bytes.size() - given, size_t(1) << 30);
      stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data() + given));
      stream.avail_in = static_cast<uInt>(chunk);
      given += chunk;
    }
    stream.next_out = reinterpret_cast<Bytef*>(buffer.data());
    stream.avail_out = static_cast<uInt>(buffer.size());
    const int result = inflate(&stream, Z_NO_FLUSH);
    text.append(buffer.data(), buffer.size() - stream.avail_out);
    if (text.size() > limits::kAlwaysFineText && text.size() / limits::kLargestGrowth > bytes.size()) {
      Fail(file, where, "grows to more than 200 times its size when it is decompressed: it is no text");
    }
    if (result == Z_STREAM_END) {
      // Copies of whole blocks leave zeros behind the data.
      const size_t read = given - stream.avail_in;
      if (bytes.find_first_not_of('\0', read) == std::string::npos) return text;
      if (inflateReset(&stream) != Z_OK) Fail(file, where, "has damaged gzip data");
    } else if (result == Z_BUF_ERROR && stream.avail_in == 0 && given == bytes.size()) {
      Fail(file, where, "ends in the middle of its gzip data");
    } else if (result != Z_OK && result != Z_BUF_ERROR) {
      Fail(file, where, "has damaged gzip data");
    }
  }
}

uint64_t Mix(uint64_t x) {
  x ^= x >> 33;
  x *= 0xff51afd7ed558ccdu;
  x ^= x >> 33;
  x *= 0xc4ceb9fe1a85ec53u;
  return x ^ (x >> 33);
}

}  // namespace

std::string ReadTextFile(const std::filesystem::path& file, const FileLocation& where) {
  std::string bytes = ReadBytes(file, where);
  const bool gzipped = bytes.size() >= 2 && bytes[0] == '\x1f' && bytes[1] == '\x8b';
  return gzipped ? Decompress(bytes, file, where) : bytes;
}

void ContentHash::Add(std::string_view text) {
  // Eight bytes at a time, explicitly little-endian. The length is hashed too, so that the boundaries of texts count.
  const auto take = [this](uint64_t word) {
    low_ = (low_ ^ word) * 0x9e3779b97f4a7c15u;
    low_ ^= low_ >> 29;
    high_ = Mix(high_ + word);
  };
  size_t i = 0;
  for (; i + 8 <= text.size(); i += 8) {
    uint64_t word = 0;
    for (size_t byte = 0; byte < 8; ++byte) word |= uint64_t(static_cast<unsigned char>(text[i + byte])) << (8 * byte);
    take(word);
  }
  uint64_t rest = 0;
  for (size_t byte = 0; i + byte < text.size(); ++byte) {
    rest |= uint64_t(static_cast<unsigned char>(text[i + byte])) << (8 * byte);
  }
  take(rest);
  take(text.size());
}

std::string ContentHash::Hex() const {
  char text[33];
  std::snprintf(text, sizeof text, "%016llx%016llx", static_cast<unsigned long long>(Mix(high_)),
                static_cast<unsigned long long>(Mix(low_)));
  return text;
}

}  // namespace lampyr
