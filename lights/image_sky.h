// A sky from an image: square and equal-area as in pbrt-v4 ([Clarberg08]), or latitude-longitude with twice the width.
// The radiance of a direction is its texel's, without interpolation (pbrt-v4's rule), so a table that is constant over
// each texel is proportional to it: no texel that shines has a density of 0.
#pragma once

#include "lights/emission_image.h"
#include "lights/infinite_frame.h"
#include "sampling/equal_area.h"
#include "sampling/tables.h"

namespace lampyr {

enum class SkyMap { EqualArea, LatLong };

class ImageSky {
 public:
  // The file that the parameter `name` gives, which map it is by its aspect; any other aspect is a located Error.
  ImageSky(const ParameterList& parameters, const std::string& name, const LightBuildContext& build);

  // How the sky is turned: `toImage` is orthogonal and leads from the directions that the other methods speak of to
  // those of the map (sampling/equal_area.h, +z in the middle of a square or at the top of a latitude-longitude image).
  void Turn(const glm::mat3& toImage) { toImage_ = toImage; }
  void Scale(const Color& factor) {
    scale_ *= factor;
    mean_ *= factor;
  }

  SkyMap Map() const { return map_; }
  int Height() const { return image_.Height(); }

  Color Radiance(const Vector3& local) const { return scale_ * image_.Nearest(ToSquare(toImage_ * local)); }
  Color Mean() const { return mean_; }
  // Of a surface under a hemisphere of mean radiance.
  float FacingIrradiance() const { return kPi * mean_.Average(); }

  SkySample Sample(const Point2& u) const {
    // The table and the texels come from memory at the same time: that is most of what a sample costs.
    const Distribution2D::Narrowed narrowed = table_.Narrow(u);
    image_.PrefetchRow(static_cast<int>(narrowed.first), static_cast<int>(narrowed.last),
                       static_cast<int>(narrowed.row));
    const Distribution2D::Cell cell = table_.Choose(narrowed);
    const Point2 uv = table_.At(cell);
    const Vector3 w = map_ == SkyMap::EqualArea ? EqualAreaSquareToSphere(uv) : LatLongSquareToSphere(uv);
    return {w * toImage_, {scale_ * image_.Texel(cell.column, cell.row), ToSolidAngle(cell.pdf, w)}, IsInside(cell, w)};
  }

  SkyPoint Look(const Vector3& local) const {
    const Vector3 w = toImage_ * local;
    const Point2 uv = ToSquare(w);
    image_.PrefetchNearest(uv);
    return {scale_ * image_.Nearest(uv), DensityAt(w, uv)};
  }

  // Luminous irradiance of a surface that faces the map's +z, from the texels of the upper hemisphere, before Scale.
  double UpperIlluminance() const;

 private:
  Point2 ToSquare(const Vector3& w) const {
    return map_ == SkyMap::EqualArea ? EqualAreaSphereToSquare(w) : LatLongSphereToSquare(w);
  }
  // Of the map's direction w, which is at uv.
  PdfSolidAngle DensityAt(const Vector3& w, const Point2& uv) const { return ToSolidAngle(table_.Density(uv), w); }
  PdfSolidAngle ToSolidAngle(float density, const Vector3& w) const {
    if (map_ == SkyMap::EqualArea) return PdfSolidAngle(density / kEqualAreaJacobian);
    const float jacobian = LatLongJacobian(std::sqrt(Sqr(w.x) + Sqr(w.y)));
    return PdfSolidAngle(jacobian > 0 ? density / jacobian : 0.0f);
  }
  // Whether the map's direction w, in the cell, is farther from the cell's edges than rounding carries it, and far
  // enough from the poles for the density.
  bool IsInside(const Distribution2D::Cell& cell, const Vector3& w) const {
    constexpr float kRounding = 2e-6f;  // on the unit sphere
    float x = kRounding * static_cast<float>(image_.Width()), y = kRounding * static_cast<float>(image_.Height());
    if (map_ == SkyMap::LatLong) {
      const float sinTheta = std::sqrt(Sqr(w.x) + Sqr(w.y));
      if (sinTheta < 0.05f) return false;
      x *= 0.5f * kInvPi / sinTheta;
      y *= kInvPi;
    }
    return cell.t.x > x && cell.t.x < 1 - x && cell.t.y > y && cell.t.y < 1 - y;
  }
  // sr of one texel in row y, exact.
  float RowSolidAngle(int y) const;

  EmissionImage image_;
  SkyMap map_ = SkyMap::EqualArea;
  glm::mat3 toImage_{1.0f};
  Distribution2D table_;
  Color scale_{1.0f};
  Color mean_;
};

}  // namespace lampyr
