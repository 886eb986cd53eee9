// A sky from an image: square and equal-area as in pbrt-v4 ([Clarberg08]), or latitude-longitude with twice the width.
// Radiance is not interpolated (pbrt-v4's rule), so that a table that is constant over each texel is proportional to
// it. Every texel that emits has a positive density.
#pragma once

#include "lights/emission_image.h"
#include "lights/infinite_frame.h"
#include "lights/types/sky_cells.h"
#include "sampling/color_table.h"
#include "sampling/equal_area.h"

namespace lampyr {

enum class SkyMap { EqualArea, LatLong };

class ImageSky {
 public:
  // Reads the file given by the parameter `name`. Its aspect determines the map; other aspects are located Errors.
  ImageSky(const ParameterList& parameters, const std::string& name, const LightBuildContext& build);

  // Sets the orientation: `toImage` is orthogonal and maps local directions to those of the image
  // (sampling/equal_area.h; +z in the centre of a square or at the top of a latitude-longitude image).
  void Turn(const glm::mat3& toImage) { toImage_ = toImage; }
  void Scale(const Color& factor) {
    scale_ *= factor;
    mean_ *= factor;
  }

  SkyMap Map() const { return map_; }
  int Height() const { return table_.Height(); }

  Color Radiance(const Vector3& local) const { return scale_ * table_.Look(ToSquare(toImage_ * local)).color; }
  Color Mean() const { return mean_; }
  // Without a normal: of a surface under a hemisphere of the mean radiance.
  float Irradiance(const SkyReceiver& receiver) const {
    if (!receiver.HasNormal()) return kPi * mean_.Average();
    return 4 * kPi * mean_.Average() * cells_.MeanCosineOf(InImage(receiver));
  }

  SkySample Sample(const SkyReceiver& receiver, const Point2& u) const {
    SkyCells::Choice choice;
    choice.gain = 1;
    if (!receiver.HasNormal()) {
      choice.texel = table_.Sample(u);
    } else {
      choice = cells_.Sample(table_, InImage(receiver), u);
      if (!choice.exists) return {-receiver.normal, {}, true};  // nothing of the sky is seen
    }
    const ColorTable::Cell& cell = choice.texel;
    const Vector3 w = FromSquare(table_.At(cell));
    const PdfSolidAngle density = ToSolidAngle(cell.pdf, w);
    return {w * toImage_, {scale_ * cell.color, density, density * choice.gain}, IsInside(cell, w)};
  }

  SkyPoint Look(const SkyReceiver& receiver, const Vector3& local) const {
    const Vector3 w = toImage_ * local;
    const ColorTable::Texel texel = table_.Look(ToSquare(w));
    const PdfSolidAngle density = ToSolidAngle(texel.pdf, w);
    const bool hasNormal = receiver.HasNormal() && !density.IsZero();
    return {scale_ * texel.color, density,
            hasNormal ? density * cells_.Gain(InImage(receiver), texel.x, texel.y) : density};
  }

  // Luminous irradiance of a surface that faces the image of the map's +z under `transform`, before Scale.
  double UpperIlluminance(const LightTransform& transform) const;

 private:
  SkyReceiver InImage(const SkyReceiver& receiver) const {
    return {toImage_ * receiver.normal, receiver.isTransmissive};
  }
  Vector3 FromSquare(const Point2& uv) const {
    return map_ == SkyMap::EqualArea ? EqualAreaSquareToSphere(uv) : LatLongSquareToSphere(uv);
  }
  Point2 ToSquare(const Vector3& w) const {
    return map_ == SkyMap::EqualArea ? EqualAreaSphereToSquare(w) : LatLongSphereToSquare(w);
  }
  // Converts a density over the square to solid angle, at the map's direction w.
  PdfSolidAngle ToSolidAngle(float density, const Vector3& w) const {
    if (map_ == SkyMap::EqualArea) return PdfSolidAngle(density / kEqualAreaJacobian);
    const float jacobian = LatLongJacobian(std::sqrt(Sqr(w.x) + Sqr(w.y)));
    return PdfSolidAngle(jacobian > 0 ? density / jacobian : 0.0f);
  }
  // True if the distance of the map's direction w from the edges of its cell exceeds the rounding of directions, and it
  // is far enough from the poles for the density to be accurate.
  bool IsInside(const ColorTable::Cell& cell, const Vector3& w) const {
    constexpr float kRounding = 2e-6f;  // on the unit sphere
    float x = kRounding * static_cast<float>(table_.Width()), y = kRounding * static_cast<float>(table_.Height());
    if (map_ == SkyMap::LatLong) {
      const float sinTheta = std::sqrt(Sqr(w.x) + Sqr(w.y));
      if (sinTheta < 0.05f) return false;
      x *= 0.5f * kInvPi / sinTheta;
      y *= kInvPi;
    }
    return cell.t.x > x && cell.t.x < 1 - x && cell.t.y > y && cell.t.y < 1 - y;
  }
  // Solid angle in sr of one texel in row y of a map of that size; exact.
  float RowSolidAngle(int y, int columns, int rows) const;

  SkyMap map_ = SkyMap::EqualArea;
  glm::mat3 toImage_{1.0f};
  ColorTable table_;
  SkyCells cells_;
  Color scale_{1.0f};
  Color mean_;
};

}  // namespace lampyr
