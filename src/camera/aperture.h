// The shape of an aperture stop: a disk, or one of pbrt-v4's other shapes, or an image.
#pragma once

#include <string>
#include <vector>

#include "math/vec.h"

namespace lampyr {

// Rows of numbers from the top, as it is seen from the film with the camera's y up.
struct ApertureImage {
  int width = 0, height = 0;
  std::vector<float> values;
};

// What passes at each point of the stop, in radii of the stop from its middle. All shapes let through as much as the
// disk: the integral is π. Smaller shapes therefore pass more than all, which the exposure would make up for.
class Aperture {
 public:
  Aperture() = default;  // the disk
  // One of Names(). Throws an Error for another name.
  static Aperture Named(const std::string& name);
  static const std::vector<std::string>& Names();
  // The image over [-1,1]², bilinear between the middles of its pixels, black outside; negative values count as 0.
  // Throws an Error for an image that is black or not finite.
  static Aperture OfImage(ApertureImage image);

  double Transmission(const Point2d& p) const;
  // Radius of a disk around the middle beyond which nothing passes.
  double Extent() const { return extent_; }

 private:
  enum class Kind { Disk, Gaussian, Polygon, Image };

  static Aperture OfPolygon(std::vector<Point2d> corners);
  double Texel(int x, int y) const;

  Kind kind_ = Kind::Disk;
  double extent_ = 1, scale_ = 1;
  std::vector<Point2d> corners_;  // in order around it
  ApertureImage image_;
};

}  // namespace lampyr
