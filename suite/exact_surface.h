// The point of a light's surface, in double, that a sample or a photon stands for: by the shape's model, or by tracing
// the light's own surface.
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
  // Of an area light. `subject` must outlive this.
  explicit ExactSurface(const SuiteSubject& subject);

  // nullopt: there is none along the normal.
  std::optional<ExactPoint> At(const Point3& position, const Normal3& normal, int patch) const;
  const Enclosure& Around() const { return around_; }

  // Whether no other part of the surface hides a sample from P.
  bool Sees(const Point3& P, const LightSample& sample) const;
  // ∫ f dω over the directions in which P sees the surface; f is given what a ray finds there and its cosine. `hints`:
  // samples that go where much is.
  using Integrand = std::function<Integrands(const LightHit& hit, double cosine)>;
  std::pair<Estimate, Estimate> IntegrateDirections(const Point3& P, std::span<const LightSample> hints,
                                                    const Integrand& f, Rng& rng, int budget) const;
  // The same by random points of the surface, for strips that are too thin to be found among directions.
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
