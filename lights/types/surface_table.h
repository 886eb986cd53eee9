// Importance of the points of a textured surface: a table over the unit square from which the surface is sampled,
// proportional to radiance times area element. Its density is positive wherever the image emits.
#pragma once

#include <functional>
#include <memory>

#include "lights/emission_image.h"
#include "sampling/tables.h"

namespace lampyr {

// Description of a surface for the table: texture coordinates, and dA per area of the square up to a constant.
struct SurfaceTableInput {
  std::function<Point2(const Point2& square)> uv;
  std::function<float(const Point2& square)> element;
  bool firstIsV = false;  // the square's first coordinate runs along v
};

// Null when the image is black.
std::unique_ptr<const Distribution2D> MakeSurfaceTable(const EmissionImage& image, const SurfaceTableInput& surface);

}  // namespace lampyr
