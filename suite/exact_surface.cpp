#include "suite/exact_surface.h"

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

// True if a closed convex shape hides its own point from P.
bool ExactSurface::IsHidden(const Point3d& position, const Vector3d& normal, const Point3& P) const {
  if (!model_->IsClosedConvex()) return false;
  const double outward = glm::dot(normal, position - around_.middle) > 0 ? 1 : -1;
  const bool isInside = glm::length(Point3d(P) - around_.middle) < 0.2 * around_.radius;
  return !isInside && outward * glm::dot(normal, Point3d(P) - position) <= 0;
}

bool ExactSurface::Sees(const Point3& P, const LightSample& sample) const {
  if (model_) return !IsHidden(Point3d(sample.position), Vector3d(sample.normal), P);
  const Vector3d way = Point3d(sample.position) - Point3d(P);
  const double distance = glm::length(way);
  const auto first = tracer_->Trace(Point3d(P), way / distance);
  return !first || first->distance > distance - 1e-2 * around_.radius;
}

std::pair<Estimate, Estimate> ExactSurface::IntegrateDirections(const Point3& P, std::span<const LightSample> hints,
                                                                const Integrand& f, Rng& rng, int budget) const {
  return model_ ? IntegrateModel(P, hints, f, rng, budget) : IntegrateTraced(P, hints, f, rng, budget);
}

// Integrates over the parameters of each patch.
std::pair<Estimate, Estimate> ExactSurface::IntegrateModel(const Point3& P, std::span<const LightSample> hints,
                                                           const Integrand& f, Rng& rng, int budget) const {
  std::pair<Estimate, Estimate> sum;
  for (int patch = 0; patch < model_->PatchCount(); ++patch) {
    if (!(model_->At(patch, 0.4, 0.55).area > 0)) continue;
    std::vector<Point2d> where;
    for (const LightSample& hint : hints) {
      if (hint.patchIndex == patch) where.push_back(model_->Invert(patch, Point3d(hint.position)));
    }
    const AdaptiveSquare square(
        1, where,
        [&](double u, double v) -> Integrands {
          const EmitterModel::SurfaceElement element = model_->At(patch, u, v);
          const Vector3d way = element.position - Point3d(P);
          const double squared = glm::dot(way, way);
          const double cosine = -glm::dot(way, element.normal) / std::sqrt(squared);
          if (!(element.area > 0) || IsHidden(element.position, element.normal, P)) return {};
          const Integrands value = f(model_->HitFrom(patch, element, P), cosine);
          const double solidAngle = std::abs(cosine) / squared * element.area;
          return {value.density * solidAngle, value.radiance * solidAngle};
        },
        rng, budget);
    sum.first = sum.first + square.Density();
    sum.second = sum.second + square.Radiance();
  }
  return sum;
}

std::pair<Estimate, Estimate> ExactSurface::IntegrateTraced(const Point3& P, std::span<const LightSample> hints,
                                                            const Integrand& f, Rng& rng, int budget) const {
  std::vector<Vector3d> where;
  for (const LightSample& hint : hints) where.push_back(glm::normalize(Vector3d(hint.direction)));
  const DirectionQuadrature quadrature(
      CapTowards(around_, P), where,
      [&](const Vector3d& direction) -> Integrands {
        const auto found = tracer_->Trace(Point3d(P), direction);
        return found ? f(HitFrom(*found, direction), -glm::dot(found->normal, direction)) : Integrands{};
      },
      rng, budget);
  return {quadrature.Density(), quadrature.Radiance()};
}

Estimate ExactSurface::IntegrateSurface(const Point3& P, const Integrand& f, Rng& rng) const {
  return tracer_->IntegrateOver(
      1, [](const SurfaceHit&) { return 0; },
      [&](const SurfaceHit& hit) {
        const Vector3d way = hit.position - Point3d(P);
        const double squared = glm::dot(way, way), distance = std::sqrt(squared);
        const Vector3d direction = way / distance;
        const double cosine = -glm::dot(hit.normal, direction);
        SurfaceHit found = hit;
        found.distance = distance;
        const double value = f(HitFrom(found, direction), cosine).density;
        if (value == 0) return 0.0;
        const auto first = tracer_->Trace(Point3d(P), direction);
        const bool isHidden = first && first->distance <= distance - 1e-2 * around_.radius;
        return isHidden ? 0.0 : value * std::abs(cosine) / squared;
      },
      rng)[0];
}

}  // namespace lampyr::suite
