#include "lights/suite/exact_surface.h"

namespace lampyr::suite {

ExactSurface::ExactSurface(const SuiteSubject& subject) : model_(subject.model) {
  if (model_) {
    const EmitterModel::Extent extent = model_->Measure();
    around_ = {extent.middle, extent.radius};
  } else {
    tracer_.emplace(*subject.light->Surface(), *subject.context.transform);
    around_ = tracer_->Around();
  }
}

std::optional<ExactPoint> ExactSurface::At(const Point3& position, const Normal3& normal, int patch) const {
  if (model_) {
    if (patch < 0 || patch >= model_->PatchCount()) return std::nullopt;
    const Point2d p = model_->Invert(patch, Point3d(position));
    const EmitterModel::SurfaceElement element = model_->At(patch, p.x, p.y);
    return ExactPoint{element.position, element.normal, element.uv};
  }
  const Vector3d n = glm::normalize(Vector3d(normal));
  const auto found = tracer_->Find(Point3d(position) + n * (0.1 * around_.radius), -n, Point3d(position));
  if (!found) return std::nullopt;
  return ExactPoint{found->hit.position, found->hit.normal, found->hit.uv};
}

}  // namespace lampyr::suite
