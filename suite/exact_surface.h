// The exact surface point, in double, of a sample or a photon: from the shape's model, or by tracing the light's own
// surface.
#pragma once

#include <utility>

#include "suite/surface_tracer.h"

namespace lampyr::suite {

struct ExactPoint {
  Point3d position{0.0};
  Vector3d normal{0.0};
  Point2 uv{0.0f};
};

class ExactSurface {
 public:
  // `subject` must be an area light and outlive this object.
  explicit ExactSurface(const SuiteSubject& subject);

  // The surface point of a sample or photon at `position`; nullopt if there is none along the normal.
  std::optional<ExactPoint> At(const Point3& position, const Normal3& normal, int patch) const;
  const Enclosure& Around() const { return around_; }

  // True if no other part of the surface hides the sample from P.
  bool Sees(const Point3& P, const LightSample& sample) const;
  // ∫ f dω over the directions in which P sees the surface. f gets the hit of a ray and its cosine at the light.
  // `hints`: samples drawn where the integrand is large.
  using Integrand = std::function<Integrands(const LightHit& hit, double cosine)>;
  std::pair<Estimate, Estimate> IntegrateDirections(const Point3& P, std::span<const LightSample> hints,
                                                    const Integrand& f, Rng& rng, int budget) const;
  // Integral by random points on the traced surface, for strips too thin to be found among directions.
  Estimate IntegrateSurface(const Point3& P, const Integrand& f, Rng& rng) const;

 private:
  bool IsHidden(const Point3d& position, const Vector3d& normal, const Point3& P) const;
  std::pair<Estimate, Estimate> IntegrateModel(const Point3& P, std::span<const LightSample> hints, const Integrand& f,
                                               Rng& rng, int budget) const;
  std::pair<Estimate, Estimate> IntegrateTraced(const Point3& P, std::span<const LightSample> hints, const Integrand& f,
                                                Rng& rng, int budget) const;

  const EmitterModel* model_;
  std::optional<SurfaceTracer> tracer_;
  Enclosure around_;
};

}  // namespace lampyr::suite
