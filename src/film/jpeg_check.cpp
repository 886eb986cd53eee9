// JPEG readers fill what a truncated file lacks with gray and call it read. So the file's markers are walked first: it is
// whole when they end with EOI (ITU T.81 annex B). Files that are no JPEG pass.
#include <fstream>
#include <iterator>
#include <string>

#include "base/error.h"
#include "film/image_formats.h"

namespace lampyr {

namespace {

constexpr unsigned kStartOfImage = 0xd8, kEndOfImage = 0xd9, kStartOfScan = 0xda;

// Within entropy-coded data, 0xff is followed by 0 or by a restart marker. Gives the place of the next other marker.
size_t SkipScan(const std::string& bytes, size_t position) {
  for (; position + 1 < bytes.size(); ++position) {
    if (static_cast<unsigned char>(bytes[position]) != 0xff) continue;
    const unsigned next = static_cast<unsigned char>(bytes[position + 1]);
    if (next != 0 && next != 0xff && (next < 0xd0 || next > 0xd7)) return position;
  }
  return bytes.size();
}

bool IsWholeJpeg(const std::string& bytes) {
  const auto at = [&](size_t i) { return i < bytes.size() ? static_cast<unsigned char>(bytes[i]) : 0u; };
  size_t position = 2;
  while (position + 1 < bytes.size()) {
    const unsigned marker = at(position + 1);
    if (at(position) != 0xff || marker == 0xff) {  // fill bytes, or garbage that readers skip as well
      ++position;
      continue;
    }
    if (marker == kEndOfImage) return true;
    position += 2;
    if (marker == 0 || marker == 1 || (marker >= 0xd0 && marker <= kStartOfImage)) continue;  // no length follows
    position += 256 * at(position) + at(position + 1);
    if (marker == kStartOfScan) position = SkipScan(bytes, position);
  }
  return false;
}

}  // namespace

void CheckJpegIsWhole(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string bytes(3, '\0');
  if (!file.read(bytes.data(), 3) || bytes != "\xff\xd8\xff") return;
  bytes.append(std::istreambuf_iterator<char>(file), {});
  if (!IsWholeJpeg(bytes)) throw Error("cannot read image \"" + path.string() + "\": the file is truncated");
}

}  // namespace lampyr
