// A mean of independent samples, and how well it is known.
#pragma once

#include <algorithm>

namespace lampyr::test {

struct Estimate {
  double sum = 0, squares = 0;
  int count = 0;
  void Add(double x) {
    sum += x;
    squares += x * x;
    ++count;
  }
  double Mean() const { return sum / count; }
  // Variance of the mean.
  double Variance() const { return std::max(0.0, squares / count - Mean() * Mean()) / count; }
};

}  // namespace lampyr::test
