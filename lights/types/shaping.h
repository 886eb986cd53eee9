// Angular shaping of emission (UsdLux's ShapingAPI): cone, focus and IES profile as one factor over directions, with
// its sampling, for all lights that support it.
//
// Directions are unit, in the light's local space and point away from the light; the primary axis is -z. θ is the angle
// from it, φ goes from +x towards +y (counterclockwise seen from +z, the luminaire's zenith).
//   cone    0 beyond `shaping:cone:angle`; inside 1 - smoothstep(θ; lerp(softness, angle, 0), angle)
//   focus   lerp(f; focusTint, 1) per channel, f = |cosθ|^focus: of the direction and the primary axis, so that spheres
//           and cylinders shine backwards too
//   IES     the profile's candela at (θ', φ), over its mean over the sphere when normalised. With s = angleScale:
//           θ' = θ/s for s > 0, π - (π - θ)/-s for s < 0, θ for s = 0; clamped to [0, π]
// A part applies if one of its parameters is given. Values that UsdLux clamps or ignores (softness outside of
// [0, 1], a negative focus) are clamped and ignored, with a warning.
//
// Choices that UsdLux's text leaves open: φ = 0 is the emission direction's +x (hdEmbree takes φ of the reversed
// direction, which is half a turn away). `normalize` divides by the power of the profile as it is in the file over 4π,
// also when it covers a hemisphere only, where hdEmbree divides by power over 2π: a normalised point light thus emits
// what it would without a profile.
#pragma once

#include <functional>
#include <memory>

#include "lights/light_type.h"
#include "math/density.h"
#include "math/vec.h"

namespace lampyr {

class ShapedFactor;
class ShapedTable;

class Shaping {
 public:
  // Kind of the light's normals, which determines the measure in which photons are sampled.
  enum class Emitter {
    Point,  // no surface: the factor alone
    Flat,   // the normal is -z everywhere: factor · cosθ, on that side
    Round,  // normals of all directions: the factor alone
  };

  // Null if no shaping parameter is given. Throws located Errors.
  static std::shared_ptr<const Shaping> Read(const ParameterList& parameters, const LightBuildContext& build,
                                             Emitter emitter);

  // Factor of the emitted radiance (or intensity) in the direction `local`.
  Color Factor(const Vector3& local) const;
  // Upper bound of the channels of the factor.
  float Largest() const { return largest_; }

  // A direction of emission; the density is 1/sr in local space, never 0 where the factor (on the emitting side) is
  // not. A factor that is 0 everywhere gives the axis, with density 0; so may a direction on the very rim.
  Vector3 SampleDirection(const Point2& u) const;
  PdfSolidAngle Density(const Vector3& local) const;
  // True if sampling by the shaping is better than by the cosine law around the normal: false for Round emitters whose
  // factor fills more than a hemisphere.
  bool GuidesEmission() const { return guidesEmission_; }

  // ∫ Factor dω over the sphere for points, ∫ Factor cosθ dω over the emitting hemisphere for flat emitters: exact to
  // 1e-4, in local space. For round ones: the mean over normals of all directions of ∫ Factor cosθ dω.
  Color Integral() const { return integral_; }
  Emitter EmitterKind() const { return emitter_; }
  // ∫ Factor · weight dω by quadrature (over -z's hemisphere for flat emitters): for transforms that are no
  // similarities and for bodies whose normals are not of all directions. Slow; for tables and estimates.
  Color Integral(const std::function<double(const Vector3d& local)>& weight) const;

  // No emission at more than this angle from -z: its cosine, -1 when there is emission in all directions.
  float CosWidest() const { return cosWidest_; }

 private:
  Shaping(std::shared_ptr<const ShapedFactor> factor, Emitter emitter);

  std::shared_ptr<const ShapedFactor> factor_;
  std::shared_ptr<const ShapedTable> table_;
  Emitter emitter_;
  float largest_ = 0, cosWidest_ = -1;
  bool guidesEmission_ = true;
  Color integral_;
};

// The rows of a type's parameter table, and those of the IES part alone.
std::vector<ParameterInfo> ShapingParameters();
std::vector<ParameterInfo> IesParameters();

}  // namespace lampyr
