// Common part of all area lights, independent of the shape: radiance over the surface, sides, shaping, and the
// conversion of a chosen point of the surface to a sample, an evaluation or a photon. The shape gives the point and its
// density; the densities of direction are computed here.
//
// The surface emits on the side that its normal points to, or on both. Radiance in W/(m² sr) is a constant or a factor
// times an image over the surface's uv, tinted and shaped (light_base.h, shaping.h). A ray that hits the light has
// already passed the cut-outs of the geometry; a sample and a photon have not, so these two include the opacity as a
// factor.
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "geometry/geometry_scene.h"
#include "lights/emission_image.h"
#include "lights/light_base.h"
#include "lights/types/shaped_directions.h"
#include "math/frame.h"
#include "sampling/warp.h"

namespace lampyr {

// A point of the surface, sampled by the shape.
struct EmittingPoint {
  Point3 position{0.0f};
  Vector3 positionError{0.0f};
  Normal3 normal{0.0f};  // unit, on the outer side
  Point2 uv{0.0f};
  int patch = 0;
  PdfArea density;  // world-space surface
};

class SurfaceEmission {
 public:
  // Light::Opacity.
  float OpacityAt(const LightHit& hit) const { return alpha_ ? Opacity(hit.uv, hit.position, hit.normal) : 1.0f; }
  // World-space area of the whole surface: what "power" is spread over and "normalize" divides by.
  struct Area {
    double built = 0;  // under the placement that the light is built with: exact
    // Under any placement, quickly: within a thousandth.
    std::function<double(const LightTransform&)> quick;
  };

  // pbrt-v4's names: L, scale, power, twosided, filename.
  static SurfaceEmission ReadDiffuse(const ParameterList& parameters, const LightBuildContext& build, const Area& area);
  // UsdLux's names: twoSided (ours), texture:file, shaping:…
  static SurfaceEmission ReadUsdLux(const ParameterList& parameters, const LightBuildContext& build, const Area& area,
                                    Shaping::Emitter emitter);

  bool IsTwoSided() const { return twoSided_; }
  bool HasImage() const { return !image_.IsEmpty(); }
  bool NeedsUv() const { return HasImage() || alpha_ != nullptr; }
  const EmissionImage& EmittedImage() const { return image_; }
  const ShapedDirections* Shaped() const { return shaped_.get(); }

  // Radiance on an emitting side under the placement that the light was built with, without shaping and cut-outs.
  Color Radiance(const Point2& uv) const { return image_.IsEmpty() ? radiance_ : radiance_ * image_.OnSurface(uv); }
  Color MeanRadiance() const { return image_.IsEmpty() ? radiance_ : radiance_ * image_.Mean(); }
  // Factor of Radiance under another placement: 1 unless the light is normalised by its area.
  float Strength(const LightTransform& transform) const { return normalize_ ? NormalizedStrength(transform) : 1.0f; }
  // Factor of the power under a similarity with this squared scale.
  float PowerScale(float scaleSquared) const { return normalize_ ? 1.0f : scaleSquared; }
  float SideCount() const { return twoSided_ ? 2.0f : 1.0f; }

  // Radiant exitance in W/m² of a point with this normal at radiance 1, summed over its sides: ∫ factor · |cosθ| dω.
  // Exact without shaping; with it, by quadrature over the photons' directions.
  Color Exitance(const LightTransform& transform, const Normal3& normal) const;

  // Power for SurfaceIrradianceEstimate that represents the light towards P: that of an unshaped light as bright as
  // this one in the direction of P. Positive for any light that emits.
  float ApparentPower(const LightContext& context, const EmissionBounds& bounds, float unshaped, const Point3& P) const;
  float LargestPower(float unshaped) const { return shaped_ ? unshaped * shaped_->Largest() : unshaped; }
  // Narrows the bounds of a flat light by the shaping cone: by its angle, and to one side if the far side is dark.
  void NarrowFlat(const LightTransform& transform, EmissionBounds& bounds) const;

  // The cosine towards the receiver if that side emits, 0 otherwise.
  float EmittedCosine(float cosine) const { return twoSided_ ? std::abs(cosine) : std::max(cosine, 0.0f); }

  // pdfDirect of a point with this density; 0 where it has no solid angle or the number leaves the float range.
  static PdfSolidAngle DirectDensity(PdfArea density, float distanceSquared, float emittedCosine) {
    const PdfSolidAngle pdf = ToSolidAngle(density, distanceSquared, emittedCosine);
    return pdf.value < kInfinity ? pdf : PdfSolidAngle(0);
  }
  // Makes a sample of the point for P; nullopt if it emits nothing towards P.
  std::optional<LightSample> Sample(const LightContext& context, const Point3& P, const EmittingPoint& point) const;

  // Completes a sample whose direction, distance, position, normal, uvw and pdfDirect are set: colours and
  // bidirectional densities. False if it contributes nothing. `density`: that of its position by GenerateEmission.
  bool Complete(const LightContext& context, PdfArea density, LightSample& sample) const;

  // Evaluates a hit. `density`: of its position over the surface; `pdfDirect`: of its direction.
  std::optional<LightEvaluation> Evaluate(const LightContext& context, const LightHit& hit, PdfArea density,
                                          PdfSolidAngle pdfDirect) const;
  // Evaluates a hit whose pdfDirect follows from `density`.
  std::optional<LightEvaluation> Evaluate(const LightContext& context, const LightHit& hit, PdfArea density) const;

  std::optional<EmissionSample> Emit(const LightContext& context, const EmittingPoint& point) const;

  // Radiance seen by the camera, without the diffuse and specular multipliers.
  Color ForCamera(const LightContext& context, const LightHit& hit, bool cameraVisible) const;

 private:
  SurfaceEmission(const ParameterList& parameters, const LightBuildContext& build, const Area& area);
  void SetRadiance(const ParameterList& parameters, const Color& radiance);
  float NormalizedStrength(const LightTransform& transform) const;
  float Opacity(const Point2& uv, const Point3& position, const Normal3& normal) const {
    return alpha_ ? std::clamp(alpha_->Alpha(uv, position, normal), 0.0f, 1.0f) : 1.0f;
  }
  // Radiance with all factors except cut-outs.
  Color Emitted(const LightContext& context, const Point2& uv, const Vector3& outgoing) const {
    Color radiance = Radiance(uv);
    if (normalize_) radiance *= NormalizedStrength(*context.transform);
    if (shaped_) radiance *= shaped_->Factor(*context.transform, outgoing);
    return radiance;
  }
  // Radiance as from Emitted, and pdfEmitDirection on an emitting side with the cosine `emittedCosine`: the density of
  // the shaping, or the cosine law on each side. No photon is emitted where the shaping is black.
  struct Leaving {
    Color radiance;
    PdfSolidAngle density;
  };
  Leaving Leave(const LightContext& context, const Point2& uv, const Normal3& normal, const Vector3& outgoing,
                float emittedCosine) const {
    Leaving leaving{Radiance(uv), CosineLaw(emittedCosine)};
    if (normalize_) leaving.radiance *= NormalizedStrength(*context.transform);
    if (!shaped_) return leaving;
    const ShapedDirections::Leaving shaped = shaped_->Look(*context.transform, normal, outgoing);
    leaving.radiance *= shaped.factor;
    if (shaped_->GuidesEmission() || shaped.factor.IsBlack()) leaving.density = shaped.density;
    return leaving;
  }
  bool IsCutOut(const LightHit& hit) const { return OpacityAt(hit) == 0; }
  PdfSolidAngle CosineLaw(float emittedCosine) const {
    return PdfSolidAngle(emittedCosine * (twoSided_ ? 0.5f * kInvPi : kInvPi));
  }
  // Samples the cosine law. For two-sided lights the first random number also chooses the side and is rescaled.
  Vector3 SampleCosineLaw(const Normal3& normal, Point2 u) const;
  Vector3 SampleEmissionDirection(const LightTransform& transform, const Normal3& normal, const Point2& u) const;

  LightTint tint_;
  Color radiance_;
  bool twoSided_ = false;
  bool normalize_ = false;
  EmissionImage image_;
  std::shared_ptr<const AlphaSource> alpha_;
  std::shared_ptr<const ShapedDirections> shaped_;
  // For `normalize` under other placements than the one the light was built with.
  LightTransform built_;
  Area area_;
  double quickBuilt_ = 0;
};

// Reads the emission parameters of a type of light.
using EmissionReader =
    std::function<SurfaceEmission(const ParameterList&, const LightBuildContext&, const SurfaceEmission::Area&)>;

}  // namespace lampyr
