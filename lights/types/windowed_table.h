// A density over [0,1]², constant in each cell of a grid, that can be sampled within any window of the square, from a
// table of sums over all rectangles that start at the origin ([Crow84]). The sums are in double, so that their
// differences are accurate to a single cell.
#pragma once

#include <span>
#include <vector>

#include "math/vec.h"

namespace lampyr {

class WindowedTable {
 public:
  struct Window {
    double x0 = 0, x1 = 1, y0 = 0, y1 = 1;  // in [0,1]
  };

  WindowedTable() = default;
  // Rows in y. The values are positive and finite; they need no particular scale.
  WindowedTable(std::span<const float> values, int width, int height);

  // Fraction of the total integral that lies in the window.
  double Integral(const Window& window) const;
  // A point of the window, in proportion to the density; requires an integral above 0.
  Point2d Sample(const Window& window, const Point2& u) const;
  // Density at a point of [0,1]² of sampling the whole square; over Integral(window), of sampling the window.
  double Density(const Point2d& point) const;

 private:
  // The sums up to a given y, over columns, or up to a given x, over rows: between two lines of the table.
  struct Line {
    const double* first;
    const double* second;
    double share;
    size_t stride;
    double At(size_t i) const { return first[i * stride] + share * (second[i * stride] - first[i * stride]); }
    double AtReal(double x, int cells) const;
  };
  Line RowAt(double y) const;
  // The position in [low, high] where the difference of two lines is `target`.
  static double Invert(const Line& upper, const Line& lower, double low, double high, int cells, double u);

  int width_ = 0, height_ = 0;
  std::vector<double> sums_;  // (width + 1) × (height + 1), the last is 1
};

}  // namespace lampyr
