// The few statistics that the suite needs: tail probabilities and a χ² test that allows for the error of its
// expectations.
#pragma once

#include <span>

namespace lampyr {

// Probability that a χ² variable with `degrees` degrees of freedom exceeds `statistic`.
double ChiSquaredTail(double statistic, int degrees);

// Two-sided tail of the standard normal distribution.
double NormalTail(double z);

// p-value of the observed counts against the expected ones. `errors` are bounds on the errors of the expectations,
// which widen the tolerance; cells of less than 5 expected counts are pooled. The result is 0 if there are counts where
// none is expected.
double ChiSquaredTest(std::span<const double> observed, std::span<const double> expected,
                      std::span<const double> errors);

// The level of each of `count` tests for a family-wise level ([Sidak67]).
double SidakLevel(double familyWise, int count);

// Mean and its standard error.
class RunningMean {
 public:
  void Add(double value) {
    ++count_;
    const double delta = value - mean_;
    mean_ += delta / count_;
    squares_ += delta * (value - mean_);
  }
  double Mean() const { return mean_; }
  double StandardError() const;
  double Count() const { return count_; }

 private:
  double count_ = 0, mean_ = 0, squares_ = 0;
};

}  // namespace lampyr
