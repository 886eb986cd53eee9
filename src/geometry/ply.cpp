// See ply.h. Format: [Turk94]. Declared counts are accepted only if the rest of the file is long enough for them.
#include "geometry/ply.h"

#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <memory>
#include <optional>
#include <string_view>
#include <system_error>

#include "geometry/polygon.h"

namespace lampyr {

namespace {

enum class Type { Int8, UInt8, Int16, UInt16, Int32, UInt32, Float32, Float64 };
enum class Format { Ascii, LittleEndian, BigEndian };

struct Property {
  std::string name;
  Type type = Type::Float32;
  std::optional<Type> countType;  // of a list
};

struct Element {
  std::string name;
  uint64_t count = 0;
  std::vector<Property> properties;
};

size_t SizeOf(Type type) {
  switch (type) {
    case Type::Int8:
    case Type::UInt8:
      return 1;
    case Type::Int16:
    case Type::UInt16:
      return 2;
    case Type::Float64:
      return 8;
    default:
      return 4;
  }
}

// Throws errors of one form: the file, then what is wrong.
struct Failure {
  std::string name;
  FileLocation where;
  [[noreturn]] void operator()(const std::string& text) const { throw Error(where, "\"" + name + "\": " + text); }
};

// Reads the values of the body one by one, in any of the formats.
class ValueReader {
 public:
  ValueReader(std::string_view body, Format format, const Failure& fail) : body_(body), format_(format), fail_(fail) {}

  double Read(Type type) {
    if (format_ == Format::Ascii) return ReadAscii();
    const size_t size = SizeOf(type);
    if (size > Remaining()) fail_("the file ends before its data does");
    char bytes[8];
    std::memcpy(bytes, body_.data() + position_, size);
    position_ += size;
    if ((format_ == Format::BigEndian) == (std::endian::native == std::endian::little))
      std::reverse(bytes, bytes + size);
    switch (type) {
      case Type::Int8:
        return As<int8_t>(bytes);
      case Type::UInt8:
        return As<uint8_t>(bytes);
      case Type::Int16:
        return As<int16_t>(bytes);
      case Type::UInt16:
        return As<uint16_t>(bytes);
      case Type::Int32:
        return As<int32_t>(bytes);
      case Type::UInt32:
        return As<uint32_t>(bytes);
      case Type::Float32:
        return static_cast<double>(As<float>(bytes));
      case Type::Float64:
        break;
    }
    return As<double>(bytes);
  }

  // The length of a list: an integer that the rest of the file has room for.
  size_t ReadCount(const Property& property) {
    const double count = Read(*property.countType);
    if (!(count >= 0) || count != std::floor(count)) fail_("a list \"" + property.name + "\" has no valid length");
    if (count * static_cast<double>(SmallestSize(property.type)) > static_cast<double>(Remaining())) {
      fail_("a list \"" + property.name + "\" is longer than the file");
    }
    return static_cast<size_t>(count);
  }

  size_t Remaining() const { return body_.size() - position_; }

  // Smallest size of a value in bytes. One digit in ascii: the last value need not have a separator.
  size_t SmallestSize(Type type) const { return format_ == Format::Ascii ? 1 : SizeOf(type); }

 private:
  template <class T>
  static T As(const char* bytes) {
    T value;
    std::memcpy(&value, bytes, sizeof(T));
    return value;
  }

  double ReadAscii() {
    const auto isSpace = [](char c) { return c == ' ' || c == '\n' || c == '\r' || c == '\t'; };
    while (position_ < body_.size() && isSpace(body_[position_])) ++position_;
    if (position_ == body_.size()) fail_("the file ends before its data does");
    const char* begin = body_.data() + position_;
    const char* end = begin;
    while (end < body_.data() + body_.size() && !isSpace(*end)) ++end;
    double value = 0;
    const char* number = *begin == '+' ? begin + 1 : begin;
    const auto [stop, error] = std::from_chars(number, end, value);
    if (error == std::errc::result_out_of_range) {
      value = 0;  // below the smallest double; values above the largest are rejected as not finite
      if (std::string_view(begin, end).find("e-") == std::string_view::npos &&
          std::string_view(begin, end).find("E-") == std::string_view::npos) {
        value = HUGE_VAL;
      }
    } else if (error != std::errc() || stop != end) {
      fail_("\"" + std::string(begin, std::min<size_t>(static_cast<size_t>(end - begin), 40)) + "\" is not a number");
    }
    position_ = static_cast<size_t>(end - body_.data());
    return value;
  }

  std::string_view body_;
  size_t position_ = 0;
  Format format_;
  const Failure& fail_;
};

// Header lines as words. Lines end with \n, \r\n or \r.
class HeaderReader {
 public:
  HeaderReader(std::string_view content, const Failure& fail) : content_(content), fail_(fail) {}

  // The words of the next line that is no comment. Throws at the end of the file.
  std::vector<std::string> NextLine() {
    for (;;) {
      if (position_ >= content_.size()) fail_("the header has no end_header");
      const size_t end = std::min(content_.find_first_of("\r\n", position_), content_.size());
      std::vector<std::string> words = Split(content_.substr(position_, end - position_));
      position_ = std::min(end + 1, content_.size());
      // \r\n is one line end: data of a binary file starts right after it.
      if (end < content_.size() && content_[end] == '\r' && position_ < content_.size() &&
          content_[position_] == '\n') {
        ++position_;
      }
      if (!words.empty() && words[0] != "comment" && words[0] != "obj_info") return words;
    }
  }

  std::string_view Rest() const { return content_.substr(position_); }

 private:
  static std::vector<std::string> Split(std::string_view line) {
    std::vector<std::string> words;
    size_t i = 0;
    while ((i = line.find_first_not_of(" \t", i)) != std::string_view::npos) {
      const size_t end = std::min(line.find_first_of(" \t", i), line.size());
      words.emplace_back(line.substr(i, end - i));
      i = end;
    }
    return words;
  }

  std::string_view content_;
  size_t position_ = 0;
  const Failure& fail_;
};

Type ParseType(const std::string& word, const Failure& fail) {
  static constexpr std::pair<std::string_view, Type> names[] = {
      {"char", Type::Int8},     {"int8", Type::Int8},       {"uchar", Type::UInt8},    {"uint8", Type::UInt8},
      {"short", Type::Int16},   {"int16", Type::Int16},     {"ushort", Type::UInt16},  {"uint16", Type::UInt16},
      {"int", Type::Int32},     {"int32", Type::Int32},     {"uint", Type::UInt32},    {"uint32", Type::UInt32},
      {"float", Type::Float32}, {"float32", Type::Float32}, {"double", Type::Float64}, {"float64", Type::Float64}};
  for (const auto& [name, type] : names) {
    if (name == word) return type;
  }
  fail("unknown property type \"" + word.substr(0, 40) + "\"");
}

struct Header {
  Format format = Format::Ascii;
  std::vector<Element> elements;
};

Format ParseFormat(const std::vector<std::string>& words, const Failure& fail) {
  if (words.size() == 3 && words[0] == "format" && words[2] == "1.0") {
    if (words[1] == "ascii") return Format::Ascii;
    if (words[1] == "binary_little_endian") return Format::LittleEndian;
    if (words[1] == "binary_big_endian") return Format::BigEndian;
  }
  fail("the second line must be \"format ascii 1.0\", or binary_little_endian or binary_big_endian");
}

void ParseProperty(const std::vector<std::string>& words, Header& header, const Failure& fail) {
  if (header.elements.empty()) fail("a property comes before the first element");
  Property property;
  property.name = words.back();
  if (words.size() == 5 && words[1] == "list") {
    property.countType = ParseType(words[2], fail);
    if (*property.countType == Type::Float32 || *property.countType == Type::Float64) {
      fail("the length of list \"" + property.name + "\" is of a floating-point type");
    }
    property.type = ParseType(words[3], fail);
  } else if (words.size() == 3) {
    property.type = ParseType(words[1], fail);
  } else {
    fail("a property line is not understood");
  }
  header.elements.back().properties.push_back(property);
}

Header ParseHeader(HeaderReader& reader, const Failure& fail) {
  Header header;
  if (reader.NextLine() != std::vector<std::string>{"ply"}) fail("not a PLY file: it does not begin with \"ply\"");
  header.format = ParseFormat(reader.NextLine(), fail);
  for (;;) {
    const std::vector<std::string> words = reader.NextLine();
    if (words[0] == "end_header") return header;
    if (words[0] == "property") {
      ParseProperty(words, header, fail);
    } else if (words[0] == "element" && words.size() == 3) {
      Element element{words[1], 0, {}};
      const char* end = words[2].data() + words[2].size();
      const auto [stop, error] = std::from_chars(words[2].data(), end, element.count);
      if (error != std::errc() || stop != end) fail("element \"" + words[1] + "\" has no valid count");
      header.elements.push_back(element);
    } else {
      fail("header line \"" + words[0].substr(0, 40) + " …\" is not understood");
    }
  }
}

// Rejects an impossible count before memory is allocated for it.
void CheckCount(const Element& element, const ValueReader& reader, const Failure& fail) {
  uint64_t smallest = 0;
  for (const Property& p : element.properties) smallest += reader.SmallestSize(p.countType ? *p.countType : p.type);
  if (element.properties.empty()) fail("element \"" + element.name + "\" has no properties");
  if (element.count > 0xfffffff0u || element.count * smallest > reader.Remaining()) {
    fail("element \"" + element.name + "\" counts " + std::to_string(element.count) + ", more than the file holds");
  }
}

void SkipValue(const Property& property, ValueReader& reader) {
  const size_t count = property.countType ? reader.ReadCount(property) : 1;
  for (size_t i = 0; i < count; ++i) reader.Read(property.type);
}

// Slot of a vertex property: 0-2 position, 3-5 normal, 6-7 texture coordinates; -1 if it has none.
int VertexSlot(const std::string& name) {
  static constexpr std::pair<std::string_view, int> names[] = {
      {"x", 0}, {"y", 1}, {"z", 2}, {"nx", 3},        {"ny", 4},        {"nz", 5},        {"u", 6},
      {"v", 7}, {"s", 6}, {"t", 7}, {"texture_u", 6}, {"texture_v", 7}, {"texture_s", 6}, {"texture_t", 7}};
  for (const auto& [known, slot] : names) {
    if (known == name) return slot;
  }
  return -1;
}

void ReadVertices(const Element& element, ValueReader& reader, PlyMesh& mesh, const Failure& fail) {
  std::vector<int> slots;
  bool has[8] = {};
  for (const Property& p : element.properties) {
    slots.push_back(p.countType ? -1 : VertexSlot(p.name));
    if (slots.back() >= 0) has[slots.back()] = true;
  }
  if (!has[0] || !has[1] || !has[2]) fail("its vertices lack x, y or z");
  const bool hasNormals = has[3] && has[4] && has[5], hasUvs = has[6] && has[7];
  mesh.positions.reserve(element.count + 1);  // one more than needed: the intersector reads past the last vertex
  for (uint64_t i = 0; i < element.count; ++i) {
    float values[8] = {};
    bool hasNormal = true;
    for (size_t k = 0; k < slots.size(); ++k) {
      if (slots[k] < 0) {
        SkipValue(element.properties[k], reader);
        continue;
      }
      const double value = reader.Read(element.properties[k].type);
      if (!(std::abs(value) <= 1e18)) {
        // Some exporters write such normals for faces without area, which need none.
        if (slots[k] >= 3 && slots[k] <= 5) {
          hasNormal = false;
          continue;
        }
        fail("vertex " + std::to_string(i) + ": " + element.properties[k].name + " is not finite, or beyond 1e18");
      }
      values[slots[k]] = static_cast<float>(value);
    }
    mesh.positions.emplace_back(values[0], values[1], values[2]);
    if (hasNormals) {
      mesh.normals.push_back(hasNormal ? Normal3(values[3], values[4], values[5]) : Normal3(0.0f));
      mesh.missingNormals += hasNormal ? 0 : 1;
    }
    if (hasUvs) mesh.uvs.emplace_back(values[6], values[7]);
  }
}

struct FaceIndices {
  std::vector<int> ofTriangles, ofQuads;
};

// A face of more than four corners.
struct Polygon {
  uint64_t face = 0;
  size_t firstTriangle = 0;
  std::vector<uint32_t> corners;
};

// Splits a face as a fan. ReplaceFans corrects it once all positions are read, which may come after the faces.
void AddFace(const std::vector<uint32_t>& corners, int faceIndex, PlyMesh& mesh, FaceIndices& indices) {
  if (corners.size() == 4) {
    mesh.quads.push_back({corners[0], corners[1], corners[2], corners[3]});
    indices.ofQuads.push_back(faceIndex);
    return;
  }
  for (size_t k = 2; k < corners.size(); ++k) {
    mesh.triangles.push_back({corners[0], corners[k - 1], corners[k]});
    indices.ofTriangles.push_back(faceIndex);
  }
}

// Triangles of polygons with notches, which fans would fill.
void ReplaceFans(const std::vector<Polygon>& polygons, PlyMesh& mesh, const Failure& fail) {
  constexpr size_t kMostCorners = 2000;  // ears are searched in quadratic time
  for (const Polygon& polygon : polygons) {
    if (IsFan(mesh.positions, polygon.corners)) continue;
    if (polygon.corners.size() > kMostCorners) {
      fail("face " + std::to_string(polygon.face) + " has " + std::to_string(polygon.corners.size()) +
           " corners and is not convex: split it into triangles (of up to 2000 corners that is done here)");
    }
    const std::vector<TriangleCorners> triangles = CutEars(mesh.positions, polygon.corners);
    std::copy(triangles.begin(), triangles.end(),
              mesh.triangles.begin() + static_cast<std::ptrdiff_t>(polygon.firstTriangle));
  }
}

void ReadFaces(const Element& element, ValueReader& reader, uint64_t vertexCount, PlyMesh& mesh,
               std::vector<Polygon>& polygons, const Failure& fail) {
  bool hasCorners = false, hasIndices = false;
  const auto isCorners = [](const Property& p) {
    return p.countType && (p.name == "vertex_indices" || p.name == "vertex_index");
  };
  for (const Property& p : element.properties) {
    hasCorners |= isCorners(p);
    hasIndices |= !p.countType && p.name == "face_indices";
  }
  if (!hasCorners) fail("its faces lack the list vertex_indices");
  std::vector<uint32_t> corners;
  FaceIndices indices;
  for (uint64_t i = 0; i < element.count; ++i) {
    int faceIndex = 0;
    for (const Property& p : element.properties) {
      if (isCorners(p)) {
        corners.resize(reader.ReadCount(p));
        if (corners.size() < 3) fail("face " + std::to_string(i) + " has fewer than three corners");
        for (uint32_t& corner : corners) {
          const double index = reader.Read(p.type);
          if (!(index >= 0 && index < static_cast<double>(vertexCount)) || index != std::floor(index)) {
            fail("face " + std::to_string(i) + " has a vertex index that none of the " + std::to_string(vertexCount) +
                 " vertices has");
          }
          corner = static_cast<uint32_t>(index);
        }
      } else if (!p.countType && p.name == "face_indices") {
        const double value = reader.Read(p.type);
        if (!(std::abs(value) <= 2147483647.0)) fail("face " + std::to_string(i) + " has an invalid face_indices");
        faceIndex = static_cast<int>(value);
      } else {
        SkipValue(p, reader);
      }
    }
    // If the positions are read already, only polygons with notches are kept.
    if (corners.size() > 4 && (mesh.positions.size() < vertexCount || !IsFan(mesh.positions, corners)))
      polygons.push_back({i, mesh.triangles.size(), corners});
    AddFace(corners, faceIndex, mesh, indices);
  }
  if (hasIndices) {
    mesh.faceIndices = std::move(indices.ofTriangles);
    mesh.faceIndices.insert(mesh.faceIndices.end(), indices.ofQuads.begin(), indices.ofQuads.end());
  }
}

std::string ReadWhole(const std::filesystem::path& path, const Failure& fail) {
  std::error_code ignored;
  const std::filesystem::file_status status = std::filesystem::status(path, ignored);
  if (std::filesystem::is_directory(status)) fail("is a folder");
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) fail("is not a regular file");
  const std::unique_ptr<gzFile_s, int (*)(gzFile)> file(gzopen(path.c_str(), "rb"), gzclose);
  if (!file) fail("cannot be opened: " + std::system_category().message(errno));
  gzbuffer(file.get(), 1 << 18);
  std::string content;
  constexpr size_t kChunk = 1 << 20, kAlwaysFine = size_t{64} << 20, kLargestGrowth = 200;
  const std::uintmax_t fileSize = std::filesystem::file_size(path, ignored);
  for (;;) {
    const size_t size = content.size();
    if (content.capacity() < size + kChunk) content.reserve(2 * size + kChunk);
    content.resize(size + kChunk);
    const int got = gzread(file.get(), content.data() + size, kChunk);
    int code = Z_OK;
    const char* message = gzerror(file.get(), &code);
    if (got < 0 || (code != Z_OK && code != Z_STREAM_END)) {
      fail(code == Z_BUF_ERROR ? "the gzipped file ends too early" : std::string("cannot be read: ") + message);
    }
    content.resize(size + static_cast<size_t>(got));
    if (content.size() > kAlwaysFine && content.size() / kLargestGrowth > fileSize) {
      fail("grows to more than 200 times its size when it is decompressed: it is no mesh");
    }
    if (got == 0) return content;
  }
}

}  // namespace

PlyMesh ParsePly(const std::string& content, const std::string& name, const FileLocation& where) {
  const Failure fail{name, where};
  HeaderReader headerReader(content, fail);
  const Header header = ParseHeader(headerReader, fail);
  ValueReader reader(headerReader.Rest(), header.format, fail);
  PlyMesh mesh;
  std::vector<Polygon> polygons;
  uint64_t vertexCount = 0;
  bool hasVertices = false, hasFaces = false;
  for (const Element& element : header.elements) {
    if (element.name == "vertex") vertexCount = element.count;
  }
  for (const Element& element : header.elements) {
    CheckCount(element, reader, fail);
    bool& seen = element.name == "vertex" ? hasVertices : hasFaces;
    if (element.name == "vertex" || element.name == "face") {
      if (seen) fail("element \"" + element.name + "\" comes twice");
      seen = true;
    }
    if (element.name == "vertex") {
      ReadVertices(element, reader, mesh, fail);
    } else if (element.name == "face") {
      ReadFaces(element, reader, vertexCount, mesh, polygons, fail);
    } else {
      for (uint64_t i = 0; i < element.count; ++i) {
        for (const Property& p : element.properties) SkipValue(p, reader);
      }
    }
  }
  if (!hasVertices) fail("has no element \"vertex\"");
  if (!hasFaces) fail("has no element \"face\"");
  ReplaceFans(polygons, mesh, fail);
  return mesh;
}

PlyMesh ReadPly(const std::filesystem::path& path, const FileLocation& where) {
  return ParsePly(ReadWhole(path, Failure{path.string(), where}), path.string(), where);
}

}  // namespace lampyr
