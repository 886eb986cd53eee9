// Scattering at a point of a medium: the phase function of Henyey and Greenstein ([Henyey41]), sampled exactly.
//
// With h = |g| and t = 1 - cosθ, θ the angle from the lobe's axis (forward for g > 0, backward for g < 0),
//   p = (1 - h²) / (4π D^(3/2)),  D = (1 - h)² + 2 h t,
// and the sample t of u has √D = (1 - h²) / q, q = 1 - h + 2 h (1 - u). None of these forms divides by h or subtracts
// nearly equal numbers.
#pragma once

#include "materials/scattering.h"
#include "math/frame.h"
#include "sampling/warp.h"

namespace lampyr {

// Works in any frame: only the angle between the directions counts.
struct PhaseBsdf {
  Color scattering;  // factor of the phase function: σ_s, or the albedo
  float g = 0;       // mean cosine between the directions before and after scattering, in (-1,1)

  BsdfEvaluation Evaluate(const Vector3& wo, const Vector3& wi, TransportMode) const {
    const float h = std::abs(g);
    // 2 t as the squared distance of the directions from each other, or from opposition: cosθ itself has no precision
    // near the peak.
    const float twiceT = LengthSquared(g < 0 ? wi - wo : wi + wo);
    const float d = Sqr(1 - h) + h * twiceT;
    const PdfSolidAngle pdf((0.25f * kInvPi) * (1 - h) * (1 + h) / (d * std::sqrt(d)));
    return {scattering * pdf.value, Color(), pdf, pdf};
  }

  BsdfSample Sample(const Vector3& wo, float, const Point2& u, TransportMode) const {
    const float h = std::abs(g);
    const float q = 1 - h + 2 * h * (1 - u.x);
    const float t = std::min(2 * Sqr((1 - h) / q) * u.x * (1 + h * (1 - u.x)), 2.0f);
    const Vector2 phi = CosSinTurns(u.y);
    const float r = SafeSqrt(t * (2 - t));
    BsdfSample sample;
    sample.wi = Frame::FromNormal(g < 0 ? wo : -wo).ToWorld({r * phi.x, r * phi.y, 1 - t});
    sample.pdfForward = sample.pdfReverse = PdfSolidAngle((0.25f * kInvPi) * q * Sqr(q / ((1 - h) * (1 + h))));
    sample.weightDiffuse = scattering;
    return sample;
  }

  bool IsDelta() const { return false; }
  bool IsTransmissive() const { return true; }  // light from any direction contributes
};

}  // namespace lampyr
