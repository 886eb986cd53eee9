#include "sampling/color_table.h"

#include "base/large_pages.h"
#include "base/parallel.h"
#include "sampling/cumulative.h"

namespace lampyr {

using namespace cumulative;

namespace {

constexpr size_t kEntriesPerLine = 4;

// A view of the CDF in a row of entries.
template <class Entry>
struct RowCdf {
  Entry* entries;
  auto& operator[](size_t i) const { return entries[i].cdf; }
};

}  // namespace

ColorTable::ColorTable(std::span<const float> weights, const std::function<Color(int x, int y)>& color, int width,
                       int height)
    : width_(width),
      height_(height),
      inverseWidth_(1 / static_cast<float>(width)),
      inverseHeight_(1 / static_cast<float>(height)) {
  const auto columns = static_cast<size_t>(width), rows = static_cast<size_t>(height);
  stride_ = (columns + kEntriesPerLine) / kEntriesPerLine * kEntriesPerLine;
  entries_ = LargeArray<Entry>(stride_ * rows);
  const size_t steps = GuideSteps(columns);
  guide_.assign((steps + 1) * rows, 0);
  guideShift_ = GuideShift(columns);
  std::vector<double> sums(rows, 0.0);
  ParallelFor(height, HardwareThreads(), [&](int y) {
    const auto row = static_cast<size_t>(y);
    Entry* entries = &entries_[row * stride_];
    for (int x = 0; x < width; ++x) entries[x].color = color(x, y);
    const std::span<const float> ofRow = weights.subspan(row * columns, columns);
    for (const float weight : ofRow) sums[row] += Cleaned(weight);
    if (!(sums[row] > 0)) return;
    const RowCdf<Entry> cdf{entries};
    WriteCdf(ofRow, sums[row], cdf);
    WriteGuide(cdf, columns, steps, &guide_[row * (steps + 1)], guideShift_);
  });
  rows_ = Distribution1D(InRangeOfFloat(sums));
}

float ColorTable::CellDensity(int x, int y) const {
  return rows_.DensityOf(static_cast<uint32_t>(y)) *
         IntervalDensity(RowCdf<const Entry>{Row(y)}, static_cast<size_t>(x), static_cast<size_t>(width_));
}

ColorTable::Cell ColorTable::Sample(const Point2& u) const {
  const auto columns = static_cast<size_t>(width_);
  const float ux = ClampedUnit(u.x);
  const Distribution1D::Choice row = rows_.Choose(u.y);
  const size_t steps = GuideSteps(columns);
  const Range range = GuidedRange(&guide_[row.index * (steps + 1)], steps, columns, ux, guideShift_);
  // Fetches all cache lines that the search may read at once; one after the other, each would cost a full memory
  // latency.
  const int y = static_cast<int>(row.index);
  const Entry* entries = Row(y);
  constexpr uint32_t kMostLines = 8;
  const uint32_t first = range.low / kEntriesPerLine, last = (range.high + 1) / kEntriesPerLine;
  for (uint32_t line = first; line <= std::min(last, first + kMostLines); ++line)
    Touch(&entries[line * kEntriesPerLine].cdf);
  const Found column = SampleCdf(RowCdf<const Entry>{entries}, range, columns, ux);
  const int x = static_cast<int>(column.interval);
  return {x, y, {column.t, row.t}, CellDensity(x, y), entries[x].color};
}

double ColorTable::ShareOfRow(int y, int xBegin, int xEnd) const {
  const Entry* row = Row(y);
  const double ofRow = static_cast<double>(rows_.DensityOf(static_cast<uint32_t>(y))) / height_;
  return ofRow * static_cast<double>(row[xEnd].cdf - row[xBegin].cdf);
}

ColorTable::Cell ColorTable::SampleInRow(int y, int xBegin, int xEnd, double u) const {
  const auto columns = static_cast<size_t>(width_), row = static_cast<size_t>(y);
  const Entry* entries = Row(y);
  const auto begin = static_cast<double>(entries[xBegin].cdf), end = static_cast<double>(entries[xEnd].cdf);
  // Rounded down to the units of the table, which changes no comparison with it; the position in the texel has the
  // rest.
  const double target = std::min(begin + u * (end - begin), end - 0.5 / static_cast<double>(kUnits));
  const auto known = static_cast<float>(std::floor(target * static_cast<double>(kUnits)) / static_cast<double>(kUnits));
  const size_t steps = GuideSteps(columns);
  const RowCdf<const Entry> cdf{entries};
  const Range range = GuidedRange(&guide_[row * (steps + 1)], steps, columns, known, guideShift_);
  const uint32_t i = FindInterval(cdf, range, columns, known);
  const auto first = static_cast<double>(cdf[i]), width = static_cast<double>(cdf[i + 1]) - first;
  const auto t = static_cast<float>((target - first) / width);
  const int x = static_cast<int>(i);
  return {x, y, {std::min(t, kOneMinusEpsilon), 0.0f}, CellDensity(x, y), entries[x].color};
}

ColorTable::Texel ColorTable::Look(const Point2& uv) const {
  const int x = IntervalAt(uv.x, width_), y = IntervalAt(uv.y, height_);
  return {IsZero() ? 0.0f : CellDensity(x, y), ColorAt(x, y), x, y};
}

Color ColorTable::ColorAt(int x, int y) const {
  return Row(y)[x].color;
}

}  // namespace lampyr
