// Tabulated distributions: piecewise constant in one and two dimensions, and alias tables over discrete items. Entries
// that are negative, NaN or infinite count as 0 (the caller, who knows their origin, reports them). A table of zeros
// cannot be sampled: IsZero().
//
// Cumulative tables count in units of 2^-24, the step of a random float: an interval is chosen exactly as often as its
// density says, and every nonzero interval can be chosen, however small beside the others. Densities therefore deviate
// from the given values by a few 2^-24 in probability, and a table has at most 2^24 nonzero intervals per side.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "math/density.h"
#include "math/vec.h"

namespace lampyr {

// Discrete items in proportion to their weights, in O(1) ([Walker77], built by [Vose91]).
class AliasTable {
 public:
  AliasTable() = default;
  explicit AliasTable(std::span<const float> weights);

  // The two floats come first: beside an integer they would be returned through memory, which stalls store forwarding.
  struct Result {
    PdfDiscrete probability;
    float u;  // the random number, rescaled to [0,1) for reuse
    uint32_t index;
  };
  // Requires !IsZero().
  Result Sample(double u) const;
  Result Sample(float u) const { return Sample(static_cast<double>(u)); }
  PdfDiscrete Probability(uint32_t index) const { return PdfDiscrete(probabilities_[index]); }
  size_t Size() const { return probabilities_.size(); }
  bool IsZero() const { return total_ <= 0; }
  double Total() const { return total_; }  // sum of the weights

 private:
  struct Bin {
    float threshold;  // below: the bin's own index; above: the alias
    uint32_t alias;
  };
  std::vector<Bin> bins_;
  std::vector<float> probabilities_;
  double total_ = 0;
};

// A density over [0,1], constant in each of n equal intervals.
class Distribution1D {
 public:
  Distribution1D() = default;
  explicit Distribution1D(std::span<const float> values);

  struct Result {
    float x;         // in [0,1)
    float pdf;       // density over [0,1]
    uint32_t index;  // interval
  };
  Result Sample(float u) const;  // requires !IsZero()
  // An interval, and the position t within it, [0,1).
  struct Choice {
    uint32_t index;
    float t;
  };
  Choice Choose(float u) const;           // requires !IsZero()
  float DensityOf(uint32_t index) const;  // of an interval, over [0,1]
  float Density(float x) const;           // x is clamped to [0,1]
  float Invert(float x) const;            // the u for which Sample returns x
  float Integral() const { return static_cast<float>(integral_); }
  bool IsZero() const { return integral_ <= 0; }
  size_t Size() const { return cdf_.empty() ? 0 : cdf_.size() - 1; }

 private:
  std::vector<float> cdf_;       // n + 1 entries
  std::vector<uint32_t> guide_;  // guide table into cdf_
  double integral_ = 0;
};

// A density over [0,1]², constant in each cell of a width × height grid, rows in y.
class Distribution2D {
 public:
  Distribution2D() = default;
  Distribution2D(std::span<const float> values, int width, int height);

  struct Result {
    Point2 uv;
    float pdf;  // density over [0,1]²
  };
  Result Sample(const Point2& u) const;  // requires !IsZero()
  float Density(const Point2& uv) const;
  Point2 Invert(const Point2& uv) const;
  double Integral() const { return integral_; }  // mean of the values
  bool IsZero() const { return integral_ <= 0; }

 private:
  float CellDensity(int column, int row) const;

  int width_ = 0, height_ = 0;
  std::vector<float> conditionalCdf_;       // (width + 1) × height
  std::vector<uint16_t> conditionalGuide_;  // one guide per row, of columns >> guideShift_
  int guideShift_ = 0;                      // 0 up to 65536 columns
  Distribution1D rows_;
  double integral_ = 0;
};

}  // namespace lampyr
