// Piecewise constant distributions.
#include "sampling/tables.h"

#include "base/large_pages.h"
#include "sampling/cumulative.h"

namespace lampyr {
namespace {

using namespace cumulative;

}  // namespace

// --- AliasTable

AliasTable::AliasTable(std::span<const float> weights) : bins_(weights.size()), probabilities_(weights.size(), 0.0f) {
  const size_t n = weights.size();
  for (const float w : weights) total_ += Cleaned(w);
  if (IsZero()) return;

  // Vose's method: each bin holds one item with less than its share, and is filled up with part of an item with more.
  std::vector<double> share(n);
  std::vector<uint32_t> under, over;
  uint32_t largest = 0;
  for (uint32_t i = 0; i < n; ++i) {
    const double probability = Cleaned(weights[i]) / total_;
    probabilities_[i] = static_cast<float>(probability);
    if (probabilities_[i] < std::numeric_limits<float>::min()) probabilities_[i] = 0;  // 1/p would overflow
    share[i] = probabilities_[i] > 0 ? probability * static_cast<double>(n) : 0.0;
    if (share[i] > share[largest]) largest = i;
    (share[i] < 1 ? under : over).push_back(i);
  }
  while (!under.empty() && !over.empty()) {
    const uint32_t small = under.back(), large = over.back();
    under.pop_back();
    bins_[small] = {static_cast<float>(share[small]), large};
    share[large] -= 1 - share[small];
    if (share[large] < 1) {
      over.pop_back();
      under.push_back(large);
    }
  }
  // Bins left over by rounding are full, except those of items of weight 0, which go to the likeliest item.
  for (const auto* rest : {&under, &over}) {
    for (const uint32_t i : *rest) bins_[i] = {probabilities_[i] > 0 ? 1.0f : 0.0f, largest};
  }
}

AliasTable::Result AliasTable::Sample(double u) const {
  const size_t n = bins_.size();
  const double scaled = (u > 0 ? std::min(u, 1.0) : 0.0) * static_cast<double>(n);
  const uint32_t bin = static_cast<uint32_t>(std::min(scaled, static_cast<double>(n - 1)));
  const float fraction = std::min(static_cast<float>(scaled - bin), kOneMinusEpsilon);
  const float threshold = bins_[bin].threshold;
  const bool own = fraction < threshold;
  const uint32_t index = own ? bin : bins_[bin].alias;
  const float rest = (fraction - (own ? 0 : threshold)) / (own ? threshold : 1 - threshold);
  return {PdfDiscrete(probabilities_[index]), std::min(rest, kOneMinusEpsilon), index};
}

// --- Distribution1D

Distribution1D::Distribution1D(std::span<const float> values) : cdf_(values.size() + 1, 0.0f) {
  double sum = 0;
  for (const float v : values) sum += Cleaned(v);
  if (!(sum > 0)) return;
  integral_ = sum / static_cast<double>(values.size());
  WriteCdf(values, sum, cdf_.data());
  guide_.resize(FineGuideSteps(values.size()) + 1);
  WriteGuide(cdf_.data(), values.size(), FineGuideSteps(values.size()), guide_.data());
}

Distribution1D::Choice Distribution1D::Choose(float u) const {
  const float clamped = ClampedUnit(u);
  const Found found =
      SampleCdf(cdf_.data(), GuidedRange(guide_.data(), FineGuideSteps(Size()), Size(), clamped), Size(), clamped);
  return {found.interval, found.t};
}

Distribution1D::Result Distribution1D::Sample(float u) const {
  const Choice choice = Choose(u);
  const float x = PointInInterval(static_cast<int>(choice.index), choice.t, static_cast<int>(Size()));
  return {x, DensityOf(choice.index), choice.index};
}

float Distribution1D::DensityOf(uint32_t index) const {
  return IntervalDensity(cdf_.data(), index, Size());
}

float Distribution1D::Density(float x) const {
  if (Size() == 0) return 0;
  return IntervalDensity(cdf_.data(), static_cast<size_t>(IntervalAt(x, static_cast<int>(Size()))), Size());
}

float Distribution1D::Invert(float x) const {
  return InvertCdf(cdf_.data(), static_cast<int>(Size()), x);
}

// --- Distribution2D

Distribution2D::Distribution2D(std::span<const float> values, int width, int height) : width_(width), height_(height) {
  const size_t columns = static_cast<size_t>(width), rows = static_cast<size_t>(height);
  std::vector<double> rowSums(rows, 0.0);
  double sum = 0;
  for (size_t row = 0; row < rows; ++row) {
    for (const float v : values.subspan(row * columns, columns)) rowSums[row] += Cleaned(v);
    sum += rowSums[row];
  }
  if (!(sum > 0)) return;
  integral_ = sum / (static_cast<double>(columns) * static_cast<double>(rows));

  const size_t guideSize = GuideSteps(columns) + 1;
  conditionalCdf_.assign((columns + 1) * rows, 0.0f);
  conditionalGuide_.assign(guideSize * rows, 0);
  guideShift_ = GuideShift(columns);
  for (size_t row = 0; row < rows; ++row) {
    if (rowSums[row] == 0) continue;
    float* cdf = &conditionalCdf_[row * (columns + 1)];
    WriteCdf(values.subspan(row * columns, columns), rowSums[row], cdf);
    WriteGuide(cdf, columns, GuideSteps(columns), &conditionalGuide_[row * guideSize], guideShift_);
  }
  rows_ = Distribution1D(InRangeOfFloat(rowSums));
}

float Distribution2D::CellDensity(int column, int row) const {
  const size_t columns = static_cast<size_t>(width_);
  const float* cdf = &conditionalCdf_[static_cast<size_t>(row) * (columns + 1)];
  return rows_.DensityOf(static_cast<uint32_t>(row)) * IntervalDensity(cdf, static_cast<size_t>(column), columns);
}

Distribution2D::Result Distribution2D::Sample(const Point2& u) const {
  const size_t columns = static_cast<size_t>(width_);
  const float ux = ClampedUnit(u.x);
  const Distribution1D::Choice row = rows_.Choose(u.y);
  const size_t steps = GuideSteps(columns);
  const Range range = GuidedRange(&conditionalGuide_[row.index * (steps + 1)], steps, columns, ux, guideShift_);
  const float* cdf = &conditionalCdf_[row.index * (columns + 1)];
  // Fetches both cache lines at once; one after the other, they would take twice as long.
  Touch(cdf + range.low);
  Touch(cdf + range.high + 1);
  const Found column = SampleCdf(cdf, range, columns, ux);
  const int i = static_cast<int>(column.interval), j = static_cast<int>(row.index);
  return {{PointInInterval(i, column.t, width_), PointInInterval(j, row.t, height_)}, CellDensity(i, j)};
}

float Distribution2D::Density(const Point2& uv) const {
  if (IsZero()) return 0;
  return CellDensity(IntervalAt(uv.x, width_), IntervalAt(uv.y, height_));
}

Point2 Distribution2D::Invert(const Point2& uv) const {
  const size_t row = static_cast<size_t>(IntervalAt(uv.y, height_));
  const float* cdf = &conditionalCdf_[row * (static_cast<size_t>(width_) + 1)];
  return {InvertCdf(cdf, width_, uv.x), rows_.Invert(uv.y)};
}

}  // namespace lampyr
