// Piecewise constant distributions. The search starts from a guide table ([Chen74]): a table of the intervals in which
// equal steps of u fall, so that an image of 8 million texels costs two cache misses and not a dozen.
#include "sampling/tables.h"

#include <algorithm>
#include <cmath>

#include "base/touch.h"

namespace lampyr {
namespace {

constexpr int64_t kUnits = int64_t{1} << 24;  // a cdf counts in 1/kUnits
constexpr uint32_t kIntervalsPerGuideStep = 16;

double Cleaned(float value) {
  return value > 0 && value < kInfinity ? static_cast<double>(value) : 0.0;
}

float ClampedUnit(float u) {
  return u > 0 ? std::min(u, kOneMinusEpsilon) : 0.0f;
}

// The interval of [0,1] in n equal ones that x is in.
int IntervalAt(float x, int n) {
  return std::min(static_cast<int>(static_cast<double>(ClampedUnit(x)) * n), n - 1);
}

// The float nearest to (interval + t)/n that IntervalAt maps back to `interval`.
float PointInInterval(int interval, float t, int n) {
  const float x = ClampedUnit(static_cast<float>((interval + static_cast<double>(t)) / n));
  const int found = IntervalAt(x, n);
  if (found == interval) return x;
  return std::nextafter(x, found < interval ? 1.0f : 0.0f);
}

// For a table that is in no cache: the guide has to be, and the intervals between two of its steps are in a few lines.
size_t GuideSteps(size_t n) {
  return std::max<size_t>(1, n / kIntervalsPerGuideStep);
}
// For a small table: hardly anything is left to search.
size_t FineGuideSteps(size_t n) {
  return 2 * n;
}

// Writes n + 1 entries of the cumulative distribution of `values`, whose sum (as Cleaned) is `sum` > 0.
void WriteCdf(std::span<const float> values, double sum, float* cdf) {
  int64_t remaining = 0;  // intervals that are not 0 and still need a unit
  for (const float v : values) remaining += Cleaned(v) > 0;
  const double scale = static_cast<double>(kUnits) / sum;
  double cumulative = 0;
  int64_t units = 0;
  cdf[0] = 0;
  for (size_t i = 0; i < values.size(); ++i) {
    const double value = Cleaned(values[i]);
    if (value > 0) {
      --remaining;
      cumulative += value;
      const int64_t target = remaining == 0 ? kUnits : static_cast<int64_t>(cumulative * scale + 0.5);
      units = std::max(units, std::min(std::max(target, units + 1), kUnits - remaining));
    }
    cdf[i + 1] = static_cast<float>(units) * (1.0f / kUnits);
  }
}

// guide[k] is the interval that contains u = k/steps, shifted right; the last entry is the last that is not empty.
template <class Entry>
void WriteGuide(const float* cdf, size_t n, size_t steps, Entry* guide, int shift = 0) {
  uint32_t interval = 0;
  for (size_t k = 0; k <= steps; ++k) {
    const float u = std::min(static_cast<float>(k) / static_cast<float>(steps), kOneMinusEpsilon);
    while (interval + 1 < n && cdf[interval + 1] <= u) ++interval;
    guide[k] = static_cast<Entry>(interval >> shift);
  }
}

struct Range {
  uint32_t low, high;  // both may be the interval that is looked for
};

// What the guide leaves of n intervals for u.
template <class Entry>
Range GuidedRange(const Entry* guide, size_t steps, size_t n, float u, int shift = 0) {
  const size_t k = std::min(static_cast<size_t>(u * static_cast<float>(steps)), steps - 1);
  const uint32_t low = static_cast<uint32_t>(guide[k]) << shift;
  const uint32_t high = (static_cast<uint32_t>(guide[k + 1]) << shift) + ((1u << shift) - 1);
  return {low, std::min(high, static_cast<uint32_t>(n) - 1)};
}

// The interval with cdf[i] <= u < cdf[i + 1], which is never one of width 0.
uint32_t FindInterval(const float* cdf, Range range, size_t n, float u) {
  auto [low, high] = range;
  // The guide's step was found with a rounded product: widen in the rare case that u is just outside of it.
  if (cdf[low] > u) low = 0;
  if (cdf[high + 1] <= u) high = static_cast<uint32_t>(n) - 1;
  // The last interval that starts at or below u; without a branch on the data, which would be mispredicted.
  uint32_t count = high - low + 1;
  while (count > 1) {
    const uint32_t half = count / 2;
    low += static_cast<uint32_t>(cdf[low + half] <= u) * half;
    count -= half;
  }
  return low;
}

struct Found {
  uint32_t interval;
  float t;  // position within the interval, [0,1)
};

Found SampleCdf(const float* cdf, Range range, size_t n, float u) {
  const uint32_t i = FindInterval(cdf, range, n, u);
  return {i, std::min((u - cdf[i]) / (cdf[i + 1] - cdf[i]), kOneMinusEpsilon)};
}

float IntervalDensity(const float* cdf, size_t i, size_t n) {
  return (cdf[i + 1] - cdf[i]) * static_cast<float>(n);
}

float InvertCdf(const float* cdf, int n, float x) {
  const int i = IntervalAt(x, n);
  const float t = static_cast<float>(static_cast<double>(ClampedUnit(x)) * n - i);
  return ClampedUnit(cdf[i] + t * (cdf[i + 1] - cdf[i]));
}

}  // namespace

// --- AliasTable

AliasTable::AliasTable(std::span<const float> weights) : bins_(weights.size()), probabilities_(weights.size(), 0.0f) {
  const size_t n = weights.size();
  for (const float w : weights) total_ += Cleaned(w);
  if (IsZero()) return;

  // Vose's method: every bin gets one item that has less than its share and is filled up by one that has more.
  std::vector<double> share(n);
  std::vector<uint32_t> under, over;
  uint32_t largest = 0;
  for (uint32_t i = 0; i < n; ++i) {
    const double probability = Cleaned(weights[i]) / total_;
    probabilities_[i] = static_cast<float>(probability);
    if (probabilities_[i] < std::numeric_limits<float>::min()) probabilities_[i] = 0;  // 1/p would be infinite
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
  // What rounding left over is full, but for an item of weight 0: that bin goes to the likeliest item.
  for (const auto* rest : {&under, &over}) {
    for (const uint32_t i : *rest) bins_[i] = {probabilities_[i] > 0 ? 1.0f : 0.0f, largest};
  }
}

AliasTable::Result AliasTable::Sample(float u) const {
  const size_t n = bins_.size();
  const double scaled = static_cast<double>(ClampedUnit(u)) * static_cast<double>(n);
  const uint32_t bin = static_cast<uint32_t>(std::min(scaled, static_cast<double>(n - 1)));
  const float fraction = std::min(static_cast<float>(scaled - bin), kOneMinusEpsilon);
  const float threshold = bins_[bin].threshold;
  const bool own = fraction < threshold;
  const uint32_t index = own ? bin : bins_[bin].alias;
  const float rest = own ? fraction / threshold : (fraction - threshold) / (1 - threshold);
  return {index, PdfDiscrete(probabilities_[index]), std::min(rest, kOneMinusEpsilon)};
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

Distribution1D::Result Distribution1D::Sample(float u) const {
  const float clamped = ClampedUnit(u);
  const Range range = GuidedRange(guide_.data(), FineGuideSteps(Size()), Size(), clamped);
  const Found found = SampleCdf(cdf_.data(), range, Size(), clamped);
  const float x = PointInInterval(static_cast<int>(found.interval), found.t, static_cast<int>(Size()));
  return {x, IntervalDensity(cdf_.data(), found.interval, Size()), found.interval};
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
  double sum = 0, largest = 0;
  for (size_t row = 0; row < rows; ++row) {
    for (const float v : values.subspan(row * columns, columns)) rowSums[row] += Cleaned(v);
    sum += rowSums[row];
    largest = std::max(largest, rowSums[row]);
  }
  if (!(sum > 0)) return;
  integral_ = sum / (static_cast<double>(columns) * static_cast<double>(rows));

  const size_t guideSize = GuideSteps(columns) + 1;
  conditionalCdf_.assign((columns + 1) * rows, 0.0f);
  conditionalGuide_.assign(guideSize * rows, 0);
  while ((columns - 1) >> guideShift_ > 0xffff) ++guideShift_;
  std::vector<float> scaledSums(rows);  // in the range of float, and a dark row stays above 0
  for (size_t row = 0; row < rows; ++row) {
    if (rowSums[row] == 0) continue;
    scaledSums[row] = std::max(static_cast<float>(rowSums[row] / largest), std::numeric_limits<float>::min());
    float* cdf = &conditionalCdf_[row * (columns + 1)];
    WriteCdf(values.subspan(row * columns, columns), rowSums[row], cdf);
    WriteGuide(cdf, columns, GuideSteps(columns), &conditionalGuide_[row * guideSize], guideShift_);
  }
  double scaledSum = 0;
  for (const float s : scaledSums) scaledSum += static_cast<double>(s);
  marginalCdf_.resize(rows + 1);
  WriteCdf(scaledSums, scaledSum, marginalCdf_.data());
  marginalGuide_.resize(FineGuideSteps(rows) + 1);
  WriteGuide(marginalCdf_.data(), rows, FineGuideSteps(rows), marginalGuide_.data());
}

float Distribution2D::CellDensity(int column, int row) const {
  const size_t columns = static_cast<size_t>(width_);
  const float* cdf = &conditionalCdf_[static_cast<size_t>(row) * (columns + 1)];
  return IntervalDensity(marginalCdf_.data(), static_cast<size_t>(row), static_cast<size_t>(height_)) *
         IntervalDensity(cdf, static_cast<size_t>(column), columns);
}

Distribution2D::Narrowed Distribution2D::Narrow(const Point2& u) const {
  const size_t columns = static_cast<size_t>(width_), rows = static_cast<size_t>(height_);
  const float ux = ClampedUnit(u.x), uy = ClampedUnit(u.y);
  const Range rowRange = GuidedRange(marginalGuide_.data(), FineGuideSteps(rows), rows, uy);
  const Found row = SampleCdf(marginalCdf_.data(), rowRange, rows, uy);
  const size_t steps = GuideSteps(columns);
  const Range range = GuidedRange(&conditionalGuide_[row.interval * (steps + 1)], steps, columns, ux, guideShift_);
  const float* cdf = &conditionalCdf_[row.interval * (columns + 1)];
  // One after the other the two would take twice as long.
  Touch(cdf + range.low);
  Touch(cdf + range.high + 1);
  return {row.interval, range.low, range.high, ux, row.t};
}

Distribution2D::Cell Distribution2D::Choose(const Narrowed& narrowed) const {
  const size_t columns = static_cast<size_t>(width_);
  const float* cdf = &conditionalCdf_[narrowed.row * (columns + 1)];
  const Found column = SampleCdf(cdf, {narrowed.first, narrowed.last}, columns, narrowed.u);
  const int i = static_cast<int>(column.interval), j = static_cast<int>(narrowed.row);
  return {i, j, {column.t, narrowed.tRow}, CellDensity(i, j)};
}

Point2 Distribution2D::At(const Cell& cell) const {
  return {PointInInterval(cell.column, cell.t.x, width_), PointInInterval(cell.row, cell.t.y, height_)};
}

Distribution2D::Result Distribution2D::Sample(const Point2& u) const {
  const Cell cell = Choose(Narrow(u));
  return {At(cell), cell.pdf};
}

float Distribution2D::Density(const Point2& uv) const {
  if (IsZero()) return 0;
  return CellDensity(IntervalAt(uv.x, width_), IntervalAt(uv.y, height_));
}

Point2 Distribution2D::Invert(const Point2& uv) const {
  const size_t row = static_cast<size_t>(IntervalAt(uv.y, height_));
  const float* cdf = &conditionalCdf_[row * (static_cast<size_t>(width_) + 1)];
  return {InvertCdf(cdf, width_, uv.x), InvertCdf(marginalCdf_.data(), height_, uv.y)};
}

}  // namespace lampyr
