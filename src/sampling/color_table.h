// An image that is importance-sampled by weights of its texels: a Distribution2D whose cells also hold their colours.
// CDF and colour of a cell are adjacent in memory. If the image does not fit the cache, a sample or a lookup takes one
// memory access, which is most of its cost.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "base/large_array.h"
#include "math/vec.h"
#include "sampling/tables.h"

namespace lampyr {

class ColorTable {
 public:
  ColorTable() = default;
  // Weights (width · height, row by row) and colours of the texels. Weights that are negative, NaN or infinite count as
  // 0.
  ColorTable(std::span<const float> weights, const std::function<Color(int x, int y)>& color, int width, int height);

  int Width() const { return width_; }
  int Height() const { return height_; }
  bool IsZero() const { return rows_.IsZero(); }  // no positive weight

  struct Cell {
    int x, y;
    Point2 t;   // position in the cell, [0,1)²
    float pdf;  // density over [0,1]²
    Color color;
  };
  Cell Sample(const Point2& u) const;  // requires !IsZero()
  // Sum of the densities of the texels [xBegin, xEnd) of row y, over that of all: their probability in Sample.
  double ShareOfRow(int y, int xBegin, int xEnd) const;
  // Samples one of these texels in proportion to their densities, by u in [0,1). Requires that one is positive.
  // Cell::pdf is that of Sample, Cell::t.y is 0.
  Cell SampleInRow(int y, int xBegin, int xEnd, double u) const;
  // The point of a cell in [0,1]², rounded to float: for a point at the very edge of the cell, Look may find the next
  // cell.
  Point2 At(const Cell& cell) const {
    return {(static_cast<float>(cell.x) + cell.t.x) * inverseWidth_,
            (static_cast<float>(cell.y) + cell.t.y) * inverseHeight_};
  }

  struct Texel {
    float pdf;
    Color color;
    int x, y;
  };
  Texel Look(const Point2& uv) const;
  Color ColorAt(int x, int y) const;

 private:
  // Cell x of a row: the CDF at its beginning, and its colour. One more entry ends the row.
  struct Entry {
    float cdf;
    Color color;
  };
  static_assert(sizeof(Entry) == 16, "four to a line of the cache");
  const Entry* Row(int y) const { return &entries_[static_cast<size_t>(y) * stride_]; }
  float CellDensity(int x, int y) const;

  int width_ = 0, height_ = 0;
  float inverseWidth_ = 0, inverseHeight_ = 0;
  size_t stride_ = 0;
  LargeArray<Entry> entries_;
  std::vector<uint16_t> guide_;  // per row, of columns >> guideShift_
  int guideShift_ = 0;
  Distribution1D rows_;
};

}  // namespace lampyr
