// Scattering at a surface point or within a medium: value, densities in both directions and the split into diffuse and
// specular, in one call. A Bsdf is a small value on the stack that hides the scattering model, without allocation or
// virtual calls.
//
// Conventions ([Veach97 §5.3])
// - wo and wi are unit vectors in render space, both pointing away from the surface.
// - wo is the direction that the path came from, wi the one in which it continues; for TransportMode::Radiance, wo
//   points towards the camera.
// - f is the BSDF (1/sr) without the cosine. Refraction scales radiance by 1/η² (Radiance), but not importance.
// - Densities are in solid angle; pdfReverse is the density of sampling wo when coming from wi, by a path of the other
//   mode.
// - Delta lobes have value and density 0 in Evaluate; Sample marks them by isDelta.
// - Everything is in the shading frame: as in pbrt-v4, the side of a direction is that of Ns. Ng is kept for the
//   adjoint correction, which integrators apply.
#pragma once

#include <variant>

#include "materials/bsdf_models.h"
#include "materials/scattering.h"
#include "math/frame.h"

namespace lampyr {

class Bsdf {
 public:
  Bsdf() = default;  // absorbs everything
  Bsdf(const Frame& shadingFrame, const Normal3& Ng, const BsdfModel& model)
      : frame_(shadingFrame), Ng_(Ng), model_(model) {}

  // f and both densities; 0 for delta lobes. Inline for the most common model, which is short: returning the result
  // from a call would double the time.
  BsdfEvaluation Evaluate(const Vector3& wo, const Vector3& wi, TransportMode mode) const {
    const auto* diffuse = std::get_if<DiffuseBsdf>(&model_);
    if (!diffuse) return EvaluateInFrame(wo, wi, mode);
    // The diffuse model needs no tangents.
    return diffuse->Evaluate({0, 0, glm::dot(wo, frame_.z)}, {0, 0, glm::dot(wi, frame_.z)}, mode);
  }

  // Samples wi: `uLobe` chooses a lobe, `u` a direction; both in [0,1). False: absorbed.
  BsdfSample Sample(const Vector3& wo, float uLobe, const Point2& u, TransportMode mode) const;

  // True if all lobes are delta lobes (or there are none): next-event estimation contributes nothing.
  bool IsDelta() const;
  // True if light from the other side may contribute; light selection then considers both sides.
  bool IsTransmissive() const;
  // True if it scatters over much of the sphere, so that a learned density of directions is useful.
  bool IsWide() const;

  // Cosine of the scattering integral: |w·Ns|; for a fibre, the cosine of the angle to the plane across it; 1 in a
  // medium.
  float ScatteringCosine(const Vector3& w) const { return MayHaveOwnCosines() ? OwnCosine(w) : AbsDot(w, frame_.z); }
  // Cosine of the geometry term: |w·Ng|; for a fibre, which faces every direction, and in a medium, ScatteringCosine.
  float GeometricCosine(const Vector3& w) const {
    return MayHaveOwnCosines() && (IsFibre() || IsMedium()) ? OwnCosine(w) : AbsDot(w, Ng_);
  }
  // Sets the lane whose refraction a smooth dispersive dielectric samples. No effect on other models.
  void SetLane(int lane) {
    if (auto* dispersive = std::get_if<DispersiveBsdf>(&model_)) dispersive->lane = lane;
  }
  bool IsDispersive() const { return std::holds_alternative<DispersiveBsdf>(model_); }
  // The phase function of a medium; null on a surface.
  const PhaseBsdf* Phase() const { return std::get_if<PhaseBsdf>(&model_); }
  // True for a point within a medium: there is no surface, f is σ_s (or the albedo) times the phase function, all of it
  // `diffuse`, and the frame has no meaning.
  bool IsMedium() const { return std::holds_alternative<PhaseBsdf>(model_); }
  // True for a fibre, which is too narrow to be resolved: light that enters anywhere leaves at the same point, to any
  // side.
  bool IsFibre() const {
    const auto* hair = std::get_if<HairBsdf>(&model_);
    return hair && hair->isFibre;
  }

  // False for hair: a fibre has no area within the radius over which photons are counted; and on a surface, where hair
  // scatters grazing light as much as any, a photon would have the weight 1 / cosθ, of unbounded variance. False in a
  // medium, because these are photons of surfaces.
  bool GathersPhotons() const { return !MayHaveOwnCosines(); }

  const Frame& ShadingFrame() const { return frame_; }
  const Normal3& Ng() const { return Ng_; }

 private:
  bool MayHaveOwnCosines() const { return model_.index() >= kFirstWithOwnCosines; }
  float OwnCosine(const Vector3& w) const;
  BsdfEvaluation EvaluateInFrame(const Vector3& wo, const Vector3& wi, TransportMode mode) const;
  BsdfSample SampleLocal(const Vector3& wo, float uLobe, const Point2& u, TransportMode mode) const;

  Frame frame_{};
  Normal3 Ng_{0, 0, 1};
  BsdfModel model_;
};

}  // namespace lampyr
