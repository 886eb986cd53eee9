// Hair and fur: a rough dielectric cylinder that absorbs inside, by the model of [Chiang16] ([Pharr23 §9.9]; the lobes
// are those of [Marschner03], the longitudinal one is that of [dEon11]).
//
// Local frame: x along the fibre, z the shading normal. θ is the angle to the plane across the fibre, φ the azimuth
// around it from y towards z, h = sinγ the offset of a path from the centre of the fibre, in radii. Light that arrives
// from wi leaves to wo, the side of the camera, by four lobes: reflection (R), transmission through both walls (TT),
// one internal reflection (TRT), and all the rest:
//   S(wo,wi) = Σ_p M_p(θo,θi) A_p(θo,h) N_p(φi - φo)
// M_p and N_p are densities in sinθ and in φ, so that ∫ S dωi = Σ A_p, which is 1 without absorption. Scattered
// radiance is ∫ L S dωi, without a surface cosine: f = S / C(wi), with C the cosine that integrators multiply by.
//
// S is not symmetric: the scales of the cuticle tilt the lobes, and h is the offset seen from the side of the camera. f
// for importance is the exact adjoint, f(wi,wo). Seen from the side of the light, by time reversal, the offset of a
// path is -h, by which light paths are sampled. All lobes count as specular.
#pragma once

#include "materials/scattering.h"

namespace lampyr {

struct HairBsdf {
  static constexpr int kLobes = 4;            // R, TT, TRT, the rest
  static constexpr float kLeastBeta = 0.01f;  // lower bound of the roughnesses, as in pbrt-v4

  // The lobes as seen by a path from one direction (hair.cpp).
  struct Lobes;

  // sigmaA: absorption coefficient times the radius of the fibre, not negative. eta: index of the fibre over that of
  // the air, positive. betaM, betaN: roughnesses along and around the fibre, clamped to [kLeastBeta, 1]. alpha: tilt of
  // the scales, degrees.
  HairBsdf(const Color& sigmaA, float eta, float betaM, float betaN, float alpha);

  BsdfEvaluation Evaluate(const Vector3& wo, const Vector3& wi, TransportMode mode) const;
  BsdfSample Sample(const Vector3& wo, float uLobe, const Point2& u, TransportMode mode) const;
  bool IsDelta() const { return false; }
  bool IsTransmissive() const { return true; }
  // C(w), positive.
  float ScatteringCosine(const Vector3& w) const;

  // Offset h in [-1,1]. If it is positive, the normal of the fibre's wall leans from z towards y.
  float offset = 0;
  // True if `offset` is seen by the arriving path, of either mode; false if it is a property of the point, as seen by
  // camera paths.
  bool followsRay = false;
  // True for a fibre without a surface of its own, which faces every direction: C is then cosθ, otherwise the cosine to
  // z.
  bool isFibre = false;

 private:
  Lobes LobesFrom(const Vector3& w, float h) const;
  BsdfEvaluation Scatter(const Vector3& wo, const Vector3& wi, const Lobes& fromWo, TransportMode mode) const;
  // Offset as seen from the end of a path at wo.
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
  float scale_, scaleNorm_;  // logistic: s, 1 / (s tanh(π/(2s)))
  Vector2 tilt_[3];          // cosine and sine of the tilt of R, TT, TRT
};

// exp(-x) I0(x), the exponentially scaled modified Bessel function of the first kind; x ≥ 0, to 1e-6.
float ScaledBesselI0(float x);

// The absorption for which a dense block of fibres has the colour `reflectance`, in [0,1] ([Chiang16 §4.2]).
Color HairAbsorption(const Color& reflectance, float betaN);
// The absorption for concentrations (>= 0) of the pigments eumelanin and pheomelanin ([dEon11 §6.1]).
Color HairAbsorption(float eumelanin, float pheomelanin);

}  // namespace lampyr
