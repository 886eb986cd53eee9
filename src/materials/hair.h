// Hair and fur: a rough dielectric cylinder that absorbs inside, by the model of [Chiang16] ([Pharr23 §9.9]; the lobes
// are those of [Marschner03], the longitudinal one is that of [dEon11]).
//
// Local frame: x along the fibre, z the shading normal. θ is the angle to the plane across the fibre, φ the azimuth
// around it from y towards z, h = sinγ the offset of a path from the middle of the fibre, in radii. Light that arrives
// from wi leaves to wo, the camera's side, by four lobes: reflected (R), through both walls (TT), reflected once inside
// (TRT), and all the rest:
//   S(wo,wi) = Σ_p M_p(θo,θi) A_p(θo,h) N_p(φi - φo)
// M_p and N_p are densities in sinθ and in φ, so that ∫ S dωi = Σ A_p, which is 1 where nothing absorbs. Scattered
// radiance is ∫ L S dωi, without a cosine of the surface: f = S / C(wi), for the cosine C that integrators multiply by.
//
// The scales of the cuticle tilt the lobes, and h is the offset as the camera's side sees it; so S is not symmetric.
// f for importance is the exact adjoint, f(wi,wo). Seen from the light's side, by time reversal, a path's offset is -h:
// light paths are sampled by that. All lobes count as specular.
#pragma once

#include <optional>

#include "materials/scattering.h"

namespace lampyr {

struct HairBsdf {
  static constexpr int kLobes = 4;            // R, TT, TRT, the rest
  static constexpr float kLeastBeta = 0.01f;  // as in pbrt-v4: what is smoother counts as this rough

  // What a path from one direction meets (hair.cpp).
  struct Lobes;

  // sigmaA: absorption over the fibre's radius, not negative. η of the fibre over that of the air, > 0. Roughnesses
  // along and around the fibre are held within [kLeastBeta, 1]. alpha: tilt of the scales, degrees.
  HairBsdf(const Color& sigmaA, float eta, float betaM, float betaN, float alpha);

  BsdfEvaluation Evaluate(const Vector3& wo, const Vector3& wi, TransportMode mode) const;
  std::optional<BsdfSample> Sample(const Vector3& wo, float uLobe, const Point2& u, TransportMode mode) const;
  bool IsDelta() const { return false; }
  bool IsTransmissive() const { return true; }
  // C(w), positive.
  float ScatteringCosine(const Vector3& w) const;

  // Offset h in [-1,1]: positive, the fibre's wall leans from z towards y.
  float offset = 0;
  // The offset is what the arriving path sees; otherwise it is a property of the point, that of camera paths.
  bool followsRay = false;
  // A fibre without a surface of its own: it faces whoever looks. C is then the cosine of θ; otherwise that to z.
  bool isFibre = false;

 private:
  Lobes LobesFrom(const Vector3& w, float h) const;
  BsdfEvaluation Scatter(const Vector3& wo, const Vector3& wi, const Lobes& fromWo, TransportMode mode) const;
  // Offset as seen from wo's end of a path.
  float OffsetFrom(TransportMode mode) const {
    return mode == TransportMode::Importance && !followsRay ? -offset : offset;
  }

  struct Longitudinal {
    float variance = 1, norm = 0;  // v, 1 / (v (1 - exp(-2/v)))
    float Density(float sinO, float cosO, float sinI, float cosI) const;
  };

  Color sigmaA_;
  float eta_;
  Longitudinal along_[3];    // R, TT, TRT and the rest
  float scale_, scaleNorm_;  // of the logistic: s, 1 / (s tanh(π/(2s)))
  Vector2 tilt_[3];          // cosine and sine of the angle by which the lobe of R, TT, TRT is tilted
};

// exp(-x) I0(x), the modified Bessel function of the first kind without its growth; x ≥ 0, to 1e-6.
float ScaledBesselI0(float x);

// The absorption of fibres that has `reflectance`, in [0,1], as the colour of a dense block of them ([Chiang16 §4.2]).
Color HairAbsorption(const Color& reflectance, float betaN);
// The absorption of given concentrations of the pigments eumelanin and pheomelanin ([dEon11 §6.1]), not negative.
Color HairAbsorption(float eumelanin, float pheomelanin);

}  // namespace lampyr
