// JPEG readers fill the missing part of a truncated file with gray and report success. The markers of the file are
// therefore walked first: it is complete if they end with EOI (ITU T.81 annex B). This also yields the frame size
// before any reader allocates memory for it.
#include <fstream>
#include <iterator>
#include <string>

#include "base/error.h"
#include "film/image_formats.h"

namespace lampyr {

namespace {

constexpr unsigned kStartOfImage = 0xd8, kEndOfImage = 0xd9, kStartOfScan = 0xda;

// In entropy-coded data, 0xff is followed by 0 or by a restart marker. Returns the position of the next other marker.
size_t SkipScan(const std::string& bytes, size_t position) {
  for (; position + 1 < bytes.size(); ++position) {
    if (static_cast<unsigned char>(bytes[position]) != 0xff) continue;
    const unsigned next = static_cast<unsigned char>(bytes[position + 1]);
    if (next != 0 && next != 0xff && (next < 0xd0 || next > 0xd7)) return position;
  }
  return bytes.size();
}

bool StartsFrame(unsigned marker) {
  return marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
}

// True if the file is complete. `size` becomes that of its first frame.
bool WalkMarkers(const std::string& bytes, JpegSize& size) {
  const auto at = [&](size_t i) { return i < bytes.size() ? static_cast<unsigned char>(bytes[i]) : 0u; };
  const auto numberAt = [&](size_t i) { return 256 * at(i) + at(i + 1); };
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
    if (StartsFrame(marker) && size.width == 0) size = {numberAt(position + 5), numberAt(position + 3)};
    position += numberAt(position);
    if (marker == kStartOfScan) position = SkipScan(bytes, position);
  }
  return false;
}

}  // namespace

JpegSize ReadJpegSize(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string bytes(std::istreambuf_iterator<char>(file), {});
  JpegSize size;
  if (!WalkMarkers(bytes, size)) throw Error("cannot read image \"" + path.string() + "\": the file is truncated");
  if (size.width == 0 || size.height == 0) throw Error("cannot read image \"" + path.string() + "\": it has no size");
  return size;
}

}  // namespace lampyr
