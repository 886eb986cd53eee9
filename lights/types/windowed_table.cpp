#include "lights/types/windowed_table.h"

#include <algorithm>
#include <cmath>

namespace lampyr {

namespace {

int CellAt(double x, int cells) {
  return std::clamp(static_cast<int>(x * cells), 0, cells - 1);
}

}  // namespace

WindowedTable::WindowedTable(std::span<const float> values, int width, int height) : width_(width), height_(height) {
  const size_t columns = static_cast<size_t>(width), rows = static_cast<size_t>(height), stride = columns + 1;
  sums_.assign(stride * (rows + 1), 0.0);
  for (size_t y = 0; y < rows; ++y) {
    double row = 0;
    for (size_t x = 0; x < columns; ++x) {
      row += static_cast<double>(values[y * columns + x]);
      sums_[(y + 1) * stride + x + 1] = sums_[y * stride + x + 1] + row;
    }
  }
  const double scale = 1 / sums_.back();
  for (double& sum : sums_) sum *= scale;
}

double WindowedTable::Line::AtReal(double x, int cells) const {
  const int i = CellAt(x, cells);
  const double low = At(static_cast<size_t>(i)), high = At(static_cast<size_t>(i) + 1);
  return low + (x * cells - i) * (high - low);
}

WindowedTable::Line WindowedTable::RowAt(double y) const {
  const int j = CellAt(y, height_);
  const double* first = &sums_[static_cast<size_t>(j) * (static_cast<size_t>(width_) + 1)];
  return {first, first + width_ + 1, y * height_ - j, 1};
}

double WindowedTable::Integral(const Window& window) const {
  const Line upper = RowAt(window.y1), lower = RowAt(window.y0);
  const double integral = (upper.AtReal(window.x1, width_) - lower.AtReal(window.x1, width_)) -
                          (upper.AtReal(window.x0, width_) - lower.AtReal(window.x0, width_));
  return std::max(integral, 0.0);
}

double WindowedTable::Invert(const Line& upper, const Line& lower, double low, double high, int cells, double u) {
  const double start = upper.AtReal(low, cells) - lower.AtReal(low, cells);
  const double end = upper.AtReal(high, cells) - lower.AtReal(high, cells);
  const double target = start + u * (end - start);
  // The last cell that starts at or below the target.
  size_t cell = static_cast<size_t>(CellAt(low, cells));
  size_t count = static_cast<size_t>(CellAt(high, cells)) - cell + 1;
  while (count > 1) {
    const size_t half = count / 2;
    cell += upper.At(cell + half) - lower.At(cell + half) <= target ? half : 0;
    count -= half;
  }
  const double first = upper.At(cell) - lower.At(cell), second = upper.At(cell + 1) - lower.At(cell + 1);
  const double t = second > first ? std::clamp((target - first) / (second - first), 0.0, 1.0) : 0.5;
  return std::clamp((static_cast<double>(cell) + t) / cells, low, high);
}

Point2d WindowedTable::Sample(const Window& window, const Point2& u) const {
  const double x = Invert(RowAt(window.y1), RowAt(window.y0), window.x0, window.x1, width_, static_cast<double>(u.x));
  // Within one column of cells the density depends on y alone.
  const size_t stride = static_cast<size_t>(width_) + 1;
  const double* column = &sums_[static_cast<size_t>(CellAt(x, width_))];
  const Line left{column, column, 0, stride}, right{column + 1, column + 1, 0, stride};
  return {x, Invert(right, left, window.y0, window.y1, height_, static_cast<double>(u.y))};
}

double WindowedTable::Density(const Point2d& point) const {
  const size_t stride = static_cast<size_t>(width_) + 1;
  const double* corner =
      &sums_[static_cast<size_t>(CellAt(point.y, height_)) * stride + static_cast<size_t>(CellAt(point.x, width_))];
  return ((corner[stride + 1] - corner[stride]) - (corner[1] - corner[0])) * width_ * height_;
}

}  // namespace lampyr
