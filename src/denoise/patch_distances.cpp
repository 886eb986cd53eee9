#include "denoise/patch_distances.h"

#include <algorithm>
#include <limits>

namespace lampyr {

void PatchDistances::Copy(const Guide& guide, const Tile& tile) {
  const int border = window_ + patch_;
  channels_ = static_cast<int>(guide.values.size());
  width_ = tile.Width() + 2 * border;
  height_ = tile.Height() + 2 * border;
  planeWidth_ = guide.values[0].width;
  planeHeight_ = guide.values[0].height;
  const size_t size = static_cast<size_t>(width_) * static_cast<size_t>(height_);
  for (size_t c = 0; c < guide.values.size(); ++c) {
    values_[c].resize(size);
    variances_[c].resize(size);
    size_t i = 0;
    for (int y = tile.y0 - border; y < tile.y1 + border; ++y) {
      const int fromY = std::clamp(y, 0, planeHeight_ - 1);
      for (int x = tile.x0 - border; x < tile.x1 + border; ++x, ++i) {
        const int fromX = std::clamp(x, 0, planeWidth_ - 1);
        values_[c][i] = guide.values[c].At(fromX, fromY);
        variances_[c][i] = guide.variances[c].At(fromX, fromY);
      }
    }
  }
}

void PatchDistances::ComputeAt(int dx, int dy, const Tile& tile, float smallestVariance, float* out) {
  const int w = tile.Width() + 2 * patch_, h = tile.Height() + 2 * patch_;
  for (int y = 0; y < h; ++y) {
    float* row = differences_.data() + static_cast<size_t>(y) * static_cast<size_t>(w);
    std::fill(row, row + w, 0.0f);
    const ptrdiff_t p = static_cast<ptrdiff_t>(y + window_) * width_ + window_;
    const ptrdiff_t q = p + static_cast<ptrdiff_t>(dy) * width_ + dx;
    for (size_t c = 0; c < static_cast<size_t>(channels_); ++c) {
      const float *valueP = values_[c].data() + p, *valueQ = values_[c].data() + q;
      const float *varianceP = variances_[c].data() + p, *varianceQ = variances_[c].data() + q;
      for (int x = 0; x < w; ++x) {
        const float difference = valueP[x] - valueQ[x];
        const float smaller = varianceQ[x] < varianceP[x] ? varianceQ[x] : varianceP[x];
        row[x] += (difference * difference - varianceP[x] - smaller) / (smallestVariance + varianceP[x] + varianceQ[x]);
      }
    }
  }
  const int width = tile.Width(), reach = 2 * patch_ + 1;
  for (int y = 0; y < h; ++y) {
    const float* row = differences_.data() + static_cast<size_t>(y) * static_cast<size_t>(w);
    float* sums = rowSums_.data() + static_cast<size_t>(y) * static_cast<size_t>(width);
    std::copy(row, row + width, sums);
    for (int i = 1; i < reach; ++i) {
      for (int x = 0; x < width; ++x) sums[x] += row[x + i];
    }
  }
  const float scale = 1 / static_cast<float>(reach * reach * channels_);
  for (int y = 0; y < tile.Height(); ++y, out += width) {
    std::fill(out, out + width, 0.0f);
    for (int i = 0; i < reach; ++i) {
      const float* sums = rowSums_.data() + static_cast<size_t>(y + i) * static_cast<size_t>(width);
      for (int x = 0; x < width; ++x) out[x] += sums[x];
    }
    for (int x = 0; x < width; ++x) out[x] = std::max(out[x] * scale, 0.0f);
  }
}

void PatchDistances::Compute(const Guide& guide, const Tile& tile) {
  Copy(guide, tile);
  pixels_ = static_cast<size_t>(tile.Pixels());
  const size_t rows = static_cast<size_t>(tile.Height() + 2 * patch_);
  differences_.resize(rows * static_cast<size_t>(tile.Width() + 2 * patch_));
  rowSums_.resize(rows * static_cast<size_t>(tile.Width()));
  distances_.resize(pixels_ * static_cast<size_t>(Offsets()));
  float* out = distances_.data();
  for (int dy = -window_; dy <= window_; ++dy) {
    for (int dx = -window_; dx <= window_; ++dx, out += pixels_) {
      ComputeAt(dx, dy, tile, guide.smallestVariance, out);
      for (int y = 0; y < tile.Height(); ++y) {
        const bool isRow = tile.y0 + y + dy >= 0 && tile.y0 + y + dy < planeHeight_;
        for (int x = 0; x < tile.Width(); ++x) {
          const bool isInside = isRow && tile.x0 + x + dx >= 0 && tile.x0 + x + dx < planeWidth_;
          if (!isInside) out[y * tile.Width() + x] = std::numeric_limits<float>::infinity();
        }
      }
    }
  }
}

}  // namespace lampyr
