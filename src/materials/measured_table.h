// Tables of a measured material over [0,1]², bilinear between nodes, one for each direction of incidence that was
// measured, with linear interpolation between directions; and warps of the square by such tables ([Dupuy18 §4]).
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "math/vec.h"

namespace lampyr {

// The tables to be interpolated for a direction of incidence. Weights sum to 1.
struct TableBlend {
  std::array<size_t, 4> table{};
  std::array<float, 4> weight{};
  int count = 0;
};

// Tables of width × height nodes. u.x runs along rows.
template <class Value>
class MeasuredTable {
 public:
  MeasuredTable() = default;
  // `values`: table by table, row by row. At least 2 × 2 nodes.
  MeasuredTable(std::vector<Value> values, size_t width, size_t height)
      : values_(std::move(values)), width_(width), height_(height) {}

  Value Evaluate(const TableBlend& blend, const Point2d& u) const {
    const Place place = PlaceOf(u);
    Value sum{};
    for (int i = 0; i < blend.count; ++i) sum += blend.weight[i] * ValueAt(blend.table[i], place);
    return sum;
  }
  // Value at u of the only table.
  Value Evaluate(const Point2d& u) const { return ValueAt(0, PlaceOf(u)); }

 private:
  struct Place {
    size_t node = 0;  // the lower left one of the cell
    float x = 0, y = 0;
  };
  Place PlaceOf(const Point2d& u) const {
    const double x = std::clamp(u.x, 0.0, 1.0) * static_cast<double>(width_ - 1);
    const double y = std::clamp(u.y, 0.0, 1.0) * static_cast<double>(height_ - 1);
    const size_t column = std::min(static_cast<size_t>(x), width_ - 2),
                 row = std::min(static_cast<size_t>(y), height_ - 2);
    return {row * width_ + column, static_cast<float>(x - static_cast<double>(column)),
            static_cast<float>(y - static_cast<double>(row))};
  }
  Value ValueAt(size_t table, const Place& place) const {
    const Value* at = values_.data() + table * width_ * height_ + place.node;
    return (1 - place.y) * ((1 - place.x) * at[0] + place.x * at[1]) +
           place.y * ((1 - place.x) * at[width_] + place.x * at[width_ + 1]);
  }

  std::vector<Value> values_;
  size_t width_ = 0, height_ = 0;
};

// A warp of the unit square whose density is a table: bilinear, each table normalised.
class MeasuredWarp {
 public:
  MeasuredWarp() = default;
  // `values` as of MeasuredTable, 0 or more and finite. Throws an Error if a table is 0 everywhere.
  MeasuredWarp(const std::vector<float>& values, size_t width, size_t height);

  // From uniform numbers in [0,1)² to a point.
  Point2d Sample(const TableBlend& blend, const Point2d& u) const;
  // The inverse of Sample: the numbers that give the point `u`.
  Point2d Invert(const TableBlend& blend, const Point2d& u) const;
  // The density over [0,1]².
  double Density(const TableBlend& blend, const Point2d& u) const;

 private:
  // Blended cumulative sums; units: the cell.
  double RowsBefore(const TableBlend& blend, size_t row) const;
  double RowIntegral(const TableBlend& blend, size_t row) const;
  double CellsBefore(const TableBlend& blend, size_t row, size_t column) const;
  double ValueAt(const TableBlend& blend, size_t row, size_t column) const;

  std::vector<float> values_;
  std::vector<double> before_;      // for each row, the integral over the cells before a node; then of the whole row
  std::vector<double> rowsBefore_;  // for each table, the integral over the rows of cells before a row of nodes
  size_t width_ = 0, height_ = 0;
};

}  // namespace lampyr
