#include <fstream>
#include <string>
#include <string_view>

#include "base/error.h"
#include "film/image_formats.h"

namespace lampyr {

namespace {

struct Mark {
  std::string_view bytes;  // at the file's start
  const char* format;
};

constexpr Mark kMarks[] = {{"\x89PNG\r\n\x1a\n", "png"},
                           {"\xff\xd8\xff", "jpeg"},
                           {{"II*\0", 4}, "tiff"},
                           {{"MM\0*", 4}, "tiff"},
                           {{"II+\0", 4}, "tiff"},  // BigTIFF: more than 4 GB
                           {{"MM\0+", 4}, "tiff"},
                           {"#?", "hdr"},
                           {"BM", "bmp"},
                           {"GIF8", "gif"},
                           {"\x76\x2f\x31\x01", "openexr"}};

// P1 … P6, Pf or PF, followed by a blank.
bool IsPortableMap(std::string_view head) {
  constexpr std::string_view kinds = "123456fF", blanks = " \t\r\n";
  return head.size() > 2 && head[0] == 'P' && kinds.find(head[1]) != kinds.npos && blanks.find(head[2]) != blanks.npos;
}

bool IsNamedTarga(const std::filesystem::path& path) {
  const std::string extension = path.extension().string();
  return extension == ".tga" || extension == ".TGA";
}

const char* FormatOf(std::string_view head, const std::filesystem::path& path) {
  for (const Mark& mark : kMarks) {
    if (head.starts_with(mark.bytes)) return mark.format;
  }
  if (head.starts_with("RIFF") && head.size() >= 12 && head.substr(8, 4) == "WEBP") return "webp";
  if (IsPortableMap(head)) return "pnm";
  if (IsNamedTarga(path)) return "targa";  // without a magic number
  throw Error("cannot read image \"" + path.string() +
              "\": its content is of none of the formats that are read: OpenEXR, PNG, JPEG, TIFF, Radiance (hdr), PFM, "
              "PPM, PGM, PBM, BMP, GIF, WebP, Targa (named .tga)");
}

// A little-endian number of `count` bytes; 0 beyond the end.
int64_t NumberAt(std::string_view head, size_t position, size_t count) {
  if (position + count > head.size()) return 0;
  int64_t number = 0;
  for (size_t i = 0; i < count; ++i) number |= int64_t{static_cast<unsigned char>(head[position + i])} << (8 * i);
  return number;
}

void ReadBmpSize(std::string_view head, ImageKind& kind) {
  constexpr int64_t kOldHeader = 12;  // OS/2: sizes have two bytes
  const size_t bytes = NumberAt(head, 14, 4) == kOldHeader ? 2 : 4;
  const auto absolute = [&](int64_t n) { return bytes == 4 && n > 0x7fffffff ? (int64_t{1} << 32) - n : n; };
  kind.width = absolute(NumberAt(head, 18, bytes));
  kind.height = absolute(NumberAt(head, 18 + bytes, bytes));  // negative: rows from the top
}

// The size in the first chunk: lossy, lossless, or the extended header with the size of the canvas.
void ReadWebpSize(std::string_view head, ImageKind& kind) {
  constexpr size_t chunk = 12;
  const std::string_view name = head.substr(chunk, 4);
  if (name == "VP8 ") {
    kind.width = NumberAt(head, 26, 2) & 0x3fff;
    kind.height = NumberAt(head, 28, 2) & 0x3fff;
  } else if (name == "VP8L") {
    const int64_t sizes = NumberAt(head, 21, 4);
    kind.width = (sizes & 0x3fff) + 1;
    kind.height = ((sizes >> 14) & 0x3fff) + 1;
  } else if (name == "VP8X") {
    kind.width = NumberAt(head, 24, 3) + 1;
    kind.height = NumberAt(head, 27, 3) + 1;
  }
}

}  // namespace

ImageKind FindImageKind(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string head(64, '\0');
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<size_t>(file.gcount()));
  ImageKind kind{FormatOf(head, path)};
  const std::string_view format = kind.format;
  if (format == "gif") {
    kind.width = NumberAt(head, 6, 2);
    kind.height = NumberAt(head, 8, 2);
  } else if (format == "bmp") {
    ReadBmpSize(head, kind);
  } else if (format == "webp") {
    ReadWebpSize(head, kind);
  } else if (format == "jpeg") {
    const JpegSize size = ReadJpegSize(path);
    kind.width = size.width;
    kind.height = size.height;
  }
  return kind;
}

}  // namespace lampyr
