// Metal, smooth (a delta) or rough by single scattering at Trowbridge-Reitz microfacets ([Walter07]). Both sides are
// alike.
#pragma once

#include "materials/microfacet.h"
#include "materials/scattering.h"

namespace lampyr {

struct ConductorBsdf {
  TrowbridgeReitz microfacets;
  Color eta, k;  // complex index of refraction, relative to the outside

  BsdfEvaluation Evaluate(const Vector3& wo, const Vector3& wi, TransportMode mode) const;
  BsdfSample Sample(const Vector3& wo, float uLobe, const Point2& u, TransportMode mode) const;
  bool IsDelta() const { return microfacets.IsSmooth(); }
  bool IsTransmissive() const { return false; }
};

}  // namespace lampyr
