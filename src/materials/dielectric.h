// Glass and the like: reflection and refraction at a boundary, smooth (deltas) or rough by single scattering at
// Trowbridge-Reitz microfacets ([Walter07]); and a thin sheet, whose two boundaries are one.
#pragma once

#include <optional>

#include "materials/microfacet.h"
#include "materials/scattering.h"

namespace lampyr {

// Outside (z > 0) has index 1, inside η. η = 1 lets everything through without a deflection: a delta, whatever the
// roughness.
struct DielectricBsdf {
  TrowbridgeReitz microfacets;
  float eta = 1;

  BsdfEvaluation Evaluate(const Vector3& wo, const Vector3& wi, TransportMode mode) const;
  std::optional<BsdfSample> Sample(const Vector3& wo, float uLobe, const Point2& u, TransportMode mode) const;
  bool IsDelta() const { return eta == 1 || microfacets.IsSmooth(); }
  bool IsTransmissive() const { return true; }
};

// The part of light that a sheet with parallel sides reflects: all orders of reflection between the two are summed.
float ThinReflectance(float cosTheta, float eta);

// Such a sheet. Light leaves undeflected, coloured by `transmittance`; unless the tracing of rays has seen to that
// already (SurfacePoint::isThin): then there is only the reflection left.
struct ThinDielectricBsdf {
  float eta = 1;
  Color transmittance{1.0f};
  bool isReflectionOnly = false;

  BsdfEvaluation Evaluate(const Vector3&, const Vector3&, TransportMode) const { return {}; }
  std::optional<BsdfSample> Sample(const Vector3& wo, float uLobe, const Point2& u, TransportMode mode) const;
  bool IsDelta() const { return true; }
  bool IsTransmissive() const { return true; }
};

}  // namespace lampyr
