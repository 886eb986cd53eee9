// What all area lights share, whatever their shape: radiance over the surface, its sides, and how a chosen point of the
// surface becomes a sample, an evaluation or a photon. The shape gives the point and its density; the densities of
// direction are written here, once.
//
// The surface emits on the side that its normal points to, or on both. Radiance is L · scale, or scale times an image
// over the surface's uv. A ray that finds the light has passed the cut-outs of the geometry; a sample and a photon have
// not, so these two carry the opacity as a factor.
#pragma once

#include <memory>
#include <optional>

#include "geometry/geometry_scene.h"
#include "lights/emission_image.h"
#include "lights/light.h"
#include "math/frame.h"
#include "sampling/warp.h"

namespace lampyr {

// A point that a shape's sampling chose.
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
  // Reads L, scale, twosided, filename. `area` (world space) is what "power" is spread over.
  SurfaceEmission(const ParameterList& parameters, const LightBuildContext& build, double area);

  bool IsTwoSided() const { return twoSided_; }
  bool HasImage() const { return !image_.IsEmpty(); }
  bool NeedsUv() const { return HasImage() || alpha_ != nullptr; }
  const EmissionImage& EmittedImage() const { return image_; }

  // On an emitting side, cut-outs apart.
  Color Radiance(const Point2& uv) const { return image_.IsEmpty() ? radiance_ : radiance_ * image_.OnSurface(uv); }
  // Constant factor of the radiance: L · scale, or the scale of the image.
  const Color& Factor() const { return radiance_; }
  Color MeanRadiance() const { return image_.IsEmpty() ? radiance_ : radiance_ * image_.Mean(); }
  // Power of a surface of this area and mean radiance, all its sides counted.
  Color Power(const Color& meanRadiance, double area) const {
    return meanRadiance * static_cast<float>(area * static_cast<double>(kPi) * (twoSided_ ? 2 : 1));
  }

  // The cosine towards the receiver if that side emits, 0 otherwise.
  float EmittedCosine(float cosine) const { return twoSided_ ? std::abs(cosine) : std::max(cosine, 0.0f); }

  // pdfDirect of a point with this density; 0 where it has no solid angle or the number leaves the float range.
  static PdfSolidAngle DirectDensity(PdfArea density, float distanceSquared, float emittedCosine) {
    const PdfSolidAngle pdf = ToSolidAngle(density, distanceSquared, emittedCosine);
    return pdf.value < kInfinity ? pdf : PdfSolidAngle(0);
  }
  // pdfEmitDirection: cosine law on each emitting side.
  PdfSolidAngle EmissionDirectionDensity(float emittedCosine) const {
    return PdfSolidAngle(emittedCosine * (twoSided_ ? 0.5f * kInvPi : kInvPi));
  }

  // The point as a sample for P; nullopt when it sends nothing there.
  std::optional<LightSample> Sample(const LightContext& context, const Point3& P, const EmittingPoint& point) const;

  // Fills colours and bidirectional densities of a sample whose direction, distance, position, normal and pdfDirect are
  // there; false when it sends nothing.
  bool Complete(const LightContext& context, PdfArea density, LightSample& sample) const;

  // For a hit whose density over the surface is `density` and over directions `pdfDirect`.
  std::optional<LightEvaluation> Evaluate(const LightContext& context, const LightHit& hit, PdfArea density,
                                          PdfSolidAngle pdfDirect) const;
  // The same where pdfDirect follows from `density`.
  std::optional<LightEvaluation> Evaluate(const LightContext& context, const LightHit& hit, PdfArea density) const;

  std::optional<EmissionSample> Emit(const LightContext& context, const EmittingPoint& point) const;

  Color ForCamera(const LightHit& hit, bool cameraVisible) const;

 private:
  float Opacity(const Point2& uv, const Point3& position) const {
    return alpha_ ? std::clamp(alpha_->Alpha(uv, position), 0.0f, 1.0f) : 1.0f;
  }
  Color FoundRadiance(const LightHit& hit) const;

  Color radiance_;
  bool twoSided_ = false;
  EmissionImage image_;
  std::shared_ptr<const AlphaSource> alpha_;
};

}  // namespace lampyr
