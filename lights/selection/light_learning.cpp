#include "lights/selection/light_learning.h"

#include <algorithm>
#include <cmath>

#include "sampling/rng.h"

namespace lampyr {

namespace {

constexpr size_t kRows = size_t{1} << 17;
// A grid of this many cells across the scene's radius.
constexpr float kCells = 16;
// As many observations as the parent's factor weighs: a cluster of which these many samples saw nothing is chosen half
// as often.
constexpr double kPrior = 4;
// A sample that is larger by chance is no better known than this.
constexpr double kLargestRatio = 8;
constexpr double kUnit = 0x1p24;

}  // namespace

LightLearning::LightLearning(const BoundingSphere& scene)
    : center_(scene.center),
      cellsPerUnit_(kCells / std::max(scene.radius, 1e-30f)),
      rows_(kRows),
      squares_(kRows * kWidth),
      counts_(kRows * kWidth) {
  Freeze();
}

uint32_t LightLearning::RegionOf(const Receiver& receiver) const {
  const auto cell = [](float x) {
    return static_cast<uint32_t>(static_cast<int32_t>(std::clamp(x, -1e6f, 1e6f) + 2e6f));
  };
  const Vector3 p = (receiver.position - center_) * cellsPerUnit_;
  const Vector3 n = glm::abs(receiver.normal);
  const int axis = n.x >= n.y && n.x >= n.z ? 0 : n.y >= n.z ? 1 : 2;
  const uint32_t side = 2 * static_cast<uint32_t>(axis) + (receiver.normal[axis] < 0 ? 1 : 0);
  return static_cast<uint32_t>(MixBits(cell(p.x) ^ static_cast<uint64_t>(cell(p.y)) << 21 ^
                                       static_cast<uint64_t>(cell(p.z)) << 42 ^ static_cast<uint64_t>(side) << 61));
}

size_t LightLearning::IndexOf(uint32_t region, uint32_t node) {
  return MixBits(static_cast<uint64_t>(region) << 32 | node) & (kRows - 1);
}

void LightLearning::Record(uint32_t region, uint32_t node, int child, double ratio) {
  const size_t i = IndexOf(region, node) * kWidth + static_cast<size_t>(child);
  const double bounded = ratio > 0 ? std::min(ratio, kLargestRatio) : 0.0;
  squares_[i].fetch_add(static_cast<uint64_t>(bounded * bounded * kUnit), std::memory_order_relaxed);
  counts_[i].fetch_add(1, std::memory_order_relaxed);
}

void LightLearning::Freeze() {
  for (size_t row = 0; row < kRows; ++row) {
    for (size_t child = 0; child < kWidth; ++child) {
      const size_t i = row * kWidth + child;
      const double squares = static_cast<double>(squares_[i].load(std::memory_order_relaxed)) / kUnit;
      const double all = static_cast<double>(counts_[i].load(std::memory_order_relaxed)) + kPrior;
      rows_[row].known[child] = static_cast<float>(squares / all);
      rows_[row].unknown[child] = static_cast<float>(kPrior / all);
    }
  }
}

}  // namespace lampyr
