// Where the suite places lights, and the shapes that it puts area lights on.
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

// The shape as a scene without instances holds it: already where the transform leads.
Shape Bake(const Shape& shape, const Transform& transform);

// The same map in double.
Transform ToTransform(const Affine& affine);

}  // namespace lampyr::suite
