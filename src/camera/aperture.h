// The shape of an aperture stop: a disk, one of the other shapes of pbrt-v4, or an image.
#pragma once

#include <string>
#include <vector>

#include "math/vec.h"

namespace lampyr {

// An image of an aperture, row by row from the top, as seen from the film with the camera's y axis up.
struct ApertureImage {
  int width = 0, height = 0;
  std::vector<float> values;
};

// Transmission over the area of the stop. Positions are relative to its centre, in units of its radius. All shapes are
// normalised to transmit as much as the disk (an integral of π): a smaller shape therefore has a transmission above 1,
// which stands for a longer exposure.
class Aperture {
 public:
  Aperture() = default;  // the disk
  // The shape `name`, one of Names(). Throws an Error for any other name.
  static Aperture Named(const std::string& name);
  static const std::vector<std::string>& Names();
  // The image over [-1,1]², bilinear between the centres of its pixels, 0 outside; negative values count as 0. Throws
  // an Error for an image that is black or not finite.
  static Aperture OfImage(ApertureImage image);

  double Transmission(const Point2d& p) const;
  // Radius around the centre beyond which the transmission is 0.
  double Extent() const { return extent_; }

 private:
  enum class Kind { Disk, Gaussian, Polygon, Image };

  static Aperture OfPolygon(std::vector<Point2d> corners);
  double Texel(int x, int y) const;

  Kind kind_ = Kind::Disk;
  double extent_ = 1, scale_ = 1;
  std::vector<Point2d> corners_;  // in order around the polygon
  ApertureImage image_;
};

}  // namespace lampyr
