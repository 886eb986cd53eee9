// The point of a light's surface, in double, that a sample or a photon stands for: by the shape's model, or by tracing
// the light's own surface.
#pragma once

#include "lights/suite/surface_tracer.h"

namespace lampyr::suite {

struct ExactPoint {
  Point3d position{0.0};
  Vector3d normal{0.0};
  Point2 uv{0.0f};
};

class ExactSurface {
 public:
  // Of an area light. `subject` must outlive this.
  explicit ExactSurface(const SuiteSubject& subject);

  // nullopt: there is none along the normal.
  std::optional<ExactPoint> At(const Point3& position, const Normal3& normal, int patch) const;
  const Enclosure& Around() const { return around_; }

 private:
  const EmitterModel* model_;
  std::optional<SurfaceTracer> tracer_;
  Enclosure around_;
};

}  // namespace lampyr::suite
