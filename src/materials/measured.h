// Reflection measured by a gonio-photometer, in the adaptive parameterisation of [Dupuy18]: half vectors are warped by
// the distribution of visible normals, so that tables of 32 × 32 nodes resolve sharp highlights.
//
// The value is evaluated for the direction towards the camera as the direction of incidence of the measurement, in
// both transport modes, because measured tables are not exactly reciprocal. Both sides are alike.
#pragma once

#include <vector>

#include "materials/measured_table.h"
#include "materials/scattering.h"

namespace lampyr {

// The content of a file. Directions of incidence are given by φ, in [-π, π], and θ, in [0, π/2], ascending; half
// vectors by (√(2θ/π), (φ + π) / 2π).
struct MeasuredData {
  std::vector<float> phi, theta;
  bool isIsotropic = true;  // tables are given relative to the azimuth of incidence
  // Anisotropic materials may be measured for a part of the azimuths only. 1: all; 2: a half, the other follows by a
  // turn of 180°; 4: a quadrant, the others follow by mirroring. `partX`, `partY`: signs of x and y in that part.
  int symmetry = 1;
  float partX = 1, partY = 1;
  MeasuredTable<float> normals;    // density of microfacet normals, over half vectors
  MeasuredTable<float> projected;  // projected area of the microfacets, over directions of incidence
  MeasuredWarp visible;            // visible normals, for each direction of incidence
  MeasuredWarp luminance;          // of the reflection, over the square that `visible` warps to half vectors
  MeasuredTable<Color> reflectance;

  bool IsAnisotropic() const { return !isIsotropic; }
};

class Wavelengths;

struct MeasuredBsdf {
  const MeasuredData* data = nullptr;
  const Wavelengths* wavelengths = nullptr;  // at which values are evaluated; null: in Rec. 709

  BsdfEvaluation Evaluate(const Vector3& wo, const Vector3& wi, TransportMode mode) const;
  BsdfSample Sample(const Vector3& wo, float uLobe, const Point2& u, TransportMode mode) const;
  bool IsDelta() const { return false; }
  bool IsTransmissive() const { return false; }
};

}  // namespace lampyr
