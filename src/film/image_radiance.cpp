// Radiance pictures ("#?RADIANCE") as nearly all are: RGBE, rows from the top, run-length encoded by channel or not at
// all. The image module reads the others; it would load for half a second.
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>

#include "film/image_formats.h"

namespace lampyr {

namespace {

// The bytes of a file, from the current one on.
struct RadianceBytes {
  const std::string& all;
  size_t at = 0;

  bool Has(size_t count) const { return all.size() - at >= count; }
  uint8_t Next() { return static_cast<uint8_t>(all[at++]); }
  // Up to the end of the line, without it; nullopt: there is none.
  std::optional<std::string> Line() {
    const size_t end = all.find('\n', at);
    if (end == std::string::npos) return std::nullopt;
    std::string line = all.substr(at, end - at);
    at = end + 1;
    return line;
  }
};

// Width and height. nullopt: another kind of Radiance picture.
std::optional<std::pair<int, int>> ReadSize(RadianceBytes& bytes) {
  bool isRgbe = false;
  for (;;) {
    const std::optional<std::string> line = bytes.Line();
    if (!line) return std::nullopt;
    if (line->empty()) break;
    if (line->starts_with("FORMAT=")) isRgbe = *line == "FORMAT=32-bit_rle_rgbe";
  }
  const std::optional<std::string> resolution = bytes.Line();
  int width = 0, height = 0, length = 0;
  if (!isRgbe || !resolution) return std::nullopt;
  if (std::sscanf(resolution->c_str(), "-Y %7d +X %7d%n", &height, &width, &length) != 2) return std::nullopt;
  const bool isWhole = static_cast<size_t>(length) == resolution->size();
  if (!isWhole || height < 1 || width < 1) return std::nullopt;
  return std::pair(width, height);
}

// One channel of a row, every fourth byte from `to` on. False: the data are damaged.
bool ReadRuns(RadianceBytes& bytes, int width, uint8_t* to) {
  for (int x = 0; x < width;) {
    if (!bytes.Has(2)) return false;
    int count = bytes.Next();
    const bool isRun = count > 128;
    if (isRun) count -= 128;
    if (count == 0 || count > width - x || !bytes.Has(isRun ? 1 : static_cast<size_t>(count))) return false;
    const uint8_t value = isRun ? bytes.Next() : uint8_t{0};
    for (int i = 0; i < count; ++i, ++x) to[4 * static_cast<size_t>(x)] = isRun ? value : bytes.Next();
  }
  return true;
}

// Pixels as they are. Three ones would be a run of the oldest kind of file.
bool ReadPlainRow(RadianceBytes& bytes, std::vector<uint8_t>& row) {
  if (!bytes.Has(row.size())) return false;
  for (uint8_t& value : row) value = bytes.Next();
  for (size_t i = 0; i < row.size(); i += 4) {
    if (row[i] == 1 && row[i + 1] == 1 && row[i + 2] == 1) return false;
  }
  return true;
}

bool ReadRow(RadianceBytes& bytes, int width, std::vector<uint8_t>& row) {
  if (!bytes.Has(4)) return false;
  const auto byteAt = [&](size_t i) { return static_cast<uint8_t>(bytes.all[bytes.at + i]); };
  constexpr int kFewest = 8;  // pixels of a row that is run-length encoded
  if (width < kFewest || byteAt(0) != 2 || byteAt(1) != 2 || byteAt(2) > 127) return ReadPlainRow(bytes, row);
  if ((byteAt(2) << 8 | byteAt(3)) != width) return false;
  bytes.at += 4;
  for (size_t channel = 0; channel < 4; ++channel) {
    if (!ReadRuns(bytes, width, row.data() + channel)) return false;
  }
  return true;
}

}  // namespace

std::optional<Image> ReadUsualRadiance(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string all((std::istreambuf_iterator<char>(file)), {});
  RadianceBytes bytes{all};
  const auto size = ReadSize(bytes);
  if (!size) return std::nullopt;
  const auto [width, height] = *size;
  CheckImageSize(path, width, height, 3, 4);
  Image image(width, height, {"R", "G", "B"});
  std::vector<uint8_t> row(4 * static_cast<size_t>(width));
  float* value = image.data.data();
  for (int y = 0; y < height; ++y) {
    if (!ReadRow(bytes, width, row)) return std::nullopt;
    for (size_t i = 0; i < row.size(); i += 4) {
      constexpr int kBias = 128 + 8;
      const float scale = row[i + 3] == 0 ? 0.0f : std::ldexp(1.0f, row[i + 3] - kBias);
      for (size_t channel = 0; channel < 3; ++channel) *value++ = static_cast<float>(row[i + channel]) * scale;
    }
  }
  return image;
}

}  // namespace lampyr
