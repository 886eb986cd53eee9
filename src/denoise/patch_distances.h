// Differences of the surroundings of two pixels beyond their noise: the distances of non-local means.
#pragma once

#include <array>
#include <vector>

#include "denoise/plane.h"

namespace lampyr {

// A rectangle of pixels that is filtered at once.
struct Tile {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;  // half open
  int Width() const { return x1 - x0; }
  int Height() const { return y1 - y0; }
  int Pixels() const { return Width() * Height(); }
};

// An estimate of up to three channels with the variance of each pixel, by which pixels are compared.
struct Guide {
  std::vector<Plane> values, variances;
  float smallestVariance = 1e-12f;  // added to all variances, so that equal pixels without noise have distance 0
};

// The distances of the pixels of a tile from those around them: the mean over patches of 2·patch + 1 pixels squared,
// and over channels, of the squared difference minus its expectation by noise, relative to the variances ([Rousselle12
// §4.1]; the smaller of the two variances is subtracted for the other pixel). Beyond the border, patches repeat its
// pixels.
class PatchDistances {
 public:
  PatchDistances(int window, int patch) : window_(window), patch_(patch) {}

  void Compute(const Guide& guide, const Tile& tile);
  int Offsets() const { return (2 * window_ + 1) * (2 * window_ + 1); }
  // Distances of the pixels of the tile, row by row, from the pixels at an offset. Offsets are numbered row by row,
  // too. Infinite for pixels beyond the border.
  const float* At(int offset) const { return distances_.data() + static_cast<size_t>(offset) * pixels_; }

 private:
  void Copy(const Guide& guide, const Tile& tile);
  void ComputeAt(int dx, int dy, const Tile& tile, float smallestVariance, float* out);

  int window_, patch_;
  size_t pixels_ = 0;
  int channels_ = 0, width_ = 0, height_ = 0;  // of the copies
  int planeWidth_ = 0, planeHeight_ = 0;
  std::array<std::vector<float>, 3> values_, variances_;  // the tile with a border of window + patch
  std::vector<float> differences_, rowSums_;
  std::vector<float> distances_;
};

// The weight of a pixel at that distance: an approximation of exp(-distance) that ends at 8.
inline float WeightOf(float distance) {
  const float rest = distance < 8 ? 1 - distance * 0.125f : 0;
  const float squared = rest * rest, fourth = squared * squared;
  return fourth * fourth;
}

}  // namespace lampyr
