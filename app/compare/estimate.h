// Confidence intervals from independent repeats. Pixels of one image are correlated (light paths, filters, Sobol
// points), so the uncertainty of its error can only be estimated from renders with other seeds.
#pragma once

#include <optional>
#include <span>

#include "app/compare/results.h"

namespace lampyr {

// The mean of the values and its 95 % interval by Student's t on the logarithm of the mean (its standard error by the
// delta method): positive, and symmetric on a logarithmic axis. Absent if the mean is not above 0. A single value has
// an interval from 0 to infinity. `otherError`: the standard error of the term that was subtracted from every value.
std::optional<Estimate> MeanOnLogScale(std::span<const double> values, double otherError = 0);

// mean(a) / mean(b) likewise, Welch's degrees of freedom.
std::optional<Estimate> RatioOfMeans(std::span<const double> a, std::span<const double> b);

// The mean and its interval by Student's t. `otherError`: as above.
SignificantEstimate MeanOf(std::span<const double> values, double otherError = 0);

// A statistic of several independent data and its interval by the jackknife: `without` are its values with each datum
// left out in turn, and its interval is infinite if there are none. `otherError`: as above.
SignificantEstimate JackknifeOf(double value, std::span<const double> without, double otherError = 0);

// Mean and variance of the mean (0 for a single value).
struct Moments {
  double mean = 0, varianceOfMean = 0;
};
Moments MomentsOf(std::span<const double> values);

}  // namespace lampyr
