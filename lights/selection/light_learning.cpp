#include "lights/selection/light_learning.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <vector>

#include "base/byte_stream.h"
#include "base/error.h"
#include "sampling/rng.h"

namespace lampyr {

namespace {

constexpr size_t kRows = size_t{1} << 17;
// Cells of the grid per radius of the scene.
constexpr float kCells = 16;
// Weight of the parent's factor, in observations: after so many occluded samples a cluster is selected half as often.
constexpr double kPrior = 4;
// Upper bound of a recorded ratio, against outliers.
constexpr double kLargestRatio = 8;
constexpr double kUnit = 0x1p24;

// A row with records, as saved.
struct SavedRow {
  uint64_t index = 0;
  std::array<uint32_t, LightLearning::kWidth> counts{};
  std::array<uint64_t, LightLearning::kWidth> squares{};
  std::array<float, LightLearning::kWidth> known{}, learned{};
};

}  // namespace

LightLearning::LightLearning(const BoundingSphere& scene)
    : center_(scene.center),
      cellsPerUnit_(kCells / std::max(scene.radius, 1e-30f)),
      rows_(kRows),
      squares_(kRows * kWidth),
      counts_(kRows * kWidth),
      used_(kRows / 64),
      changed_(kRows / 64) {}

namespace {

template <class Visit>
void ForRowsOf(const SparseArray<std::atomic<uint64_t>>& rows, const Visit& visit) {
  for (size_t word = 0; word < kRows / 64; ++word) {
    for (uint64_t bits = rows[word].load(std::memory_order_relaxed); bits != 0; bits &= bits - 1)
      visit(64 * word + static_cast<size_t>(std::countr_zero(bits)));
  }
}

void Set(SparseArray<std::atomic<uint64_t>>& rows, size_t row) {
  std::atomic<uint64_t>& word = rows[row / 64];
  const uint64_t bit = uint64_t{1} << row % 64;
  if (!(word.load(std::memory_order_relaxed) & bit)) word.fetch_or(bit, std::memory_order_relaxed);
}

}  // namespace

template <class Visit>
void LightLearning::ForUsedRows(const Visit& visit) const {
  ForRowsOf(used_, visit);
}

uint32_t LightLearning::RegionOf(const Receiver& receiver) const {
  const auto cell = [](float x) {
    return static_cast<uint32_t>(static_cast<int32_t>(std::clamp(x, -1e6f, 1e6f) + 2e6f));
  };
  const Vector3 p = (receiver.position - center_) * cellsPerUnit_;
  const Vector3 n = Abs(receiver.normal);
  const int axis = n.x >= n.y && n.x >= n.z ? 0 : n.y >= n.z ? 1 : 2;
  constexpr uint32_t kWithoutNormal = 6;
  // The normal of a transmissive surface is towards the path that arrives, which may come from either side.
  const bool isBehind = receiver.normal[axis] < 0 && !receiver.isTransmissive;
  const uint32_t side = receiver.HasNormal() ? 2 * static_cast<uint32_t>(axis) + (isBehind ? 1 : 0) : kWithoutNormal;
  return static_cast<uint32_t>(MixBits(cell(p.x) ^ static_cast<uint64_t>(cell(p.y)) << 21 ^
                                       static_cast<uint64_t>(cell(p.z)) << 42 ^ static_cast<uint64_t>(side) << 61));
}

size_t LightLearning::IndexOf(uint32_t region, uint32_t node) {
  return MixBits(static_cast<uint64_t>(region) << 32 | node) & (kRows - 1);
}

void LightLearning::Record(uint32_t region, uint32_t node, int child, double ratio) {
  const size_t row = IndexOf(region, node), i = row * kWidth + static_cast<size_t>(child);
  const double bounded = ratio > 0 ? std::min(ratio, kLargestRatio) : 0.0;
  squares_[i].fetch_add(static_cast<uint64_t>(bounded * bounded * kUnit), std::memory_order_relaxed);
  counts_[i].fetch_add(1, std::memory_order_relaxed);
  Set(used_, row);
  Set(changed_, row);
}

void LightLearning::Freeze() {
  ForUsedRows([&](size_t row) {
    Set(changed_, row);
    for (size_t child = 0; child < kWidth; ++child) {
      const size_t i = row * kWidth + child;
      const double squares = static_cast<double>(squares_[i].load(std::memory_order_relaxed)) / kUnit;
      const auto count = static_cast<double>(counts_[i].load(std::memory_order_relaxed)), all = count + kPrior;
      rows_[row].known[child] = static_cast<float>(squares / all);
      rows_[row].learned[child] = static_cast<float>(count / all);
    }
  });
}

void LightLearning::Forget() {
  ForUsedRows([&](size_t row) {
    Set(changed_, row);
    rows_[row] = {};
    for (size_t i = row * kWidth; i < (row + 1) * kWidth; ++i) {
      squares_[i].store(0, std::memory_order_relaxed);
      counts_[i].store(0, std::memory_order_relaxed);
    }
  });
  for (size_t word = 0; word < kRows / 64; ++word) used_[word].store(0, std::memory_order_relaxed);
  isRecording_ = false;
}

void LightLearning::CopyRowFrom(const LightLearning& other, size_t row) {
  rows_[row] = other.rows_[row];
  for (size_t i = row * kWidth; i < (row + 1) * kWidth; ++i) {
    squares_[i].store(other.squares_[i].load(std::memory_order_relaxed), std::memory_order_relaxed);
    counts_[i].store(other.counts_[i].load(std::memory_order_relaxed), std::memory_order_relaxed);
  }
}

void LightLearning::CopyFrom(const LightLearning& other) {
  isRecording_ = other.isRecording_;
  const auto copy = [&](size_t row) { CopyRowFrom(other, row); };
  ForUsedRows(copy);  // rows that `other` has not used become 0
  other.ForUsedRows(copy);
  for (size_t word = 0; word < kRows / 64; ++word)
    used_[word].store(other.used_[word].load(std::memory_order_relaxed), std::memory_order_relaxed);
}

void LightLearning::CopyChangesTo(LightLearning& copy) {
  copy.isRecording_ = isRecording_;
  ForRowsOf(changed_, [&](size_t row) { copy.CopyRowFrom(*this, row); });
  for (size_t word = 0; word < kRows / 64; ++word) {
    copy.used_[word].store(used_[word].load(std::memory_order_relaxed), std::memory_order_relaxed);
    changed_[word].store(0, std::memory_order_relaxed);
  }
}

// The factors in effect are older than the newest records: both are saved.
void LightLearning::Save(ByteWriter& bytes) const {
  std::vector<SavedRow> rows;
  ForUsedRows([&](size_t row) {
    SavedRow saved{row, {}, {}, {}, {}};
    for (size_t child = 0; child < kWidth; ++child) {
      const size_t i = row * kWidth + child;
      saved.counts[child] = counts_[i].load(std::memory_order_relaxed);
      saved.squares[child] = squares_[i].load(std::memory_order_relaxed);
      saved.known[child] = rows_[row].known[child];
      saved.learned[child] = rows_[row].learned[child];
    }
    rows.push_back(saved);
  });
  bytes.Value<uint8_t>(isRecording_ ? 1 : 0);
  bytes.List(std::span<const SavedRow>(rows));
}

void LightLearning::Load(ByteReader& bytes) {
  isRecording_ = bytes.Flag();
  for (const SavedRow& saved : bytes.List<SavedRow>(kRows)) {
    if (saved.index >= kRows) throw Error("it holds a number out of range");
    Set(used_, saved.index);
    Set(changed_, saved.index);
    for (size_t child = 0; child < kWidth; ++child) {
      const size_t i = saved.index * kWidth + child;
      if (!(saved.known[child] >= 0) || !(saved.learned[child] >= 0 && saved.learned[child] <= 1))
        throw Error("it holds a number out of range");
      counts_[i].store(saved.counts[child], std::memory_order_relaxed);
      squares_[i].store(saved.squares[child], std::memory_order_relaxed);
      rows_[saved.index].known[child] = saved.known[child];
      rows_[saved.index].learned[child] = saved.learned[child];
    }
  }
}

}  // namespace lampyr
