// The scattering of light at a surface point: value, densities in both directions and the diffuse/specular split, in
// one call. Which models there are is behind this door: a Bsdf is a small value on the stack, no allocation, no virtual
// call.
//
// Conventions ([Veach97 §5.3], light-transport conventions of this project)
// - wo and wi are unit vectors in render space, both pointing away from the surface.
// - wo is where the path came from, wi where it goes on; for TransportMode::Radiance wo points towards the camera.
// - f is the BSDF value (1/sr) without the cosine. Refraction scales radiance by 1/η² (Radiance), not importance.
// - Densities are in solid angle; pdfReverse is the density of sampling wo when coming from wi,
//   by a path of the other mode.
// - Delta lobes have value and density 0 in Evaluate; Sample says so with isDelta.
// - Everything happens in the shading frame: a direction's side is its side of Ns, as in pbrt-v4. Ng is kept for the
//   adjoint correction, which is the integrator's.
#pragma once

#include <optional>
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

  // f and both densities. Zero for deltas.
  BsdfEvaluation Evaluate(const Vector3& wo, const Vector3& wi, TransportMode mode) const;

  // uLobe chooses a lobe, u a direction; both in [0,1). nullopt: absorbed.
  std::optional<BsdfSample> Sample(const Vector3& wo, float uLobe, const Point2& u, TransportMode mode) const;

  // Only delta lobes (or none at all): light sampling cannot find anything.
  bool IsDelta() const;
  // Light may come from the other side: light selection looks at both.
  bool IsTransmissive() const;

  // The cosine that f is multiplied by in the scattering integral: |w·Ns|; of a fibre, that of the angle to the plane
  // across it.
  float ScatteringCosine(const Vector3& w) const {
    return IsFibre() ? std::get_if<HairBsdf>(&model_)->ScatteringCosine(frame_.ToLocal(w)) : AbsDot(w, frame_.z);
  }
  // The cosine by which area is seen from w: |w·Ng|; of a fibre, which faces every direction, as above.
  float GeometricCosine(const Vector3& w) const { return IsFibre() ? ScatteringCosine(w) : AbsDot(w, Ng_); }
  // A fibre is narrower than what can be told apart: light that meets it anywhere leaves it from there, whatever side
  // it leaves to.
  bool IsFibre() const {
    const auto* hair = std::get_if<HairBsdf>(&model_);
    return hair && hair->isFibre;
  }

  // False for hair: a fibre has no area within the radius that photons could be counted over, and on a surface, where
  // hair scatters grazing light as much as any, a photon would have the weight 1 / cosθ, of unbounded variance.
  bool GathersPhotons() const { return !std::holds_alternative<HairBsdf>(model_); }

  const Frame& ShadingFrame() const { return frame_; }
  const Normal3& Ng() const { return Ng_; }

 private:
  Frame frame_{};
  Normal3 Ng_{0, 0, 1};
  BsdfModel model_;
};

}  // namespace lampyr
