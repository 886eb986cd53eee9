// Loop subdivision: counts, symmetry, known limits, boundaries, and input that is no surface.
#include <gtest/gtest.h>

#include <set>

#include "base/error.h"
#include "geometry/loop_subdivision.h"
#include "helpers.h"

namespace lampyr {
namespace {

using Faces = std::vector<std::array<uint32_t, 3>>;

const std::vector<Point3> kOctahedron = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
const Faces kOctahedronFaces = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};

size_t CountEdges(const Faces& faces) {
  std::set<std::pair<uint32_t, uint32_t>> edges;
  for (const auto& f : faces) {
    for (size_t k = 0; k < 3; ++k) edges.insert(std::minmax(f[k], f[(k + 1) % 3]));
  }
  return edges.size();
}

TEST(LoopSubdivision, CountsAndEuler) {
  for (int levels = 0; levels <= 4; ++levels) {
    const SubdividedMesh mesh = Subdivide(kOctahedron, kOctahedronFaces, levels);
    EXPECT_EQ(mesh.triangles.size(), 8u << (2 * levels));
    EXPECT_EQ(mesh.positions.size(), 2 + mesh.triangles.size() / 2);
    EXPECT_EQ(mesh.positions.size() + mesh.triangles.size() - CountEdges(mesh.triangles), 2u);
    EXPECT_EQ(mesh.normals.size(), mesh.positions.size());
  }
}

TEST(LoopSubdivision, VerticesLieOnTheLimitAtEveryLevel) {
  // The limit of an octahedron's vertex: valence 4, opposite neighbours cancel: p · (1 - 4γ), γ = 1/(4 + 3/(8·3/32)) =
  // 1/8.
  for (int levels = 0; levels <= 4; ++levels) {
    const SubdividedMesh mesh = Subdivide(kOctahedron, kOctahedronFaces, levels);
    for (size_t i = 0; i < 6; ++i) {
      EXPECT_NEAR(glm::length(mesh.positions[i] - kOctahedron[i] * 0.5f), 0, 1e-6);
      // Against the winding: inwards.
      EXPECT_NEAR(glm::length(mesh.normals[i] + kOctahedron[i]), 0, 1e-5);
    }
  }
  // Further levels keep the limit positions of a level.
  const SubdividedMesh coarse = Subdivide(kOctahedron, kOctahedronFaces, 1),
                       fine = Subdivide(kOctahedron, kOctahedronFaces, 4);
  for (size_t i = 0; i < coarse.positions.size(); ++i) {
    EXPECT_NEAR(glm::length(coarse.positions[i] - fine.positions[i]), 0, 1e-6);
    EXPECT_NEAR(glm::length(coarse.normals[i] - fine.normals[i]), 0, 1e-5);
  }
}

TEST(LoopSubdivision, NormalsAreThoseOfTheFineFacesAgainstTheirWinding) {
  const SubdividedMesh mesh = Subdivide(kOctahedron, kOctahedronFaces, 5);
  for (const auto& f : mesh.triangles) {
    const Vector3 n = glm::normalize(
        glm::cross(mesh.positions[f[1]] - mesh.positions[f[0]], mesh.positions[f[2]] - mesh.positions[f[0]]));
    EXPECT_GT(glm::dot(n, mesh.positions[f[0]]), 0);
    // Curvature is unbounded at vertices of valence 4, so faces there stay at an angle.
    for (const uint32_t i : f) EXPECT_LT(glm::dot(n, mesh.normals[i]), -0.97f);
  }
}

struct Grid {
  std::vector<Point3> positions;
  Faces faces;
};

Grid FlatGrid(uint32_t n) {
  Grid grid;
  for (uint32_t y = 0; y <= n; ++y) {
    for (uint32_t x = 0; x <= n; ++x) grid.positions.emplace_back(static_cast<float>(x), static_cast<float>(y), 3.0f);
  }
  for (uint32_t y = 0; y < n; ++y) {
    for (uint32_t x = 0; x < n; ++x) {
      const uint32_t i = y * (n + 1) + x;
      grid.faces.push_back({i, i + 1, i + n + 2});
      grid.faces.push_back({i, i + n + 2, i + n + 1});
    }
  }
  return grid;
}

TEST(LoopSubdivision, FlatGridStaysFlatAndRegularPointsStay) {
  const uint32_t n = 5;
  const Grid grid = FlatGrid(n);
  const SubdividedMesh mesh = Subdivide(grid.positions, grid.faces, 3);
  // Euler for a disk: V - E + F = 1.
  EXPECT_EQ(mesh.positions.size() + mesh.triangles.size() - CountEdges(mesh.triangles), 1u);
  for (size_t i = 0; i < mesh.positions.size(); ++i) {
    EXPECT_EQ(mesh.positions[i].z, 3.0f);
    EXPECT_NEAR(mesh.normals[i].z, -1, 1e-5) << i;  // against the winding, corners and borders included
  }
  // Linear precision: interior vertices of a regular grid and the middles of straight borders do not move.
  for (uint32_t y = 1; y < n; ++y) {
    for (uint32_t x = 1; x < n; ++x) {
      const size_t i = y * (n + 1) + x;
      EXPECT_NEAR(glm::length(mesh.positions[i] - grid.positions[i]), 0, 1e-5);
    }
  }
  EXPECT_NEAR(mesh.positions[2].y, 0, 1e-6);
  EXPECT_NEAR(mesh.positions[2].x, 2, 1e-5);
}

TEST(LoopSubdivision, BoundariesFollowTheirOwnNeighboursOnly) {
  // A fan around vertex 0 at the boundary: it moves to 3/5 itself and 1/5 of either boundary neighbour.
  const std::vector<Point3> positions = {{0, 0, 0}, {1, 0, 0.5f}, {0.7f, 0.7f, 0}, {-0.7f, 0.7f, 0}, {-1, 0.1f, 0.25f}};
  const Faces faces = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}};
  const Point3 moved = positions[0] * 0.6f + (positions[1] + positions[4]) * 0.2f;
  EXPECT_NEAR(glm::length(Subdivide(positions, faces, 0).positions[0] - moved), 0, 1e-6);
  // Refined, the boundary is a uniform cubic B-spline: 2/3 and 1/6.
  const Point3 spline = positions[0] * (2.0f / 3) + (positions[1] + positions[4]) * (1.0f / 6);
  EXPECT_NEAR(glm::length(Subdivide(positions, faces, 6).positions[0] - spline), 0, 1e-3);
}

TEST(LoopSubdivision, TouchingFansAreSeparatedAndUnusedVerticesDropped) {
  const std::vector<Point3> positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {-1, 0, 0}, {-1, -1, 0}, {9, 9, 9}};
  const Faces faces = {{0, 1, 2}, {0, 3, 4}};
  const SubdividedMesh mesh = Subdivide(positions, faces, 2);
  EXPECT_EQ(mesh.triangles.size(), 32u);
  EXPECT_EQ(mesh.positions.size() + mesh.triangles.size() - CountEdges(mesh.triangles), 2u);  // two disks
  for (const Point3& p : mesh.positions) EXPECT_LT(glm::length(p), 2);
  for (const Normal3& n : mesh.normals) EXPECT_NEAR(n.z, -1, 1e-5);
}

TEST(LoopSubdivision, EdgesOfManyFacesAreJoinedInPairs) {
  const std::vector<Point3> positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
  const SubdividedMesh mesh = Subdivide(positions, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}, 2);
  EXPECT_EQ(mesh.triangles.size(), 48u);
  // Two faces joined and one alone: two disks.
  EXPECT_EQ(mesh.positions.size() + mesh.triangles.size() - CountEdges(mesh.triangles), 2u);
}

TEST(LoopSubdivision, EveryValenceHasNormals) {
  for (uint32_t valence = 3; valence <= 12; ++valence) {
    for (const bool closed : {true, false}) {
      std::vector<Point3> positions = {{0, 0, 0.3f}};
      Faces faces;
      for (uint32_t i = 0; i < valence; ++i) {
        const float angle =
            (closed ? 2 : 1) * kPi * static_cast<float>(i) / static_cast<float>(closed ? valence : valence - 1);
        positions.emplace_back(std::cos(angle), std::sin(angle), 0.0f);
        if (closed || i > 0) faces.push_back({0, closed ? i + 1 : i, closed ? (i + 1) % valence + 1 : i + 1});
      }
      const SubdividedMesh mesh = Subdivide(positions, faces, 3);
      for (const Normal3& n : mesh.normals) {
        ASSERT_NEAR(glm::length(n), 1, 1e-5);
        ASSERT_LT(n.z, -0.4f) << valence << closed;
      }
      EXPECT_TRUE(!closed || mesh.normals[0].z < -0.99999f);
    }
  }
}

TEST(LoopSubdivision, BadInputIsAnError) {
  const FileLocation where{std::make_shared<const std::string>("a.pbrt"), 7, 1};
  const auto message = [&](const std::vector<Point3>& p, const Faces& f, int levels) -> std::string {
    try {
      Subdivide(p, f, levels, where);
    } catch (const Error& e) {
      return e.what();
    }
    return "";
  };
  const std::vector<Point3> p = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
  EXPECT_NE(message(p, {{0, 1, 2}, {0, 1, 3}}, 1)
                .find("a.pbrt:7:1: error: loopsubdiv: the faces at the edge between vertices 0 and 1"),
            std::string::npos);
  EXPECT_NE(message(p, {{0, 1, 2}, {0, 1, 3}}, 1).find("opposite directions"), std::string::npos);
  EXPECT_NE(message(p, {{0, 1, 5}}, 1).find("beyond the 5 vertices"), std::string::npos);
  EXPECT_NE(message(p, {{0, 1, 1}}, 1).find("same vertex twice"), std::string::npos);
  EXPECT_NE(message(p, {{0, 1, 2}}, -1).find("negative"), std::string::npos);
  EXPECT_NE(message(p, {{0, 1, 2}}, 1000).find("levels"), std::string::npos);
  EXPECT_NE(message({{0, 0, 0}, {1, 0, 0}, {0, std::nanf(""), 0}}, {{0, 1, 2}}, 1).find("not finite"),
            std::string::npos);
  EXPECT_EQ(Subdivide({}, {}, 3).triangles.size(), 0u);
}

}  // namespace
}  // namespace lampyr
