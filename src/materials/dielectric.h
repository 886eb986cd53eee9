// Dielectrics: reflection and refraction at a boundary, smooth (deltas) or rough by single scattering at
// Trowbridge-Reitz microfacets ([Walter07]); and a thin surface, which combines two parallel boundaries.
#pragma once

#include "materials/microfacet.h"
#include "materials/scattering.h"

namespace lampyr {

// Outside (z > 0) has index 1, inside η. With η = 1 all light is transmitted without deflection: a delta, whatever the
// roughness.
struct DielectricBsdf {
  TrowbridgeReitz microfacets;
  float eta = 1;

  BsdfEvaluation Evaluate(const Vector3& wo, const Vector3& wi, TransportMode mode) const;
  BsdfSample Sample(const Vector3& wo, float uLobe, const Point2& u, TransportMode mode) const;
  bool IsDelta() const { return eta == 1 || microfacets.IsSmooth(); }
  bool IsTransmissive() const { return true; }
};

// A dielectric whose index depends on the wavelength: one for each lane of a Color. A smooth one reflects all lanes
// alike, and refracts each in another direction, of which a path follows one. A rough one scatters all lanes, and
// samples by the mean of their densities ([Wilkie14]).
//
// The probability of a smooth reflection is the mean over the lanes, whichever lane is followed: it depends on the
// direction alone, so that camera and light subpaths agree on it.
struct DispersiveBsdf {
  TrowbridgeReitz microfacets;
  Color eta{1.0f};  // by lane, none 1 for a range of wavelengths
  int lane = 0;     // whose refraction is sampled

  BsdfEvaluation Evaluate(const Vector3& wo, const Vector3& wi, TransportMode mode) const;
  BsdfSample Sample(const Vector3& wo, float uLobe, const Point2& u, TransportMode mode) const;
  bool IsDelta() const { return microfacets.IsSmooth(); }
  bool IsTransmissive() const { return true; }
};

// Reflectance of a thin surface with parallel sides, summed over all orders of interreflection.
float ThinReflectance(float cosTheta, float eta);

// A thin surface. Transmitted light is not deflected, and is tinted by `transmittance`. isReflectionOnly: ray tracing
// already accounts for the transmission (SurfacePoint::isThin), and only the reflection remains.
struct ThinDielectricBsdf {
  float eta = 1;
  Color transmittance{1.0f};
  bool isReflectionOnly = false;

  BsdfEvaluation Evaluate(const Vector3&, const Vector3&, TransportMode) const { return {}; }
  BsdfSample Sample(const Vector3& wo, float uLobe, const Point2& u, TransportMode mode) const;
  bool IsDelta() const { return true; }
  bool IsTransmissive() const { return true; }
};

}  // namespace lampyr
