#include "denoise/plane.h"

#include <algorithm>

#include "base/parallel.h"

namespace lampyr {

Plane BoxMeans(const Plane& plane, int radius, int threads) {
  Plane sums(plane.width, plane.height), means(plane.width, plane.height);
  ParallelFor(plane.height, threads, [&](int y) {
    for (int x = 0; x < plane.width; ++x) {
      const int x0 = std::max(x - radius, 0), x1 = std::min(x + radius, plane.width - 1);
      float sum = 0;
      for (int i = x0; i <= x1; ++i) sum += plane.At(i, y);
      sums.At(x, y) = sum / static_cast<float>(x1 - x0 + 1);
    }
  });
  ParallelFor(plane.height, threads, [&](int y) {
    const int y0 = std::max(y - radius, 0), y1 = std::min(y + radius, plane.height - 1);
    const float scale = 1 / static_cast<float>(y1 - y0 + 1);
    for (int i = y0; i <= y1; ++i) {
      for (int x = 0; x < plane.width; ++x) means.At(x, y) += scale * sums.At(x, i);
    }
  });
  return means;
}

}  // namespace lampyr
