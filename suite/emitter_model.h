// Reference model of a shape's surface: parametrised, in double, sharing no code with the lights. The suite integrates
// the lights' densities over it and bins their samples into its cells.
#pragma once

#include <memory>

#include "geometry/shapes.h"
#include "lights/light.h"

namespace lampyr {

class EmitterModel {
 public:
  struct SurfaceElement {
    Point3d position{0.0};
    Vector3d normal{0.0};  // unit, outer side
    Point2 uv{0.0f};
    double area = 0;  // dA / (du dv), u and v the model's parameters
  };

  virtual ~EmitterModel() = default;
  virtual int PatchCount() const = 0;
  // Parameters in (0,1)².
  virtual SurfaceElement At(int patch, double u, double v) const = 0;
  // The parameters of a point on the patch.
  virtual Point2d Invert(int patch, const Point3d& position) const = 0;
  // True for a closed convex surface, which hides its far side from receivers outside of it.
  virtual bool IsClosedConvex() const { return false; }

  // Bounding sphere and area of the surface, estimated by sampling the parameters.
  struct Extent {
    Point3d middle{0.0};
    double radius = 0, area = 0;
  };
  Extent Measure() const;

  LightHit HitFrom(int patch, const SurfaceElement& element, const Point3& P) const;
};

// The model of `shape`, placed by `placement` (identity where the shape lies in render space already).
std::unique_ptr<EmitterModel> MakeEmitterModel(const Shape& shape, const Transform& placement);

}  // namespace lampyr
