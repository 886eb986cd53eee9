#include "geometry/shape_checks.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/error.h"
#include "geometry/quadric.h"

namespace lampyr {

namespace {

bool IsUsable(const Point3& p) {
  return MaxAbsComponent(p) <= kFarthest && IsFinite(p);
}

template <size_t N>
void CheckMesh(const char* what, const std::vector<Point3>& positions,
               const std::vector<std::array<uint32_t, N>>& faces, size_t normals, size_t uvs) {
  const std::string name = what;
  for (size_t i = 0; i < positions.size(); ++i) {
    if (!IsUsable(positions[i])) {
      throw Error(name + ": vertex " + std::to_string(i) + " is not finite, or farther out than 1e18");
    }
  }
  for (size_t i = 0; i < faces.size(); ++i) {
    for (const uint32_t index : faces[i]) {
      if (index >= positions.size()) {
        throw Error(name + ": face " + std::to_string(i) + " has index " + std::to_string(index) + " of only " +
                    std::to_string(positions.size()) + " vertices");
      }
    }
  }
  if (normals != 0 && normals != positions.size()) throw Error(name + ": there must be as many normals as vertices");
  if (uvs != 0 && uvs != positions.size()) throw Error(name + ": there must be as many uv as vertices");
}

void CheckShape(const TriangleMesh& m) {
  CheckMesh("triangle mesh", m.positions, m.triangles, m.normals.size(), m.uvs.size());
}
void CheckShape(const BilinearMesh& m) {
  CheckMesh("bilinear mesh", m.positions, m.patches, m.normals.size(), m.uvs.size());
}
void CheckShape(const PreparedQuadric& q) {
  const Bounds3 bounds = GetBounds(q.Shape());
  const Affine& inverse = q.Shape().toObject;
  if (!(q.Shape().radius > 0)) throw Error("the radius must be above 0");
  if (!IsUsable(bounds.min) || !IsUsable(bounds.max)) throw Error("the shape reaches farther out than 1e18");
  if (!IsUsable(inverse.linear[0]) || !IsUsable(inverse.linear[1]) || !IsUsable(inverse.linear[2]))
    throw Error("the transform of the shape is singular, or makes it smaller than 1e-18 of itself");
}
void CheckShape(const CurveSet& c) {
  if (c.radii.size() != c.segments.size() || c.uRange.size() != c.segments.size() ||
      (c.kind == CurveSet::Kind::Ribbon && c.segmentNormals.size() != c.segments.size())) {
    throw Error("curves: there must be as many radii, ranges and normals as segments");
  }
  for (size_t i = 0; i < c.segments.size(); ++i) {
    for (size_t k = 0; k < 4; ++k) {
      if (!IsUsable(c.segments[i][k]) || !(c.radii[i][k] >= 0) || !(c.radii[i][k] <= kFarthest)) {
        throw Error("curves: segment " + std::to_string(i) + " is not finite");
      }
    }
  }
}

void CheckShape(const CustomSurface& surface) {
  const Bounds3 bounds = surface.GetBounds(0, 1);
  if (!IsUsable(bounds.min) || !IsUsable(bounds.max)) {
    throw Error("surface of a light: it is not finite, or reaches farther than 1e18");
  }
}

struct ShapeCheck {
  template <class T>
  void operator()(const std::shared_ptr<const T>& shape) const {
    CheckShape(*shape);
  }
  void operator()(const Quadric& quadric) const { CheckShape(PreparedQuadric(quadric)); }
};

}  // namespace

void CheckShape(const Shape& shape) {
  std::visit(ShapeCheck{}, shape);
}

void CheckPlacement(const Affine& m) {
  if (!IsUsable(m.translation) || !IsUsable(m.linear[0]) || !IsUsable(m.linear[1]) || !IsUsable(m.linear[2]))
    throw Error("instance: the transform is not finite, or reaches farther than 1e18");
  // Embree inverts it in float, by its determinant.
  const float volume = glm::dot(m.linear[0], glm::cross(m.linear[1], m.linear[2]));
  if (!std::isnormal(volume))
    throw Error("instance: the transform is singular, or scales volumes by less than 1e-38 or more than 3e38");
}

float LargestThrough(const Affine& toObject) {
  float stretch = 1;
  for (int row = 0; row < 3; ++row) {
    const float sum =
        std::abs(toObject.linear[0][row]) + std::abs(toObject.linear[1][row]) + std::abs(toObject.linear[2][row]);
    const float most = 2 * sum + 2 * std::abs(toObject.translation[row]);
    if (!(most <= 1e15f)) throw Error("instance: the transform is singular, or scales by more than 1e15");
    stretch = std::max({stretch, 2 * sum, 2 * std::abs(toObject.translation[row])});
  }
  return kFarthest / stretch;
}

float CheckInstance(const GeometryInstance& instance) {
  if (!instance.motion) {
    CheckPlacement(instance.toRender);
    return LargestThrough(instance.toObject);
  }
  float largest = kFarthest;
  for (const Affine& key : instance.motion->Keys()) {
    CheckPlacement(key);
    largest = std::min(largest, LargestThrough(key.Inverse()));
  }
  return largest;
}

}  // namespace lampyr
