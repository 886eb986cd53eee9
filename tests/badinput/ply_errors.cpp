// PLY files that are wrong: an Error that names the file and the fault, whatever the bytes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <filesystem>
#include <fstream>
#include <random>

#include "base/error.h"
#include "geometry/ply.h"

namespace lampyr {
namespace {

using ::testing::HasSubstr;

const FileLocation& Where() {
  static const FileLocation where{std::make_shared<const std::string>("scene.pbrt"), 12, 3};
  return where;
}

std::string MessageOf(const std::string& content) {
  try {
    ParsePly(content, "mesh.ply", Where());
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

const std::string kVertex = "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
const std::string kFace = "element face 1\nproperty list uchar int vertex_indices\n";
const std::string kBody = "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

std::string Ascii(const std::string& declarations, const std::string& body) {
  return "ply\nformat ascii 1.0\n" + declarations + "end_header\n" + body;
}

TEST(PlyErrors, TheGoodOneIsGood) {
  EXPECT_EQ(MessageOf(Ascii(kVertex + kFace, kBody)), "no error");
}

TEST(PlyErrors, NameTheFileAndTheFault) {
  const std::pair<std::string, std::string> cases[] = {
      {"", "header has no end_header"},
      {"plx\n", "does not begin with \"ply\""},
      {"ply\nformat ascii 2.0\n", "format ascii 1.0"},
      {"ply\nformat binary_middle_endian 1.0\n", "format ascii 1.0"},
      {"ply\nformat ascii 1.0\nelement vertex 3\n", "header has no end_header"},
      {Ascii("property float x\n", ""), "before the first element"},
      {Ascii("element vertex -3\n", ""), "no valid count"},
      {Ascii("element vertex 3x\n", ""), "no valid count"},
      {Ascii("element vertex 99999999999999999999999\n", ""), "no valid count"},
      {Ascii("element vertex 3\nproperty quad x\n", ""), "unknown property type \"quad\""},
      {Ascii("element vertex 3\nproperty float\n", ""), "property line"},
      {Ascii("nonsense\n", ""), "\"nonsense"},
      {Ascii("element vertex 3\n" + kFace, kBody), "no properties"},
      {Ascii(kFace, "3 0 1 2"), "none of the 0 vertices"},
      {Ascii(kVertex, "0 0 0 1 0 0 0 1 0"), "no element \"face\""},
      {Ascii(kVertex + kVertex + kFace, kBody + kBody), "comes twice"},
      {Ascii("element vertex 3\nproperty float x\nproperty float y\n" + kFace, kBody), "lack x, y or z"},
      {Ascii(kVertex + "element face 1\nproperty uchar vertex_indices\n", kBody), "lack the list vertex_indices"},
      {Ascii(kVertex + "element face 1\nproperty list float int vertex_indices\n", kBody), "floating-point"},
      {Ascii(kVertex + kFace, "0 0 0\n1 0 0\n0 1"), "ends before its data"},
      {Ascii(kVertex + kFace, "0 0 0\n1 0 0\n0 1 0\n3 0 1"), "ends before its data"},
      {Ascii(kVertex + kFace, "0 0 0\n1 x 0\n0 1 0\n3 0 1 2"), "\"x\" is not a number"},
      {Ascii(kVertex + kFace, "0 0 0\n1 nan 0\n0 1 0\n3 0 1 2"), "vertex 1: y is not finite"},
      {Ascii(kVertex + kFace, "0 0 0\n1 0 -inf\n0 1 0\n3 0 1 2"), "vertex 1: z is not finite"},
      {Ascii(kVertex + kFace, "0 0 0\n1e999 0 0\n0 1 0\n3 0 1 2"), "vertex 1: x is not finite"},
      {Ascii(kVertex + kFace, "0 0 0\n1e30 0 0\n0 1 0\n3 0 1 2"), "beyond 1e18"},
      {Ascii(kVertex + kFace, "0 0 0\n1 0 0\n0 1 0\n3 0 1 3"), "face 0 has a vertex index"},
      {Ascii(kVertex + kFace, "0 0 0\n1 0 0\n0 1 0\n3 0 1 -1"), "face 0 has a vertex index"},
      {Ascii(kVertex + kFace, "0 0 0\n1 0 0\n0 1 0\n3 0 1 1.5"), "face 0 has a vertex index"},
      {Ascii(kVertex + kFace, "0 0 0\n1 0 0\n0 1 0\n3 0 1 nan"), "face 0 has a vertex index"},
      {Ascii(kVertex + kFace, "0 0 0\n1 0 0\n0 1 0\n2 0 1"), "fewer than three corners"},
      {Ascii(kVertex + kFace, "0 0 0\n1 0 0\n0 1 0\n-3 0 1 2"), "no valid length"},
      {Ascii(kVertex + kFace, "0 0 0\n1 0 0\n0 1 0\n4000000000 0 1 2"), "longer than the file"},
  };
  for (const auto& [content, fault] : cases) {
    const std::string message = MessageOf(content);
    EXPECT_THAT(message, HasSubstr(fault)) << content;
    EXPECT_THAT(message, HasSubstr("scene.pbrt:12:3: error: \"mesh.ply\": "));
  }
}

TEST(PlyErrors, AbsurdCountsAskForNoMemory) {
  for (const std::string count : {"1000000000", "4294967295", "18446744073709551615", "4611686018427387905"}) {
    for (const std::string format : {"ascii", "binary_little_endian"}) {
      EXPECT_THAT(
          MessageOf("ply\nformat " + format + " 1.0\nelement vertex " + count +
                    "\nproperty float x\nproperty float y\nproperty float z\n" + kFace + "end_header\n" + kBody),
          HasSubstr("more than the file holds"));
      EXPECT_THAT(MessageOf("ply\nformat " + format +
                            " 1.0\nelement vertex 0\nproperty float x\nproperty float y\n"
                            "property float z\nelement face " +
                            count + "\nproperty list uchar int vertex_indices\nend_header\n" + kBody),
                  HasSubstr("more than the file holds"));
    }
  }
}

TEST(PlyErrors, FilesThatCannotBeRead) {
  EXPECT_THROW(ReadPly("/nonexistent/mesh.ply", Where()), Error);
  EXPECT_THROW(ReadPly(std::filesystem::temp_directory_path(), Where()), Error);
  // A gzipped file cut short.
  const auto path = std::filesystem::temp_directory_path() / "lampyr_ply_cut.ply.gz";
  gzFile file = gzopen(path.c_str(), "wb");
  std::mt19937 random(1);
  std::string content = Ascii(kVertex + kFace, kBody);
  for (int i = 0; i < 5000; ++i) content += std::to_string(random()) + " ";
  gzwrite(file, content.data(), static_cast<unsigned>(content.size()));
  gzclose(file);
  std::filesystem::resize_file(path, std::filesystem::file_size(path) / 2);
  EXPECT_THROW(ReadPly(path, Where()), Error);
  std::filesystem::remove(path);
}

// Mutated files either parse to a mesh whose indices and vertices are sound, or are Errors; nothing else is thrown.
TEST(PlyErrors, MutationsNeverCrash) {
  std::string binary =
      "ply\nformat binary_little_endian 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
      "property float z\nproperty float u\nproperty float v\nelement face 2\n"
      "property list uchar int vertex_indices\nproperty int face_indices\nend_header\n";
  const float values[20] = {0, 0, 0, 0, 0, 1, 0, 0, 1, 0, 1, 1, 0, 1, 1, 0, 1, 0, 0, 1};
  binary.append(reinterpret_cast<const char*>(values), sizeof(values));
  for (int face = 0; face < 2; ++face) {
    const int corners[4] = {0, 1, 2, face + 2};
    binary += static_cast<char>(4);
    binary.append(reinterpret_cast<const char*>(corners), sizeof(corners));
    binary.append(reinterpret_cast<const char*>(&face), sizeof(face));
  }
  std::string bigEndian = binary;
  bigEndian.replace(bigEndian.find("little"), 6, "big");
  const std::string originals[] = {Ascii(kVertex + kFace, kBody), binary, bigEndian};
  std::mt19937 random(99);
  int errors = 0, sound = 0;
  for (int i = 0; i < 30000; ++i) {
    std::string content = originals[i % 3];
    const int changes = 1 + static_cast<int>(random() % 2);
    for (int k = 0; k < changes && !content.empty(); ++k) {
      const size_t at = random() % content.size();
      switch (random() % 5) {
        case 0:
          content[at] = static_cast<char>(random());
          break;
        case 1:
          content.erase(at, 1 + random() % 8);
          break;
        case 2:
          content.insert(at, 1 + random() % 3, static_cast<char>(random()));
          break;
        case 3:
          content[at] = static_cast<char>('0' + random() % 10);
          break;
        default:
          content.resize(std::max<size_t>(at, 1));
          break;
      }
    }
    try {
      const PlyMesh mesh = ParsePly(content, "mesh.ply", Where());
      ++sound;
      for (const auto& t : mesh.triangles) {
        for (const uint32_t index : t) ASSERT_LT(index, mesh.positions.size());
      }
      for (const auto& q : mesh.quads) {
        for (const uint32_t index : q) ASSERT_LT(index, mesh.positions.size());
      }
      for (const Point3& p : mesh.positions) ASSERT_TRUE(IsFinite(p));
      ASSERT_TRUE(mesh.uvs.empty() || mesh.uvs.size() == mesh.positions.size());
    } catch (const Error&) {
      ++errors;
    }
  }
  EXPECT_GT(errors, 10000);
  EXPECT_GT(sound, 500);
}

}  // namespace
}  // namespace lampyr
