// Shading normals make the scattering of importance another one than that of radiance ([Veach97 §5.3]).
//
// Radiance at a surface is f · |wl·Ns| times what arrives from wl, wl towards the light, wherever the camera looks
// from. The same number, read from the light's side: flux arrives in proportion to |wl·Ng| and leaves towards wc in
// proportion to |wc·Ng|, so what arrives is scattered by f · |wl·Ns| |wc·Ng| / |wl·Ng|.
#pragma once

#include <algorithm>
#include <cmath>

#include "materials/bsdf.h"

namespace lampyr {

// A grazing cosine is known to rounding only, and a light path that arrives at one weighs 1/cosine: both end here. What
// is lost is the light from within this of the geometric horizon, less than 1e-5 of what a surface receives.
inline constexpr float kSmallestGeometricCosine = 1e-5f;

// |wl·Ns| / |wl·Ng|: what light that arrives from `toLight` weighs.
inline float ArrivalCorrection(const Bsdf& bsdf, const Vector3& toLight) {
  const Normal3 Ns = bsdf.ShadingFrame().z;
  if (Ns == bsdf.Ng()) return 1;
  return AbsDot(toLight, Ns) / std::max(AbsDot(toLight, bsdf.Ng()), kSmallestGeometricCosine);
}

// |w·Ng| / |w·Ns|: the same for a direction that was sampled with the weight f · |w·Ns| / pdf.
inline float DepartureCorrection(const Bsdf& bsdf, const Vector3& direction) {
  const Normal3 Ns = bsdf.ShadingFrame().z;
  if (Ns == bsdf.Ng()) return 1;
  return AbsDot(direction, bsdf.Ng()) / std::max(AbsDot(direction, Ns), kSmallestGeometricCosine);
}

}  // namespace lampyr
