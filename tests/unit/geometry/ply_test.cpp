// PLY files that are right, in every format.
#include <gtest/gtest.h>
#include <zlib.h>

#include <cstring>
#include <filesystem>
#include <fstream>

#include "geometry/ply.h"
#include "geometry/polygon.h"

namespace lampyr {
namespace {

// Appends values in a byte order.
class Bytes {
 public:
  explicit Bytes(bool bigEndian) : bigEndian_(bigEndian) {}
  template <class T>
  Bytes& Add(T value) {
    char raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof(T));
    if (bigEndian_) std::reverse(raw, raw + sizeof(T));
    text_.append(raw, sizeof(T));
    return *this;
  }
  const std::string& Text() const { return text_; }

 private:
  bool bigEndian_;
  std::string text_;
};

std::string BinarySquare(bool bigEndian) {
  std::string header =
      std::string("ply\nformat ") + (bigEndian ? "binary_big_endian" : "binary_little_endian") +
      " 1.0\ncomment by hand\nelement vertex 5\nproperty double x\nproperty float y\nproperty short z\n"
      "property uchar red\nproperty float nx\nproperty float ny\nproperty float nz\nproperty float s\n"
      "property float t\nelement edge 2\nproperty int a\nproperty list uchar short b\nelement face 3\n"
      "property uchar flag\nproperty list uint8 uint32 vertex_indices\nproperty int face_indices\n"
      "end_header\n";
  Bytes body(bigEndian);
  for (int i = 0; i < 5; ++i) {
    body.Add(i * 0.5).Add(i * 0.25f).Add(static_cast<int16_t>(-i)).Add(uint8_t{7}).Add(0.f).Add(0.f).Add(1.f);
    body.Add(i * 0.1f).Add(i * 0.2f);
  }
  for (int i = 0; i < 2; ++i) body.Add(int32_t{3}).Add(uint8_t{2}).Add(int16_t{1}).Add(int16_t{2});
  body.Add(uint8_t{1}).Add(uint8_t{3}).Add(0u).Add(1u).Add(2u).Add(int32_t{10});
  body.Add(uint8_t{1}).Add(uint8_t{4}).Add(0u).Add(1u).Add(2u).Add(3u).Add(int32_t{11});
  body.Add(uint8_t{1}).Add(uint8_t{5}).Add(4u).Add(3u).Add(2u).Add(1u).Add(0u).Add(int32_t{12});
  return header + body.Text();
}

void CheckSquare(const PlyMesh& mesh) {
  ASSERT_EQ(mesh.positions.size(), 5u);
  EXPECT_EQ(mesh.positions[3], Point3(1.5f, 0.75f, -3));
  ASSERT_EQ(mesh.normals.size(), 5u);
  EXPECT_EQ(mesh.normals[4], Normal3(0, 0, 1));
  ASSERT_EQ(mesh.uvs.size(), 5u);
  EXPECT_FLOAT_EQ(mesh.uvs[2].y, 0.4f);
  // A triangle, a quad and a pentagon as a fan.
  ASSERT_EQ(mesh.triangles.size(), 4u);
  EXPECT_EQ(mesh.triangles[3], (std::array<uint32_t, 3>{4, 1, 0}));
  ASSERT_EQ(mesh.quads.size(), 1u);
  EXPECT_EQ(mesh.quads[0], (std::array<uint32_t, 4>{0, 1, 2, 3}));
  EXPECT_EQ(mesh.faceIndices, (std::vector<int>{10, 12, 12, 12, 11}));
}

// A pentagon with a notch, from whichever corner it is listed, before or after its vertices.
TEST(Ply, NotchesStayOpen) {
  const std::string header = "ply\nformat ascii 1.0\n",
                    vertex =
                        "element vertex 5\nproperty float x\nproperty float y\n"
                        "property float z\n",
                    face = "element face 1\nproperty list uchar int vertex_index\n";
  const std::string positions = "2 0 0\n2 4 4\n2 4 0\n2 0 4\n2 2 1\n";
  const std::vector<uint32_t> around = {0, 2, 1, 4, 3};
  for (const bool isReversed : {false, true}) {
    for (size_t start = 0; start < around.size(); ++start) {
      std::string corners = "5";
      for (size_t i = 0; i < around.size(); ++i)
        corners += " " + std::to_string(around[(isReversed ? start + 5 - i : start + i) % 5]);
      const std::string files[] = {header + vertex + face + "end_header\n" + positions + corners + "\n",
                                   header + face + vertex + "end_header\n" + corners + "\n" + positions};
      for (const std::string& file : files) {
        const PlyMesh mesh = ParsePly(file, "notch.ply");
        ASSERT_EQ(mesh.triangles.size(), 3u);
        double size = 0;
        for (const auto& t : mesh.triangles) {
          const Vector3 a = mesh.positions[t[1]] - mesh.positions[t[0]],
                        b = mesh.positions[t[2]] - mesh.positions[t[0]];
          const double area = 0.5 * static_cast<double>(glm::cross(a, b).x) * (isReversed ? -1 : 1);
          EXPECT_GE(area, 0) << corners;
          size += area;
        }
        EXPECT_NEAR(size, 10, 1e-6) << corners;
      }
    }
  }
}

// A comb: every second corner is in a notch. Each triangle lies in the polygon, and together they are it.
TEST(Ply, EarsOfACombAreThePolygon) {
  std::vector<Point3> positions = {{20, 0, 0}, {0, 0, 0}};
  for (int i = 0; i <= 20; ++i)
    positions.emplace_back(static_cast<float>(i), i % 2 ? 1.0f : 9.0f, 0.1f * static_cast<float>(i));
  std::swap(positions[0], positions[1]);
  std::vector<uint32_t> corners = {0, 1};
  for (uint32_t i = 0; i <= 20; ++i) corners.push_back(22 - i);
  EXPECT_FALSE(IsFan(positions, corners));
  const std::vector<TriangleCorners> triangles = CutEars(positions, corners);
  ASSERT_EQ(triangles.size(), corners.size() - 2);
  double size = 0;
  for (const TriangleCorners& t : triangles) {
    const Vector3 a = positions[t[1]] - positions[t[0]], b = positions[t[2]] - positions[t[0]];
    EXPECT_GE(glm::cross(a, b).z, 0);
    size += 0.5 * static_cast<double>(glm::cross(a, b).z);
  }
  EXPECT_NEAR(size, 100, 1e-3);  // twenty trapezoids of 1 × (9 + 1) / 2
}

class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& name) : path_(std::filesystem::temp_directory_path() / name) {}
  ~TemporaryFile() { std::filesystem::remove(path_); }
  const std::filesystem::path& Path() const { return path_; }

 private:
  std::filesystem::path path_;
};

TEST(Ply, BinaryOfBothByteOrders) {
  CheckSquare(ParsePly(BinarySquare(false), "little.ply"));
  CheckSquare(ParsePly(BinarySquare(true), "big.ply"));
}

TEST(Ply, FilesPlainAndGzipped) {
  const TemporaryFile plain("lampyr_ply_test.ply"), zipped("lampyr_ply_test.ply.gz");
  const std::string content = BinarySquare(true);
  std::ofstream(plain.Path(), std::ios::binary) << content;
  CheckSquare(ReadPly(plain.Path()));
  gzFile file = gzopen(zipped.Path().c_str(), "wb");
  gzwrite(file, content.data(), static_cast<unsigned>(content.size()));
  gzclose(file);
  CheckSquare(ReadPly(zipped.Path()));
}

TEST(Ply, AsciiWithAnyLineEnds) {
  const std::string text =
      "ply\nformat ascii 1.0\nobj_info x\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
      "property float texture_u\nproperty float texture_v\nelement face 2\nproperty list uchar int "
      "vertex_index\nend_header\n"
      "0 0 0 0 0\n1e0 0 0 1 0\n+1 1. 1e-60 1 1\n0 1 -.5 0 1\n3 0 1 2\n4 0 1 2 3";
  for (const std::string lineEnd : {"\n", "\r\n", "\r"}) {
    std::string content;
    for (const char c : text) content += c == '\n' ? lineEnd : std::string(1, c);
    const PlyMesh mesh = ParsePly(content, "ascii.ply");
    ASSERT_EQ(mesh.positions.size(), 4u);
    EXPECT_EQ(mesh.positions[2], Point3(1, 1, 0));
    EXPECT_EQ(mesh.positions[3].z, -0.5f);
    EXPECT_EQ(mesh.uvs[3], Point2(0, 1));
    EXPECT_EQ(mesh.triangles.size(), 1u);
    EXPECT_EQ(mesh.quads.size(), 1u);
    EXPECT_TRUE(mesh.normals.empty());
    EXPECT_TRUE(mesh.faceIndices.empty());
  }
}

// Published scenes have them; the mesh is there all the same.
TEST(Ply, NormalsThatAreNotFiniteAreLeftOut) {
  const PlyMesh mesh = ParsePly(
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "property float nx\nproperty float ny\nproperty float nz\nelement face 1\nproperty list uchar int "
      "vertex_indices\nend_header\n0 0 0 0 0 1\n1 0 0 0 nan 1\n0 1 0 inf 0 0\n3 0 1 2\n",
      "normals.ply");
  ASSERT_EQ(mesh.normals.size(), 3u);
  EXPECT_EQ(mesh.normals[0], Normal3(0, 0, 1));
  EXPECT_EQ(mesh.normals[1], Normal3(0.0f));
  EXPECT_EQ(mesh.normals[2], Normal3(0.0f));
  EXPECT_EQ(mesh.missingNormals, 2u);
  EXPECT_EQ(mesh.triangles.size(), 1u);
}

TEST(Ply, NoFacesAtAllIsAnEmptyMesh) {
  const PlyMesh mesh = ParsePly(
      "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 0\nproperty list uchar int vertex_indices\nend_header\n",
      "empty.ply");
  EXPECT_TRUE(mesh.positions.empty() && mesh.triangles.empty() && mesh.quads.empty());
}

}  // namespace
}  // namespace lampyr
