// The shapes that can be traced, as plain data in render space (triangle meshes) or in their own space (the rest).
#pragma once

#include <array>
#include <memory>
#include <variant>
#include <vector>

#include "geometry/custom_surface.h"
#include "math/bounds.h"
#include "math/transform.h"
#include "math/vec.h"

namespace lampyr {

// Triangles in render space. `normals` and `uvs` are per vertex, or empty.
struct TriangleMesh {
  std::vector<Point3> positions;
  std::vector<std::array<uint32_t, 3>> triangles;
  std::vector<Normal3> normals;  // unit, already flipped by ReverseOrientation; they decide which side is outside
  std::vector<Point2> uvs;
  bool flipNormals = false;  // ReverseOrientation xor a mirroring transform: turns the normal of the winding

  // Corners of triangle `i`.
  std::array<Point3, 3> Corners(uint32_t i) const {
    const auto& t = triangles[i];
    return {positions[t[0]], positions[t[1]], positions[t[2]]};
  }
};

// Bilinear patches in render space: p(u,v) from corners p00 p10 p01 p11.
struct BilinearMesh {
  std::vector<Point3> positions;
  std::vector<std::array<uint32_t, 4>> patches;  // p00, p10, p01, p11
  std::vector<Normal3> normals;
  std::vector<Point2> uvs;
  bool flipNormals = false;
};

// A sphere, disk or cylinder in its own space, as pbrt-v4 defines them, partial ones included.
struct Quadric {
  enum class Kind { Sphere, Disk, Cylinder };
  Kind kind = Kind::Sphere;
  float radius = 1;
  float zMin = -1, zMax = 1;  // sphere (within [-radius, radius]) and cylinder; the disk's height is zMin
  float innerRadius = 0;      // disk
  float phiMax = 2 * kPi;     // radians, (0, 2π]
  Affine toRender;            // object to render space
  Affine toObject;
  bool flipNormals = false;

  bool IsFullSphere() const { return kind == Kind::Sphere && zMin <= -radius && zMax >= radius && phiMax >= 2 * kPi; }
};

// Cubic Bézier curves in render space, with a width at either end.
struct CurveSet {
  enum class Kind { Flat, Cylinder, Ribbon };
  static constexpr int kLinesPerFlatSegment = 16;  // straight lines, Embree's maximum
  Kind kind = Kind::Flat;
  std::vector<std::array<Point3, 4>> segments;
  std::vector<std::array<float, 4>> radii;             // half widths at the control points, render space
  std::vector<std::array<Normal3, 2>> segmentNormals;  // ribbons only: normal at either end
  std::vector<std::array<float, 2>> uRange;            // the part of u, in [0,1], that the segment covers
};

using Shape = std::variant<std::shared_ptr<const TriangleMesh>, std::shared_ptr<const BilinearMesh>, Quadric,
                           std::shared_ptr<const CurveSet>, std::shared_ptr<const CustomSurface>>;

// Bounds in render space; for a moving shape, over the whole shutter.
Bounds3 GetBounds(const Shape& shape);

// Surface area in render space, exact for triangle meshes, by quadrature (relative error < 1e-5) for the rest under
// a transform that is not a similarity. 0 for a CustomSurface, of which only the intersection is known.
double GetArea(const Shape& shape);

}  // namespace lampyr
