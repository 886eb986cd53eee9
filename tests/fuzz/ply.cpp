#include "geometry/ply.h"
#include "fuzz/target_support.h"

namespace lampyr::fuzz {

namespace {

template <size_t N>
void CheckIndices(const std::vector<std::array<uint32_t, N>>& faces, size_t vertices) {
  for (const auto& face : faces) {
    for (const uint32_t corner : face) {
      if (corner >= vertices) Fail("a face of a vertex that is not there");
    }
  }
}

}  // namespace

bool ReadPlyFile(std::string_view bytes) {
  return AcceptErrors([&] {
    const PlyMesh mesh = IsGzip(bytes) ? ReadPly(AsFile(bytes, ".ply")) : ParsePly(std::string(bytes), "input.ply");
    const size_t vertices = mesh.positions.size();
    CheckIndices(mesh.triangles, vertices);
    CheckIndices(mesh.quads, vertices);
    if (!mesh.normals.empty() && mesh.normals.size() != vertices) Fail("normals of some vertices only");
    if (!mesh.uvs.empty() && mesh.uvs.size() != vertices) Fail("texture coordinates of some vertices only");
    if (!mesh.faceIndices.empty() && mesh.faceIndices.size() != mesh.triangles.size() + mesh.quads.size()) {
      Fail("face indices of some faces only");
    }
    for (const Point3& p : mesh.positions) {
      if (!IsFinite(p)) Fail("a vertex that is not finite");
    }
  });
}

}  // namespace lampyr::fuzz
