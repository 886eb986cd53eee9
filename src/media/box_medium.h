// A medium in a box of its own space, empty outside. Internal to media/.
#pragma once

#include <string>

#include "media/medium.h"

namespace lampyr {

class BoxMedium : public Medium {
 public:
  MediumCoefficients At(const Point3& position) const final {
    const Point3 p = toSpace_.Point(position);
    const Bounds3& box = majorants_.Bounds();
    for (int axis = 0; axis < 3; ++axis) {
      if (!(p[axis] >= box.min[axis] && p[axis] <= box.max[axis])) return {};
    }
    return AtInside(p);
  }
  const MajorantGrid* Majorants() const final { return &majorants_; }
  std::vector<Point3> Corners() const final {
    const Affine toRender = toSpace_.Inverse();
    const Bounds3& box = majorants_.Bounds();
    std::vector<Point3> corners;
    for (int i = 0; i < 8; ++i) {
      corners.push_back(toRender.Point(
          {i & 1 ? box.max.x : box.min.x, i & 2 ? box.max.y : box.min.y, i & 4 ? box.max.z : box.min.z}));
    }
    return corners;
  }
  // From render space to the space of the box.
  const Affine& ToSpace() const { return toSpace_; }

 protected:
  // The box is that of `majorants`, and `toSpace` leads from render space to the box's.
  BoxMedium(const std::string& name, float asymmetry, bool isEmissive, const Affine& toSpace, MajorantGrid majorants)
      : Medium(name, asymmetry, isEmissive), toSpace_(toSpace), majorants_(std::move(majorants)) {}

  // At a point of the box, given in the box's space.
  virtual MediumCoefficients AtInside(const Point3& p) const = 0;

 private:
  Affine toSpace_;
  MajorantGrid majorants_;
};

}  // namespace lampyr
