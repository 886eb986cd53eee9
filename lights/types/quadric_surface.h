// Spheres, disks and cylinders, also partial ones, as emitting surfaces: sampling by area, and of the part visible from
// a receiver.
//
// A point is sampled from the unit square, uniformly in the area in local space:
//   sphere, cylinder   (height along z, φ)           partial disk   (radius², φ)
//   whole disk         concentric
// Texture coordinates are those of the geometry (u along φ; v from the lower to the upper end, and from the rim to the
// middle of a disk), or, where `planarUv`, an image that is laid on the disk's square and seen upright from -z: u along
// -x, v along +y.
#pragma once

#include <memory>

#include "geometry/mapped_area.h"
#include "geometry/quadric.h"
#include "lights/types/line_view.h"
#include "lights/types/placed_surface.h"
#include "lights/types/sphere_cone.h"

namespace lampyr {

class QuadricSurface {
 public:
  explicit QuadricSurface(const Quadric& quadric, bool planarUv = false);
  // Textured: the square is laid out so that the table's cells are ranges of uv.
  void SetTextured() { textured_ = true; }
  // For surfaces that rays may pass: their far side is visible through the near one.
  void LetRaysPass() { hidesFarSide_ = false; }

  const Quadric& Shape() const { return quadric_; }
  using Placed = PlacedSurface;
  PlacedSurface Place(const LightTransform& transform) const;
  double AreaOf(const PlacedSurface& placed) const { return GetArea(lampyr::Shape(In(placed))); }
  // Accurate to 1e-3, and fast where AreaOf integrates.
  double QuickAreaOf(const PlacedSurface& placed) const {
    return mappedArea_ ? mappedArea_->Under(glm::dmat3(placed.toRender.linear)) : AreaOf(placed);
  }
  Bounds3 BoundsOf(const PlacedSurface& placed) const { return GetBounds(lampyr::Shape(In(placed))); }

  bool IsFlat() const { return quadric_.kind == Quadric::Kind::Disk; }
  // True if the mean over the surface is the mean over all normals.
  bool HasAllNormals(const PlacedSurface& placed) const { return quadric_.IsFullSphere() && placed.isSimilar; }
  bool FirstIsV() const { return !IsConcentric(); }
  // True if dA / (du dv) is constant and every uv of the square is on the surface.
  bool IsEvenOverUv(const PlacedSurface& placed) const {
    return quadric_.kind == Quadric::Kind::Cylinder && placed.isSimilar;
  }
  // True if View may exist.
  bool HasViews() const { return isFullSphere_ || quadric_.kind == Quadric::Kind::Cylinder; }
  // The arc's density is a function of uv.
  bool ViewNeedsUv() const { return quadric_.kind == Quadric::Kind::Cylinder; }

  // The quadric's own space.
  double OwnDensity() const { return ownDensity_; }  // 1/area
  Point3 At(const Point2& square) const;
  Normal3 OutwardNormal(const Point3& p) const;
  Point2 UvAt(const Point2& square, const Point3& p) const;
  Point2 UvOf(const Point3& p) const;
  Point2 SquareAt(const Point2& uv) const;

  // The part of the surface visible from P, if it can be sampled: the cone that a sphere subtends from outside, or the
  // arc of a cylinder that faces P.
  struct Arc {
    bool isThere = false;
    Vector2 towards{1, 0};  // unit, from the axis to P, in the quadric's own space
    float turns = 0;        // angle of `towards`, and half the arc, both in turns
    float halfTurns = 0;
    float distance = 0, along = 0;  // of P from the axis, and its z
  };
  struct View {
    float weight = 0;  // probability of sampling by it: 1, or 0 without a view
    bool isCone = false;
    SphereCone cone;
    Arc arc;
  };
  View ViewFrom(const PlacedSurface& placed, const Point3& P, bool twoSided) const {
    View view;
    // The cone's samples are on the near side: all that is seen of a sphere, unless the far side, too, emits towards P.
    const bool seesFarSide = !hidesFarSide_ && (twoSided || normalSign_ < 0);
    if (isFullSphere_ && placed.isSimilar && !seesFarSide) {
      const auto cone = SphereCone::From(P, placed.toRender.translation, quadric_.radius * placed.scale);
      if (!cone) return view;
      view.cone = *cone;
      view.isCone = true;
      view.weight = 1;
    } else if (quadric_.kind == Quadric::Kind::Cylinder) {
      view.arc = ArcFrom(placed, P, twoSided);
      view.weight = view.arc.isThere ? 1.0f : 0.0f;
    }
    return view;
  }
  // Density in 1/sr of a point on an emitting side.
  PdfSolidAngle ViewDensity(const View& view, const SeenPoint& seen) const {
    if (!view.isCone) return ArcDensity(view.arc, seen);
    // The cone's samples are on the near side, which is the inner side of a sphere with reversed orientation.
    return seen.outwardCosine * normalSign_ > 0 ? view.cone.Density() : PdfSolidAngle(0);
  }
  static bool NeedsEvenDensity(const View& view) { return !view.isCone; }
  // Fills direction, distance, position, its error, normal and, if wanted, uvw.
  void SampleView(const View& view, const PlacedSurface& placed, const Point3& P, const Point2& u, bool needsUv,
                  LightSample& sample) const {
    if (view.isCone) {
      SampleCone(view.cone, placed, u, needsUv, sample);
    } else {
      SampleArc(view.arc, placed, P, u, sample);
    }
  }

 private:
  // The line of a cylinder at an angle from `towards`, given by its cosine, as seen from P; for sampling uniformly in
  // angle.
  LineView LineOf(const Arc& arc, float cosine) const {
    const float height = std::sqrt(Sqr(arc.distance - quadric_.radius) +
                                   2 * arc.distance * quadric_.radius * std::max(1 - cosine, 0.0f));
    return {height, arc.along, low_, high_};
  }
  Arc ArcFrom(const PlacedSurface& placed, const Point3& P, bool twoSided) const;
  PdfSolidAngle ArcDensity(Arc arc, SeenPoint seen) const;
  void SampleArc(Arc arc, const PlacedSurface& placed, const Point3& P, const Point2& u, LightSample& sample) const;
  void SampleCone(const SphereCone& cone, const PlacedSurface& placed, const Point2& u, bool needsUv,
                  LightSample& sample) const {
    const float radius = quadric_.radius * placed.scale;
    const SphereCone::Hit hit = cone.Sample(u);
    sample.direction = hit.direction;
    sample.distance = hit.distance;
    sample.position = placed.toRender.translation + radius * hit.normal;
    sample.positionError = Gamma(16) * (Abs(placed.toRender.translation) + Vector3(radius));
    sample.normal = hit.normal * normalSign_;
    if (needsUv) sample.uvw = Point3(UvOf(placed.toOwn.linear * (radius * hit.normal)), 0.0f);
  }
  Quadric In(const PlacedSurface& placed) const;
  bool IsWholeDisk() const { return IsFlat() && quadric_.innerRadius == 0 && quadric_.phiMax >= 2 * kPi; }
  bool IsConcentric() const { return IsWholeDisk() && (planarUv_ || !textured_); }
  double ComputeOwnDensity() const;
  std::shared_ptr<const MappedArea> MakeMappedArea() const;

  Quadric quadric_;
  bool planarUv_;
  bool isFullSphere_;
  bool hidesFarSide_ = true;
  bool textured_ = false;
  float normalSign_;  // of the outer side relative to the quadric's normal
  float low_, high_;  // along z
  double ownDensity_;
  std::shared_ptr<const MappedArea> mappedArea_;  // null: there is a closed form
};

}  // namespace lampyr
