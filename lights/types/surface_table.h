// Importance of the points of a textured surface: a table over the unit square that the surface is sampled from, in
// proportion to radiance times area element. No point where the image shines has density 0.
#pragma once

#include <functional>
#include <memory>

#include "lights/emission_image.h"
#include "sampling/tables.h"

namespace lampyr {

// What the table has to know of a surface: its texture coordinates, and dA per area of the square up to a constant.
struct SurfaceTableInput {
  std::function<Point2(const Point2& square)> uv;
  std::function<float(const Point2& square)> element;
  bool firstIsV = false;  // the square's first coordinate runs along v
};

// Null when the image is black.
std::unique_ptr<const Distribution2D> MakeSurfaceTable(const EmissionImage& image, const SurfaceTableInput& surface);

}  // namespace lampyr
