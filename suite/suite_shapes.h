// Placements of lights in the suite, and the shapes of its area lights.
#pragma once

#include <string>
#include <vector>

#include "geometry/shapes.h"
#include "math/transform.h"

namespace lampyr::suite {

struct NamedTransform {
  std::string name;
  Transform transform;
  bool keepsAngles = true;  // a rotation, mirror or uniform scale
};
std::vector<NamedTransform> Transforms();

struct NamedShape {
  std::string name;
  Shape shape;
};
std::vector<NamedShape> Shapes();

// The shape with `transform` baked in, as a scene without instances holds it.
Shape Bake(const Shape& shape, const Transform& transform);

// `affine` in double.
Transform ToTransform(const Affine& affine);

}  // namespace lampyr::suite
