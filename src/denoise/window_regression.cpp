// The only file that includes Eigen.
#include "denoise/window_regression.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <mutex>

#include "base/parallel.h"

namespace lampyr {

namespace {

constexpr int kWindow = 9, kPatch = 3;
constexpr int kSide = 2 * kWindow + 1;
constexpr int kTile = 24;  // at least 2·kWindow, so that windows of every other tile do not overlap
static_assert(kTile >= 2 * kWindow);

// A pixel in the regression: a constant, x, y and the features; then the colours of the two halves.
constexpr int kTerms = 3 + static_cast<int>(kMostFeatures), kEntries = kTerms + 6;
using Entry = Eigen::Matrix<float, kEntries, 1>;
using Moments = Eigen::Matrix<float, kEntries, kTerms>;
using Normal = Eigen::Matrix<double, kTerms, kTerms>;
using Fit = Eigen::Matrix<float, 4, kTerms>;  // of R, G, B, and a row of zeros

// Sums of predictions: R, G, B and weight.
using Sum = Eigen::Vector4f;
using Sums = std::vector<Sum, Eigen::aligned_allocator<Sum>>;

// Working memory of one tile; kept by a thread from tile to tile.
class TileRegression {
 public:
  explicit TileRegression(const RegressionInput& input)
      : input_(input), distances_{PatchDistances(kWindow, kPatch), PatchDistances(kWindow, kPatch)} {}

  // Adds the predictions of the regressions at the pixels of the tile to `sums` of the picture, by width and half.
  void Run(const Tile& tile, std::array<std::array<Sums, 2>, kWidths.size()>& sums) {
    tile_ = tile;
    for (size_t half = 0; half < 2; ++half) distances_[half].Compute(input_.guides[half], tile);
    CopyEntries();
    for (int y = tile.y0; y < tile.y1; ++y) {
      for (int x = tile.x0; x < tile.x1; ++x) {
        for (size_t half = 0; half < 2; ++half) {
          for (size_t width = 0; width < kWidths.size(); ++width)
            RegressAt(x, y, half, kWidths[width], sums[width][half]);
        }
      }
    }
  }

 private:
  int Width() const { return input_.halves[0][0].width; }
  int Height() const { return input_.halves[0][0].height; }
  // Index of a pixel among the entries, which are of the tile and a border of kWindow.
  size_t EntryIndex(int x, int y) const {
    return static_cast<size_t>((y - tile_.y0 + kWindow) * (tile_.Width() + 2 * kWindow) + x - tile_.x0 + kWindow);
  }
  void CopyEntries();
  void Standardise(const CleanFeature& feature, size_t index);
  Moments Gather(int x, int y, size_t half, float width);
  Fit FitOf(const Moments& moments, int x, int y, size_t half) const;
  void RegressAt(int x, int y, size_t half, float width, Sums& sums);

  const RegressionInput& input_;
  Tile tile_;
  std::array<PatchDistances, 2> distances_;
  std::vector<Entry, Eigen::aligned_allocator<Entry>> entries_;
  std::vector<uint8_t> isThere_;                   // of the entries: a valid pixel of the picture
  std::array<float, kMostFeatures> shrinkages_{};  // 1 / variance of a feature in the tile; 0: it is constant
  std::array<float, kSide * kSide> weights_{};
};

void TileRegression::CopyEntries() {
  const size_t size = static_cast<size_t>((tile_.Width() + 2 * kWindow) * (tile_.Height() + 2 * kWindow));
  entries_.assign(size, Entry::Zero());
  isThere_.assign(size, 0);
  for (int y = std::max(tile_.y0 - kWindow, 0); y < std::min(tile_.y1 + kWindow, Height()); ++y) {
    for (int x = std::max(tile_.x0 - kWindow, 0); x < std::min(tile_.x1 + kWindow, Width()); ++x) {
      const size_t pixel = static_cast<size_t>(y) * static_cast<size_t>(Width()) + static_cast<size_t>(x);
      if (!input_.isValid[pixel]) continue;
      Entry& entry = entries_[EntryIndex(x, y)];
      isThere_[EntryIndex(x, y)] = 1;
      entry[0] = 1;
      entry[1] = static_cast<float>(2 * x - tile_.x0 - tile_.x1) / (2 * kWindow);
      entry[2] = static_cast<float>(2 * y - tile_.y0 - tile_.y1) / (2 * kWindow);
      for (size_t half = 0; half < 2; ++half) {
        for (size_t c = 0; c < 3; ++c)
          entry[kTerms + static_cast<int>(3 * half + c)] = input_.halves[half][c].values[pixel];
      }
    }
  }
  for (size_t i = 0; i < input_.features.size(); ++i) Standardise(input_.features[i], i);
}

// Stores a feature, scaled to mean 0 and variance 1 over the tile and its border.
void TileRegression::Standardise(const CleanFeature& feature, size_t index) {
  double sum = 0, squares = 0, count = 0;
  const int x0 = std::max(tile_.x0 - kWindow, 0), x1 = std::min(tile_.x1 + kWindow, Width());
  const int y0 = std::max(tile_.y0 - kWindow, 0), y1 = std::min(tile_.y1 + kWindow, Height());
  const auto forAll = [&](const auto& body) {
    for (int y = y0; y < y1; ++y) {
      for (int x = x0; x < x1; ++x) {
        if (isThere_[EntryIndex(x, y)]) body(entries_[EntryIndex(x, y)], static_cast<double>(feature.value.At(x, y)));
      }
    }
  };
  forAll([&](const Entry&, double value) { sum += value, ++count; });
  const double mean = sum / std::max(count, 1.0);
  forAll([&](const Entry&, double value) { squares += (value - mean) * (value - mean); });
  const double variance = squares / std::max(count, 1.0);
  const bool isConstant = !(variance > 1e-10 * mean * mean) || !(variance > 1e-20);
  shrinkages_[index] = isConstant ? 0 : static_cast<float>(1 / variance);
  if (isConstant) return;
  const double scale = 1 / std::sqrt(variance);
  const int term = 3 + static_cast<int>(index);
  forAll([&](Entry& entry, double value) { entry[term] = static_cast<float>((value - mean) * scale); });
}

// Sets weights_ and returns the weighted sums of products over the window.
Moments TileRegression::Gather(int x, int y, size_t half, float width) {
  const float scale = 1 / (width * width);
  const PatchDistances& distances = distances_[1 - half];
  const int pixel = (y - tile_.y0) * tile_.Width() + x - tile_.x0;
  Moments moments = Moments::Zero();
  int offset = 0;
  for (int dy = -kWindow; dy <= kWindow; ++dy) {
    for (int dx = -kWindow; dx <= kWindow; ++dx, ++offset) {
      const size_t index = EntryIndex(x + dx, y + dy);
      const float weight = isThere_[index] ? WeightOf(scale * distances.At(offset)[pixel]) : 0;
      weights_[static_cast<size_t>(offset)] = weight;
      if (weight == 0) continue;
      const Entry& entry = entries_[index];
      moments.noalias() += entry * (weight * entry.head<kTerms>()).transpose();
    }
  }
  return moments;
}

// The noise of a feature would make the fit both too flat and noisy: its variance is added as a ridge.
Fit TileRegression::FitOf(const Moments& moments, int x, int y, size_t half) const {
  Normal normal = moments.topRows<kTerms>().cast<double>();
  const double weight = normal(0, 0);
  constexpr double kRidge = 1e-3;
  normal(0, 0) += 1e-9 * weight;
  for (int term = 1; term < kTerms; ++term) normal(term, term) += kRidge * weight;
  for (size_t i = 0; i < input_.features.size(); ++i) {
    const int term = 3 + static_cast<int>(i);
    normal(term, term) += weight * static_cast<double>(shrinkages_[i] * input_.features[i].variance.At(x, y));
  }
  const Eigen::Matrix<double, kTerms, 3> right =
      moments.middleRows<3>(kTerms + 3 * static_cast<int>(half)).transpose().cast<double>();
  const Eigen::Matrix<double, kTerms, 3> solution = normal.llt().solve(right);
  Fit fit = Fit::Zero();
  fit.topRows<3>() = solution.transpose().cast<float>();
  return fit;
}

void TileRegression::RegressAt(int x, int y, size_t half, float width, Sums& sums) {
  const Moments moments = Gather(x, y, half, width);
  if (!(moments(0, 0) > 0)) return;
  const Fit fit = FitOf(moments, x, y, half);
  if (!fit.allFinite()) return;
  int offset = 0;
  for (int dy = -kWindow; dy <= kWindow; ++dy) {
    for (int dx = -kWindow; dx <= kWindow; ++dx, ++offset) {
      const float weight = weights_[static_cast<size_t>(offset)];
      if (weight == 0) continue;
      Sum prediction = fit * entries_[EntryIndex(x + dx, y + dy)].head<kTerms>();
      prediction[3] = 1;
      sums[static_cast<size_t>(y + dy) * static_cast<size_t>(Width()) + static_cast<size_t>(x + dx)] +=
          weight * prediction;
    }
  }
}

RegressionOutput OutputOf(const std::array<Sums, 2>& sums, int width, int height) {
  RegressionOutput output;
  for (size_t half = 0; half < 2; ++half) {
    output.weights[half] = Plane(width, height);
    for (Plane& plane : output.halves[half]) plane = Plane(width, height);
    for (size_t i = 0; i < sums[half].size(); ++i) {
      const Sum& sum = sums[half][i];
      output.weights[half].values[i] = sum[3];
      if (!(sum[3] > 0)) continue;
      for (size_t c = 0; c < 3; ++c) output.halves[half][c].values[i] = sum[static_cast<int>(c)] / sum[3];
    }
  }
  return output;
}

}  // namespace

// Tiles are processed in four groups, so that no two at the same time add to the same pixel, and each pixel is summed
// in the same order.
std::array<RegressionOutput, kWidths.size()> RegressInWindows(const RegressionInput& input, int threads,
                                                              const std::atomic<bool>& interrupted,
                                                              const std::function<void(double)>& progress) {
  const int width = input.halves[0][0].width, height = input.halves[0][0].height;
  const size_t pixels = input.halves[0][0].Size();
  std::array<std::array<Sums, 2>, kWidths.size()> sums;
  for (auto& halves : sums) halves.fill(Sums(pixels, Sum::Zero()));
  const int columns = (width + kTile - 1) / kTile, rows = (height + kTile - 1) / kTile;
  std::mutex mutex;
  int done = 0;
  for (int group = 0; group < 4; ++group) {
    const int firstX = group % 2, firstY = group / 2;
    const int across = (columns - firstX + 1) / 2, down = (rows - firstY + 1) / 2;
    ParallelFor(across * down, threads, [&](int index) {
      if (interrupted.load()) return;
      const int x = (firstX + 2 * (index % across)) * kTile, y = (firstY + 2 * (index / across)) * kTile;
      TileRegression regression(input);
      regression.Run({x, y, std::min(x + kTile, width), std::min(y + kTile, height)}, sums);
      const std::lock_guard lock(mutex);
      progress(static_cast<double>(++done) / (columns * rows));
    });
  }
  std::array<RegressionOutput, kWidths.size()> outputs;
  for (size_t i = 0; i < outputs.size(); ++i) outputs[i] = OutputOf(sums[i], width, height);
  return outputs;
}

}  // namespace lampyr
