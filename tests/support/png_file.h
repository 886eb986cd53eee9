// PNG files made byte by byte (ISO/IEC 15948), for tests of what reads them.
#pragma once

#include <zlib.h>

#include <cstdint>
#include <string>

namespace lampyr::test {

// The lower `bytes` bytes of the number, the highest first.
inline std::string BigEndian(uint64_t number, int bytes) {
  std::string text;
  for (int i = bytes; i-- > 0;) text += static_cast<char>(number >> (8 * i) & 255);
  return text;
}

// A chunk with its length and checksum.
inline std::string PngChunk(const std::string& type, const std::string& data) {
  const std::string body = type + data;
  const auto sum = crc32(0, reinterpret_cast<const Bytef*>(body.data()), static_cast<uInt>(body.size()));
  return BigEndian(data.size(), 4) + body + BigEndian(sum, 4);
}

inline std::string Deflated(const std::string& bytes) {
  std::string packed(compressBound(bytes.size()), '\0');
  uLongf size = packed.size();
  compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
  packed.resize(size);
  return packed;
}

// Colour types of the format.
enum PngColorType { kGray = 0, kRgb = 2, kPalette = 3, kGrayAlpha = 4, kRgba = 6 };

struct PngHeader {
  uint32_t width = 1, height = 1;
  int bits = 8;  // of a channel
  PngColorType type = kGray;
  bool isInterlaced = false;
};

// `rows`: of all passes, each row with its filter type before it; as many as the header announces, or not. `extra`:
// chunks before the pixels.
inline std::string PngFile(const PngHeader& header, const std::string& rows, const std::string& extra = "") {
  const std::string fields = BigEndian(header.width, 4) + BigEndian(header.height, 4) + static_cast<char>(header.bits) +
                             static_cast<char>(header.type) + std::string("\0\0", 2) +
                             static_cast<char>(header.isInterlaced);
  return "\x89PNG\r\n\x1a\n" + PngChunk("IHDR", fields) + extra + PngChunk("IDAT", Deflated(rows)) +
         PngChunk("IEND", "");
}

}  // namespace lampyr::test
