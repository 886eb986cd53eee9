// A compensated sum in two doubles, which does not depend on the number or the order of its terms: with terms whose
// magnitudes differ by a factor of less than 2^50, the sum of millions is exact to the last bit of a double
// ([Neumaier74]; [Ogita05 algorithm 4.4]).
#pragma once

#include <cmath>

namespace lampyr {

class CompensatedSum {
 public:
  void Add(double term) {
    const double sum = high_ + term;
    const double added = sum - high_;
    low_ += (high_ - (sum - added)) + (term - added);  // the exact rounding error of `sum`
    high_ = sum;
  }
  // Adds all terms of another sum.
  void Add(const CompensatedSum& other) {
    Add(other.high_);
    low_ += other.low_;
  }
  double Value() const { return high_ + low_; }
  // The value with one more term.
  double ValueWith(double term) const {
    CompensatedSum sum = *this;
    sum.Add(term);
    return sum.Value();
  }
  // True if the sum is finite, and remains so when a million sums like it are added.
  bool IsFinite() const { return std::abs(high_) < 1e300 && std::abs(low_) < 1e300; }

 private:
  double high_ = 0, low_ = 0;
};

}  // namespace lampyr
