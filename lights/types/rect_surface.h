// A rectangle width × height at z = 0, centred at the origin, that emits along -z. Sampled uniformly in solid angle if
// it is a rectangle in render space (spherical_rectangle.h), and by area as a parallelogram. The unit square that it is
// sampled from is its texture: seen from the lit side the image is upright, its left at +x and its top at +y (UsdLux).
#pragma once

#include <optional>

#include "lights/types/placed_surface.h"
#include "lights/types/spherical_rectangle.h"

namespace lampyr {

class RectSurface {
 public:
  RectSurface(float width, float height) : width_(width), height_(height) {}
  void SetTextured() {}

  float Width() const { return width_; }
  float Height() const { return height_; }
  // If the edges are orthogonal in render space: their frame, in double.
  struct Placed : PlacedSurface {
    bool isRectangle = false;
    Vector3d x{0.0}, y{0.0}, z{0.0};  // unit: along rising u, along rising v, their cross product
    double width = 0, height = 0;
    Vector3 positionError{0.0f};  // of any point
  };
  Placed Place(const LightTransform& transform) const;
  double AreaOf(const PlacedSurface& placed) const;
  double QuickAreaOf(const PlacedSurface& placed) const { return AreaOf(placed); }
  Bounds3 BoundsOf(const PlacedSurface& placed) const;

  bool IsFlat() const { return true; }
  bool HasAllNormals(const PlacedSurface&) const { return false; }
  bool FirstIsV() const { return false; }
  bool IsEvenOverUv(const PlacedSurface&) const { return true; }
  bool HasViews() const { return true; }
  bool ViewNeedsUv() const { return true; }

  double OwnDensity() const { return 1 / (static_cast<double>(width_) * static_cast<double>(height_)); }
  Point3 At(const Point2& square) const { return {(0.5f - square.x) * width_, (square.y - 0.5f) * height_, 0.0f}; }
  Normal3 OutwardNormal(const Point3&) const { return {0, 0, -1}; }
  Point2 UvAt(const Point2& square, const Point3&) const { return square; }
  Point2 SquareAt(const Point2& uv) const { return uv; }

  struct View {
    float weight = 0;                             // 1, or 0 where the rectangle is not seen by solid angle
    std::optional<SphericalRectangle> rectangle;  // in the frame of its edges
  };
  View ViewFrom(const Placed& placed, const Point3& P, bool twoSided) const;
  PdfSolidAngle ViewDensity(const View& view, const SeenPoint& seen) const {
    return view.rectangle->Density(Point2d(seen.uv));
  }
  static bool NeedsEvenDensity(const View&) { return false; }
  // Fills direction, distance, position, its error, normal and uvw.
  void SampleView(const View& view, const Placed& placed, const Point3& P, const Point2& u, bool needsUv,
                  LightSample& sample) const;

 private:
  float width_, height_;
};

}  // namespace lampyr
