#include "materials/measured_table.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace lampyr {

namespace {

// The t in [0,1] up to which a density that is linear between `a` at 0 and `b` at 1 has the integral `target`.
double SolveLinear(double a, double b, double target) {
  if (!(target > 0)) return 0;
  const double root = std::sqrt(std::max(a * a + 2 * target * (b - a), 0.0));
  return std::clamp(2 * target / (a + root), 0.0, 1.0);
}

double LinearIntegral(double a, double b, double t) {
  return t * (a + 0.5 * t * (b - a));
}

// The last interval in [0, count) that begins at or below `target`; `before` is ascending.
template <class Before>
size_t FindInterval(size_t count, double target, const Before& before) {
  size_t low = 0, high = count;
  while (high - low > 1) {
    const size_t middle = (low + high) / 2;
    (before(middle) <= target ? low : high) = middle;
  }
  return low;
}

}  // namespace

MeasuredWarp::MeasuredWarp(const std::vector<float>& values, size_t width, size_t height)
    : values_(values), before_(values.size()), width_(width), height_(height) {
  const size_t size = width * height, tables = values.size() / size;
  rowsBefore_.resize(tables * height);
  const double perCell = static_cast<double>((width - 1) * (height - 1));
  for (size_t table = 0; table < tables; ++table) {
    float* const nodes = values_.data() + table * size;
    double* const before = before_.data() + table * size;
    double* const rows = rowsBefore_.data() + table * height;
    const auto sumUp = [&] {
      for (size_t y = 0; y < height; ++y) {
        double sum = 0;
        for (size_t x = 0; x < width; ++x) {
          if (x > 0)
            sum += 0.5 * (static_cast<double>(nodes[y * width + x - 1]) + static_cast<double>(nodes[y * width + x]));
          before[y * width + x] = sum;
        }
        rows[y] = y == 0 ? 0 : rows[y - 1] + 0.5 * (before[y * width - 1] + sum);
      }
      return rows[height - 1];
    };
    const double total = sumUp();
    if (!(total > 0)) throw Error("a table of densities is 0 everywhere");
    // Normalised so that the mean over the square is 1; cumulative sums are those of the rounded values.
    for (size_t i = 0; i < size; ++i) nodes[i] = static_cast<float>(static_cast<double>(nodes[i]) * perCell / total);
    const double rounded = sumUp() / perCell;
    for (size_t i = 0; i < size; ++i) before[i] /= rounded;
    for (size_t y = 0; y < height; ++y) rows[y] /= rounded;
    for (size_t i = 0; i < size; ++i) nodes[i] = static_cast<float>(static_cast<double>(nodes[i]) / rounded);
  }
}

double MeasuredWarp::RowsBefore(const TableBlend& blend, size_t row) const {
  double sum = 0;
  for (int i = 0; i < blend.count; ++i)
    sum += static_cast<double>(blend.weight[i]) * rowsBefore_[blend.table[i] * height_ + row];
  return sum;
}

double MeasuredWarp::RowIntegral(const TableBlend& blend, size_t row) const {
  return CellsBefore(blend, row, width_ - 1);
}

double MeasuredWarp::CellsBefore(const TableBlend& blend, size_t row, size_t column) const {
  double sum = 0;
  for (int i = 0; i < blend.count; ++i)
    sum += static_cast<double>(blend.weight[i]) * before_[(blend.table[i] * height_ + row) * width_ + column];
  return sum;
}

double MeasuredWarp::ValueAt(const TableBlend& blend, size_t row, size_t column) const {
  double sum = 0;
  for (int i = 0; i < blend.count; ++i) {
    sum += static_cast<double>(blend.weight[i]) *
           static_cast<double>(values_[(blend.table[i] * height_ + row) * width_ + column]);
  }
  return sum;
}

Point2d MeasuredWarp::Sample(const TableBlend& blend, const Point2d& u) const {
  const double rows = static_cast<double>(height_ - 1), columns = static_cast<double>(width_ - 1);
  double target = u.y * RowsBefore(blend, height_ - 1);
  const size_t row = FindInterval(height_ - 1, target, [&](size_t i) { return RowsBefore(blend, i); });
  target -= RowsBefore(blend, row);
  const double low = RowIntegral(blend, row), high = RowIntegral(blend, row + 1);
  const double y = SolveLinear(low, high, target);

  const auto across = [&](double a, double b) { return (1 - y) * a + y * b; };
  const auto before = [&](size_t i) { return across(CellsBefore(blend, row, i), CellsBefore(blend, row + 1, i)); };
  target = u.x * across(low, high);
  const size_t column = FindInterval(width_ - 1, target, before);
  target -= before(column);
  const double left = across(ValueAt(blend, row, column), ValueAt(blend, row + 1, column));
  const double right = across(ValueAt(blend, row, column + 1), ValueAt(blend, row + 1, column + 1));
  const double x = SolveLinear(left, right, target);
  return {(static_cast<double>(column) + x) / columns, (static_cast<double>(row) + y) / rows};
}

Point2d MeasuredWarp::Invert(const TableBlend& blend, const Point2d& u) const {
  const double atX = std::clamp(u.x, 0.0, 1.0) * static_cast<double>(width_ - 1);
  const double atY = std::clamp(u.y, 0.0, 1.0) * static_cast<double>(height_ - 1);
  const size_t column = std::min(static_cast<size_t>(atX), width_ - 2);
  const size_t row = std::min(static_cast<size_t>(atY), height_ - 2);
  const double x = atX - static_cast<double>(column), y = atY - static_cast<double>(row);
  const double low = RowIntegral(blend, row), high = RowIntegral(blend, row + 1);
  const auto across = [&](double a, double b) { return (1 - y) * a + y * b; };
  const double left = across(ValueAt(blend, row, column), ValueAt(blend, row + 1, column));
  const double right = across(ValueAt(blend, row, column + 1), ValueAt(blend, row + 1, column + 1));
  const double inRow =
      across(CellsBefore(blend, row, column), CellsBefore(blend, row + 1, column)) + LinearIntegral(left, right, x);
  const double whole = across(low, high);
  const double inAll = RowsBefore(blend, row) + LinearIntegral(low, high, y);
  const double all = RowsBefore(blend, height_ - 1);
  constexpr double kLast = 0x1.fffffffffffffp-1;
  return {whole > 0 ? std::min(inRow / whole, kLast) : 0.0, std::min(inAll / all, kLast)};
}

double MeasuredWarp::Density(const TableBlend& blend, const Point2d& u) const {
  const double atX = std::clamp(u.x, 0.0, 1.0) * static_cast<double>(width_ - 1);
  const double atY = std::clamp(u.y, 0.0, 1.0) * static_cast<double>(height_ - 1);
  const size_t column = std::min(static_cast<size_t>(atX), width_ - 2);
  const size_t row = std::min(static_cast<size_t>(atY), height_ - 2);
  const double x = atX - static_cast<double>(column), y = atY - static_cast<double>(row);
  const auto along = [&](size_t r) { return (1 - x) * ValueAt(blend, r, column) + x * ValueAt(blend, r, column + 1); };
  return (1 - y) * along(row) + y * along(row + 1);
}

}  // namespace lampyr
