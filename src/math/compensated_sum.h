// A sum in two doubles, so that neither the number of its terms nor their order shows in it: of terms that differ by
// less than 2^50 in size, millions are summed to the last bit of a double. [Neumaier74; Ogita05 algorithm 4.4].
#pragma once

#include <cmath>

namespace lampyr {

class CompensatedSum {
 public:
  void Add(double term) {
    const double sum = high_ + term;
    const double added = sum - high_;
    low_ += (high_ - (sum - added)) + (term - added);  // what rounding has taken from `sum`, exactly
    high_ = sum;
  }
  // All terms of another sum.
  void Add(const CompensatedSum& other) {
    Add(other.high_);
    low_ += other.low_;
  }
  double Value() const { return high_ + low_; }
  // With one more term.
  double ValueWith(double term) const {
    CompensatedSum sum = *this;
    sum.Add(term);
    return sum.Value();
  }
  // And stays so when a million like it are added.
  bool IsFinite() const { return std::abs(high_) < 1e300 && std::abs(low_) < 1e300; }

 private:
  double high_ = 0, low_ = 0;
};

}  // namespace lampyr
