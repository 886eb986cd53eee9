#include "camera/aperture.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace lampyr {

namespace {

constexpr double kPiDouble = 3.14159265358979323846;

// Corners at equal angular steps from the angle `first` on, at alternating radii.
std::vector<Point2d> Star(int count, double first, double even, double odd) {
  std::vector<Point2d> corners;
  for (int i = 0; i < count; ++i) {
    const double angle = first + 2 * kPiDouble * i / count, radius = i % 2 == 0 ? even : odd;
    corners.push_back({radius * std::cos(angle), radius * std::sin(angle)});
  }
  return corners;
}

double Cross(const Point2d& a, const Point2d& b) {
  return a.x * b.y - a.y * b.x;
}

// True if `p` is inside of the polygon: the number of edges to its right is odd.
bool IsInside(const std::vector<Point2d>& corners, const Point2d& p) {
  bool inside = false;
  for (size_t i = 0; i < corners.size(); ++i) {
    const Point2d &a = corners[i], &b = corners[(i + 1) % corners.size()];
    if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x)) inside = !inside;
  }
  return inside;
}

}  // namespace

const std::vector<std::string>& Aperture::Names() {
  static const std::vector<std::string> names = {"gaussian", "square", "pentagon", "star"};
  return names;
}

Aperture Aperture::OfPolygon(std::vector<Point2d> corners) {
  Aperture aperture;
  aperture.kind_ = Kind::Polygon;
  aperture.extent_ = 0;
  double twiceArea = 0;
  for (size_t i = 0; i < corners.size(); ++i) {
    aperture.extent_ = std::max(aperture.extent_, glm::length(corners[i]));
    twiceArea += Cross(corners[i], corners[(i + 1) % corners.size()]);
  }
  aperture.scale_ = 2 * kPiDouble / std::abs(twiceArea);
  aperture.corners_ = std::move(corners);
  return aperture;
}

Aperture Aperture::Named(const std::string& name) {
  if (name == "square") return OfPolygon({{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}});
  if (name == "pentagon") return OfPolygon(Star(5, -0.5 * kPiDouble, 0.8, 0.8));
  if (name == "star") return OfPolygon(Star(10, 0, std::cos(0.4 * kPiDouble) / std::cos(0.2 * kPiDouble), 1));
  if (name == "gaussian") {
    Aperture aperture;
    aperture.kind_ = Kind::Gaussian;
    aperture.scale_ = 1 / (1 - 2 / std::exp(1.0));
    return aperture;
  }
  throw Error("there is no aperture \"" + name + "\"" + DidYouMean(name, Names()));
}

Aperture Aperture::OfImage(ApertureImage image) {
  double sum = 0;
  for (float& value : image.values) {
    value = std::max(value, 0.0f);
    sum += static_cast<double>(value);
  }
  if (!(sum > 0) || !std::isfinite(sum)) throw Error("the image of the aperture is black, or not finite");
  Aperture aperture;
  aperture.kind_ = Kind::Image;
  aperture.extent_ = std::sqrt(2.0);
  aperture.scale_ = 0.25 * kPiDouble * static_cast<double>(image.values.size()) / sum;
  aperture.image_ = std::move(image);
  return aperture;
}

double Aperture::Texel(int x, int y) const {
  if (x < 0 || y < 0 || x >= image_.width || y >= image_.height) return 0;
  const size_t row = static_cast<size_t>(y) * static_cast<size_t>(image_.width);
  return static_cast<double>(image_.values[row + static_cast<size_t>(x)]);
}

double Aperture::Transmission(const Point2d& p) const {
  if (glm::dot(p, p) > extent_ * extent_) return 0;
  switch (kind_) {
    case Kind::Disk:
      return 1;
    case Kind::Gaussian:
      return scale_ * std::max(std::exp(-glm::dot(p, p)) - std::exp(-1.0), 0.0);
    case Kind::Polygon:
      return IsInside(corners_, p) ? scale_ : 0.0;
    case Kind::Image:
      break;
  }
  if (std::abs(p.x) > 1 || std::abs(p.y) > 1) return 0;
  const double x = 0.5 * (p.x + 1) * image_.width - 0.5, y = 0.5 * (1 - p.y) * image_.height - 0.5;
  const int x0 = static_cast<int>(std::floor(x)), y0 = static_cast<int>(std::floor(y));
  const double u = x - x0, v = y - y0;
  return scale_ * ((1 - v) * ((1 - u) * Texel(x0, y0) + u * Texel(x0 + 1, y0)) +
                   v * ((1 - u) * Texel(x0, y0 + 1) + u * Texel(x0 + 1, y0 + 1)));
}

}  // namespace lampyr
