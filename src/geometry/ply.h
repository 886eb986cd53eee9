// PLY files: ascii, binary of either byte order, gzipped or not; any property types; vertices with normals and texture
// coordinates, faces of any number of corners.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "base/error.h"
#include "math/vec.h"

namespace lampyr {

struct PlyMesh {
  std::vector<Point3> positions;
  std::vector<Normal3> normals;  // per vertex, or empty; as in the file (not normalised); 0 for none
  size_t missingNormals = 0;     // number of normals set to 0 because those of the file are not finite, or beyond 1e18
  std::vector<Point2> uvs;       // per vertex, or empty
  std::vector<std::array<uint32_t, 3>> triangles;  // also of faces of more than four corners
  // Corners in order around the face; as a bilinear patch p00 p10 p01 p11 that is corners 0, 1, 3, 2.
  std::vector<std::array<uint32_t, 4>> quads;
  // The file's face_indices: one for each triangle and then one for each quad; empty when there are none.
  std::vector<int> faceIndices;
};

// Throws Error that names the file and its defect; `where` is the statement that refers to the file.
PlyMesh ReadPly(const std::filesystem::path& path, const FileLocation& where = {});

// Parses a file in memory; `name` stands for the file in messages.
PlyMesh ParsePly(const std::string& content, const std::string& name, const FileLocation& where = {});

}  // namespace lampyr
