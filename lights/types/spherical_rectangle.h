// The directions in which a rectangle is seen from a point: its solid angle, and uniform sampling of it ([Ureña13] An
// area-preserving parametrization for spherical rectangles).
//
// In double, and arranged so that nothing cancels: the rectangle may be tiny and far away, touched by P, or seen at
// grazing incidence. With the rectangle [x0,x1] × [y0,y1] in the plane at distance z before P:
// - Its solid angle is that of two triangles; each is 2 arg(D + i det) ([VanOosterom83]), and their product needs one
//   arc tangent.
// - The part beyond x, without an end, is one triangle too, whose third corner is the direction of x: R(x) = e. Solved
//   for x, with γ = atan2(z, y) and δ = γ0 - γ1,
//     x / z = sin(δ - e) / (2 sqrt(sin(δ - e/2) sin(e/2) sin(γ1 + e/2) sin(γ0 - e/2))).
//   The side from which e is counted is the one where no difference of nearly equal angles occurs.
// - Given x, y/|P - (x,y)| is uniform; it is counted from the nearer end of [-1,1].
// Below 1e-8 sr the double itself cancels. The rectangle is then sampled by area, in a proportion that grows
// continuously from 0 there to 1 at 1e-9 sr; the density is that of the mixture.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "math/density.h"
#include "math/upper_angle.h"
#include "math/vec.h"

namespace lampyr {

class SphericalRectangle {
 public:
  // The rectangle corner + u·edgeX + v·edgeY; the edges are orthogonal but for rounding, and not 0.
  SphericalRectangle(const Point3d& P, const Point3d& corner, const Vector3d& edgeX, const Vector3d& edgeY) {
    x_ = edgeX / glm::length(edgeX);
    normal_ = glm::normalize(glm::cross(edgeX, edgeY));
    y_ = glm::cross(normal_, x_);
    const Vector3d toCorner = corner - P;
    Place({glm::dot(toCorner, x_), glm::dot(toCorner, y_), glm::dot(toCorner, normal_)}, glm::dot(edgeX, x_),
          glm::dot(edgeY, y_));
  }
  // The rectangle at `toCorner` from the viewer, its edges along x and y.
  SphericalRectangle(const Vector3d& toCorner, double width, double height)
      : x_(1, 0, 0), y_(0, 1, 0), normal_(0, 0, 1) {
    Place(toCorner, width, height);
  }

  // sr; 0 for a point in the rectangle's plane, or within 1e-11 of its distance to it: it is not seen from there.
  double SolidAngle() const { return solidAngle_; }
  // Height of P over the plane, positive on the side that edgeX × edgeY points to.
  double Height() const { return -signedZ_; }

  struct Result {
    Point2d uv;           // on the rectangle, in [0,1]²
    Vector3d toPoint{0};  // from P, not of unit length
    double distance = 0;
  };
  // Requires a solid angle above 0.
  Result Sample(const Point2& u) const {
    const auto ux = static_cast<double>(u.x), uy = static_cast<double>(u.y);
    if (ux < areaShare_) return At({ux / areaShare_, uy});
    const double x = SampleX(areaShare_ > 0 ? (ux - areaShare_) / (1 - areaShare_) : ux);
    const auto [y, distance] = SampleY(x, uy);
    return {{(x - x0_) / width_, (y - y0_) / height_}, x_ * x + y_ * y + normal_ * signedZ_, distance};
  }

  // Density in 1/sr of the direction towards uv in [0,1]².
  PdfSolidAngle Density(const Point2d& uv) const {
    if (!(solidAngle_ > 0)) return PdfSolidAngle(0);
    double density = (1 - areaShare_) / solidAngle_;
    if (areaShare_ > 0) {
      const double x = x0_ + uv.x * width_, y = y0_ + uv.y * height_;
      const double d2 = x * x + y * y + z_ * z_;
      density += areaShare_ * d2 * std::sqrt(d2) / (width_ * height_ * z_);
    }
    return PdfSolidAngle(density < 3e38 ? static_cast<float>(density) : 0.0f);
  }

  // True if Density is constant.
  bool IsUniform() const { return areaShare_ == 0; }

  // Intersection of the ray from P along `direction` (of any length) with the rectangle, as uv.
  std::optional<Point2d> Meet(const Vector3d& direction) const {
    const double slope = glm::dot(direction, normal_);
    if (!(slope * signedZ_ > 0 && solidAngle_ > 0)) return std::nullopt;
    const double t = signedZ_ / slope;
    const Point2d uv((t * glm::dot(direction, x_) - x0_) / width_, (t * glm::dot(direction, y_) - y0_) / height_);
    if (!(uv.x >= 0 && uv.x <= 1 && uv.y >= 0 && uv.y <= 1)) return std::nullopt;
    return uv;
  }

  // Offset from P to a point of the rectangle.
  Result At(const Point2d& uv) const {
    const double x = x0_ + uv.x * width_, y = y0_ + uv.y * height_;
    return {uv, x_ * x + y_ * y + normal_ * signedZ_, std::sqrt(x * x + y * y + z_ * z_)};
  }

 private:
  static constexpr double kUniform = 1e-8, kByArea = 1e-9;  // sr

  void Place(const Vector3d& toCorner, double width, double height) {
    width_ = width;
    height_ = height;
    x0_ = toCorner.x;
    x1_ = x0_ + width;
    y0_ = toCorner.y;
    y1_ = y0_ + height;
    signedZ_ = toCorner.z;
    z_ = std::abs(signedZ_);
    const double z2 = z_ * z_, xx0 = x0_ * x0_ + z2, xx1 = x1_ * x1_ + z2, yy0 = y0_ * y0_, yy1 = y1_ * y1_;
    r00_ = std::sqrt(xx0 + yy0);
    r01_ = std::sqrt(xx0 + yy1);
    r10_ = std::sqrt(xx1 + yy0);
    r11_ = std::sqrt(xx1 + yy1);
    solidAngle_ = ComputeSolidAngle();
    areaShare_ = solidAngle_ > kUniform ? 0 : std::min((kUniform - solidAngle_) / (kUniform - kByArea), 1.0);
  }

  double ComputeSolidAngle() const {
    // P is in the plane up to rounding: on a diagonal of the rectangle the sign of D is unreliable.
    if (!(z_ > 1e-11 * std::max(std::max(r00_, r01_), std::max(r10_, r11_)))) return 0;
    // D of the triangles (00,10,11) and (00,11,01); both have the determinant z·width·height.
    const double z2 = z_ * z_, det = z_ * width_ * height_;
    const double diagonal = x0_ * x1_ + y0_ * y1_ + z2;
    const double lower = r00_ * r10_ * r11_ + (x0_ * x1_ + y0_ * y0_ + z2) * r11_ +
                         (x1_ * x1_ + y0_ * y1_ + z2) * r00_ + diagonal * r10_;
    const double upper = r00_ * r11_ * r01_ + diagonal * r01_ + (x0_ * x1_ + y1_ * y1_ + z2) * r00_ +
                         (x0_ * x0_ + y0_ * y1_ + z2) * r11_;
    const double solidAngle = 2 * UpperAngle(det * (lower + upper), lower * upper - det * det);
    return solidAngle > 0 ? solidAngle : 0.0;
  }

  // The side to count from varies from sample to sample and is selected by index, because a branch would be
  // mispredicted.
  double SampleX(double u) const {
    const int mirrored = static_cast<int>(x1_ <= 0) | (static_cast<int>(x0_ < 0) & static_cast<int>(u < 0.5));
    const double sign = 1 - 2 * mirrored;
    // Solid angle beyond x (to the right, or to the left if mirrored), twice the angle of (a, b), and the part of the
    // rectangle that is counted from there: half of their sum, by its sine and cosine.
    const double ends[2] = {x1_, -x0_}, r0s[2] = {r10_, r00_}, r1s[2] = {r11_, r01_};
    const double end = ends[mirrored], r0 = r0s[mirrored], r1 = r1s[mirrored];
    const double a = r0 * r1 + end * end + y0_ * y1_ + z_ * z_ + end * (r0 + r1), b = z_ * height_;
    const double part = 0.5 * solidAngle_ * (mirrored + sign * (1 - u));
    const auto [sinPart, cosPart] = SineCosineOfUpper(part);
    // Sines and cosines up to factors that cancel in x: of e/2, then of δ and δ - e/2.
    const double s = b * cosPart + a * sinPart, c = a * cosPart - b * sinPart;
    const double sinDelta = height_ * z_, cosDelta = z_ * z_ + y0_ * y1_;
    const double sinRest = sinDelta * c - cosDelta * s, cosRest = cosDelta * c + sinDelta * s;
    const double numerator = sinRest * c - cosRest * s;  // sin(δ - e)
    const double root = sinRest * s * (z_ * c + y1_ * s) * (z_ * c - y0_ * s);
    // The end itself, if rounding leads beyond it.
    const double x = root > 0 ? 0.5 * z_ * numerator / std::sqrt(root) : end;
    return std::clamp(sign * x, x0_, x1_);
  }

  // Samples y given x; also returns the distance of the point from P.
  std::pair<double, double> SampleY(double x, double v) const {
    const double d2 = x * x + z_ * z_;
    // 1 - y/r for both ends, seen from above or from below.
    const int fromBelow = static_cast<int>(y1_ <= 0) | (static_cast<int>(y0_ < 0) & static_cast<int>(v < 0.5));
    const double sign = 1 - 2 * fromBelow;
    const double nearEnds[2] = {y1_, -y0_}, farEnds[2] = {y0_, -y1_};
    const double nearEnd = nearEnds[fromBelow], farEnd = farEnds[fromBelow];
    const double m1 = OneMinusSine(nearEnd, d2), m0 = OneMinusSine(farEnd, d2);
    const double m = m1 + (fromBelow + sign * (1 - v)) * (m0 - m1);
    const double below = m * (2 - m);
    if (!(below > 0)) return {sign * nearEnd, std::sqrt(d2 + nearEnd * nearEnd)};
    const double distance = std::sqrt(d2 / below);
    return {std::clamp(sign * (distance * (1 - m)), y0_, y1_), distance};
  }
  static double OneMinusSine(double y, double d2) {
    // One quotient for both signs of y, because a branch on the sign would be mispredicted.
    const double r = std::sqrt(d2 + y * y), sum = r + std::abs(y);
    const double numerator = y > 0 ? d2 : sum, denominator = y > 0 ? r * sum : r;
    return numerator / denominator;
  }

  Vector3d x_{0}, y_{0}, normal_{0};
  double width_ = 0, height_ = 0;
  double x0_ = 0, x1_ = 0, y0_ = 0, y1_ = 0, z_ = 0, signedZ_ = 0;
  double r00_ = 0, r01_ = 0, r10_ = 0, r11_ = 0;  // from P to the corners
  double solidAngle_ = 0, areaShare_ = 0;
};

}  // namespace lampyr
