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

  Vector3 Sample(const Point2& u) const {
    const Point2 uv = table_.Sample(u).uv;
    // The texel is asked for next, by the direction: its way from memory is as long as the trigonometry until then.
    image_.PrefetchNearest(uv);
    return (map_ == SkyMap::EqualArea ? EqualAreaSquareToSphere(uv) : LatLongSquareToSphere(uv)) * toImage_;
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
  PdfSolidAngle DensityAt(const Vector3& w, const Point2& uv) const {
    const float density = table_.Density(uv);
    if (map_ == SkyMap::EqualArea) return PdfSolidAngle(density / kEqualAreaJacobian);
    const float jacobian = LatLongJacobian(std::sqrt(Sqr(w.x) + Sqr(w.y)));
    return PdfSolidAngle(jacobian > 0 ? density / jacobian : 0.0f);
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
