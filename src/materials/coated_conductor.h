// A metal under a dielectric coat, after pbrt-v4's "coatedconductor", which walks at random between the two. Here:
//   f(wo,wi) = f_coat(wo,wi) + T(wo) T(wi) f_base(wo',wi') S / η²
// with wo', wi' refracted into the coat (the mean surface), T from materials/coat_table.h and S the sum over bounces at the
// base ([Weidlich07] with energy-preserving transmittances instead of their absorbing ones).
// - Both smooth: one delta whose weight is the exact sum.
// - Smooth coat, rough base: the first bounce is exact. Later ones keep the shape of the first: S = 1 + FQ + (FQ)² + …, with
//   F the metal's reflectance and Q the part that returns from the boundary.
// - Rough coat: the base's lobe is widened by what the two refractions scatter: α² = α_base² + 2 (α_coat (1 - 1/η)/2)².
// Approximate in the last two; directional albedo against the random walk: the tests hold the table of differences.
// Deterministic, reciprocal, exact densities. All of it counts as specular.
#pragma once

#include <optional>

#include "materials/coat_lobe.h"
#include "materials/coat_table.h"
#include "materials/microfacet.h"
#include "materials/scattering.h"

namespace lampyr {

// What does not vary over the surface.
struct CoatedConductorSettings {
  float eta = 1.5f;
  float thickness = 0.01f;
  int bounces = 5;
  const CoatTable* coat = nullptr;          // must outlive the BSDF
  const CoatReturnTable* returned = nullptr;
};

class CoatedConductorBsdf {
 public:
  // `eta` and `k` of the metal relative to the coat.
  CoatedConductorBsdf(const TrowbridgeReitz& coat, const TrowbridgeReitz& base, const Color& eta, const Color& k,
                      const CoatedConductorSettings& settings);

  BsdfEvaluation Evaluate(const Vector3& wo, const Vector3& wi, TransportMode mode) const;
  std::optional<BsdfSample> Sample(const Vector3& wo, float uLobe, const Point2& u, TransportMode mode) const;
  bool IsDelta() const { return base_.IsSmooth(); }  // only when both are
  bool IsTransmissive() const { return false; }
  Color ApproximateAlbedo() const;

 private:
  struct Base {
    Color f;
    float pdfForward = 0, pdfReverse = 0;
  };
  bool CoatIsDelta() const { return settings_->eta == 1 || coat_.IsSmooth(); }
  float CoatProbability(float cosO) const;
  Base EvaluateBase(const Vector3& wo, const Vector3& wi) const;
  std::optional<Vector3> SampleBase(const Vector3& wo, const Point2& u) const;
  BsdfEvaluation EvaluateUpper(const Vector3& wo, const Vector3& wi) const;
  BsdfSample SampleMirror(const Vector3& wo) const;

  TrowbridgeReitz coat_, base_;  // base_ is widened
  Color eta_, k_;
  CoatTable::Slice coatSlice_, baseSlice_;
  const CoatedConductorSettings* settings_;
};

}  // namespace lampyr
