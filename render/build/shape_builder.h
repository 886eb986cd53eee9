// Shapes as scene files describe them: read into their own space (double), then placed into render space.
//
// Two steps, because the choice of render space depends on the bounds of all shapes.
#pragma once

#include <optional>
#include <variant>
#include <vector>

#include "base/memory.h"
#include "geometry/curves.h"
#include "geometry/shapes.h"
#include "math/transform.h"
#include "scene/scene_description.h"

namespace lampyr {

// Triangles and bilinear patches in the shape's own space.
struct LocalMesh {
  std::vector<Point3d> positions;
  std::vector<std::array<uint32_t, 3>> triangles;
  std::vector<std::array<uint32_t, 4>> patches;
  std::vector<Vector3d> normals;
  std::vector<Point2> uvs;
};

struct LocalShape {
  std::variant<LocalMesh, Quadric, CurveParameters> shape;  // quadrics and curves: transforms not set
  const ShapeDescription* description = nullptr;
};

// Reads the parameters and files of a shape. Throws located Errors, also where its triangles take more than is left of
// `memory`; nullopt (with a warning) when it is empty or of a kind that is not supported.
std::optional<LocalShape> ReadShape(const ShapeDescription& description, MemoryBudget& memory,
                                    Diagnostics& diagnostics);

// Bounds under `toWorld`.
Bounds3d GetBounds(const LocalShape& shape, const Transform& toWorld);

// The shape in render space: one shape, or two when a mesh has both triangles and patches. Throws an Error when the
// transform cannot place it or coordinates leave the range of floats, and where the segments that a curve is divided
// into take more than is left of `memory`.
std::vector<Shape> PlaceShape(const LocalShape& shape, const Transform& toRender, MemoryBudget& memory);

}  // namespace lampyr
