// One number per pixel, and means over boxes of pixels.
#pragma once

#include <cstddef>
#include <vector>

namespace lampyr {

struct Plane {
  int width = 0, height = 0;
  std::vector<float> values;  // row by row

  Plane() = default;
  Plane(int w, int h, float value = 0)
      : width(w), height(h), values(static_cast<size_t>(w) * static_cast<size_t>(h), value) {}

  float& At(int x, int y) {
    return values[static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x)];
  }
  float At(int x, int y) const {
    return values[static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x)];
  }
  size_t Size() const { return values.size(); }
};

// Means over boxes of 2·radius + 1 pixels squared, clipped to the plane. Each mean is summed separately, so that a huge
// value does not affect the rounding outside of its box.
Plane BoxMeans(const Plane& plane, int radius, int threads);

}  // namespace lampyr
